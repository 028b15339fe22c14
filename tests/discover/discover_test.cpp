#include "misfit/discover/discover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/discover/screen.h"
#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;

struct Flight {
  std::vector<Signals> signals;
  ModelRequest request;
  FilterEstimate estimate;
  explicit Flight(const Signals& flight) : signals{flight}, request(request_for(signals)), estimate(fitted(request, signals)) {}
  [[nodiscard]] Discovery discover() const { return misfit::discover(estimate, request, registry(), signals); }
};

TEST(Discover, IsSilentWhereNothingIsMissing) {
  const Discovery found = Flight(fly(15.0, 31)).discover();
  EXPECT_THAT(found.verdict, testing::StartsWith("Nothing is missing"));
  EXPECT_TRUE(found.unexplained_quantity.empty());
  for (const auto& c : found.candidates) EXPECT_FALSE(c.accepted) << c.effect;
}

TEST(Discover, NamesAPlantedFriction) {
  const Discovery found = Flight(fly(14.0, 32, {effect("coulomb_friction")}, {{"friction", 25.0}})).discover();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "coulomb_friction") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate friction = first.parameters.at("friction");
  EXPECT_LT(std::abs(friction.value - 25.0), 3.0 * friction.sigma) << friction.value << " ± " << friction.sigma;
  ASSERT_TRUE(first.actual_drop.has_value());
  EXPECT_GT(first.predicted_drop, 0.7 * *first.actual_drop);
  EXPECT_LT(first.predicted_drop, 1.4 * *first.actual_drop);
}

TEST(Screen, AStrengthThatCannotBeNegativeIsNot) {
  const Flight flight(fly(15.0, 33, {effect("viscous_friction")}, {{"viscosity", -12.0}}));
  const std::vector<Specimen> list = specimens(flight.estimate, flight.request, registry(), nullptr);
  const ScoreTest score(flight.estimate);
  const ForceColumns path(flight.estimate);
  int one_sided = 0;
  for (const auto& s : screen(flight.estimate, score, path, list, 0)) {
    if (s.specimen->strengths.size() != 1 || !s.specimen->one_sided.front() || !s.runs) continue;
    ++one_sided;
    EXPECT_GE(s.result.amplitude[0], 0.0) << s.specimen->effect;
    if (s.result.amplitude[0] == 0.0) {
      EXPECT_EQ(s.result.chi2, 0.0) << s.specimen->effect;
    }
  }
  EXPECT_GE(one_sided, 1);
}

TEST(Screen, FindsTheFrequencyOfALine) {
  const Flight flight(fly(15.0, 34, {effect("vortex_shedding")}, {{"y_cosine", 0.006}, {"z_sine", 0.004}, {"shedding_frequency", 2.7}}));
  const std::vector<Specimen> all = specimens(flight.estimate, flight.request, registry(), nullptr);
  std::vector<Specimen> list;
  for (const auto& s : all) {
    if (s.effect == "vortex_shedding") list.push_back(s);
  }
  ASSERT_EQ(list.size(), 1U);
  const ScoreTest score(flight.estimate);
  const ForceColumns path(flight.estimate);
  const std::vector<Screened> found = screen(flight.estimate, score, path, list, 0);
  EXPECT_NEAR(found[0].cell.back(), 2.7, 1.0 / (4.0 * 15.0));
  EXPECT_LT(found[0].p_value, 1e-4);
}

TEST(Specimens, LeaveOutWhatDoesNotSuit) {
  const Flight flight(fly(5.0, 35));
  std::vector<std::string> names;
  for (const auto& s : specimens(flight.estimate, flight.request, registry(), nullptr)) names.push_back(s.effect);
  EXPECT_THAT(names, testing::IsSupersetOf({"strut_wake", "vortex_shedding", "coulomb_friction", "camera_roll"}));
  for (const char* other : {"static_moment", "gravity", "gust", "apex_jitter", "coning", "periodic_forcing", "lag"})
    EXPECT_THAT(names, testing::Not(testing::Contains(other))) << "in the model, driven by noise, of another system, or specialised";
}

/// The model turns with a rolled camera: held gains would call the roll known nine times better than it is.
TEST(Specimens, ARolledCameraIsHardlySeenInTheMotion) {
  const Flight flight(fly(15.0, 36));
  for (const auto& s : specimens(flight.estimate, flight.request, registry(), nullptr)) {
    if (s.effect != "camera_roll") continue;
    const ScoreResult result = ScoreTest(flight.estimate).test(specimen_columns(flight.estimate, s, {}));
    EXPECT_GT(result.sigma[0], 1.0 * degree) << "only the camera's height tells up from down";
  }
}

}  // namespace
}  // namespace misfit
