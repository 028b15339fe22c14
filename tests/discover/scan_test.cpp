// Which values of a shape are looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "misfit/discover/candidate_model.h"
#include "tests/fit/flight.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_flight;

const std::string carriage_text = R"toml(
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 1.0 }
[inputs]
u = { unit = "m/s^2" }
[parameters]
c = { unit = "1/s", value = 1.0, bounds = [0.0, 100.0], free = true }
[ports]
push = { unit = "m/s^2" }
[equations]
x = "v"
v = "u - c*v + push"
[outputs]
x = { unit = "m", noise = 1e-3 }
)toml";

/// 5 cm to either side of `middle` [m].
Signals carriage(double middle) {
  constexpr double swing = 0.05, omega = 6.0;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 5e-4);
  Signals s;
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"u", "m/s^2", {}, 0.0}};
  for (int k = 0; k < 500; ++k) {
    const double t = 0.02 * k;
    s.t.push_back(t);
    s.measured[0].values.push_back(middle + swing * std::sin(omega * t) + noise(random));
    s.inputs[0].values.push_back(swing * omega * (std::cos(omega * t) - omega * std::sin(omega * t)));
  }
  return s;
}

/// The first cell's first shape, and the last's; of the first place, or of that with this factor.
std::pair<double, double> scanned(const Signals& recorded, const std::string& kind, const std::string& factor = "") {
  const auto systems = registry_with(carriage_text);
  const ModelRequest request = request_of("text");
  const std::vector<Signals> signals = {recorded};
  const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
  const std::vector<CandidateModel> all = candidate_models(estimate, request, *systems, nullptr);
  const auto found = std::find_if(all.begin(), all.end(), [&](const CandidateModel& c) {
    return c.effect == kind && (factor.empty() || (c.roles.contains("factor") && c.roles.at("factor") == factor));
  });
  if (found == all.end()) throw std::invalid_argument("no candidate " + kind + " " + factor);
  return {found->cells.front().front(), found->cells.back().front()};
}

/// Shorter ones look alike in samples 0.02 s apart, and take ever more steps.
TEST(Scan, HowFastALimitedRateFollowsIsNotLookedForFarBelowTheSamplingInterval) {
  const auto systems = registry_with(carriage_text);
  const ModelRequest request = request_of("text");
  const std::vector<Signals> signals = {carriage(0.0)};
  const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
  const std::vector<CandidateModel> all = candidate_models(estimate, request, *systems, nullptr);
  const auto found = std::find_if(all.begin(), all.end(), [](const CandidateModel& c) { return c.effect == "rate_limit"; });
  ASSERT_NE(found, all.end());
  const Parameter& follow_time = found->model.parameters[found->shapes[1]];
  EXPECT_NEAR(follow_time.lower, 0.1 * 0.02, 1e-6);
  EXPECT_LT(found->model.parameters[found->shapes[0]].lower, 1e-9) << "a rate has no such bound";
}

TEST(Scan, OfWhatDependsOnHowFarAMotionGoesDoesNotDependOnWhere) {
  for (const double middle : {0.0, 2.0}) {
    const auto [least, most] = scanned(carriage(middle), "backlash");
    EXPECT_NEAR(least, 0.03 * 0.05, 0.1 * 0.03 * 0.05) << middle;
    EXPECT_NEAR(most, 0.3 * 0.05, 0.1 * 0.3 * 0.05) << middle;
  }
  const auto [least, most] = scanned(carriage(2.0), "hysteresis");
  EXPECT_NEAR(least, 0.06 * 0.05, 0.1 * 0.06 * 0.05);
  EXPECT_NEAR(most, 0.5 * 0.05, 0.1 * 0.5 * 0.05);
}

/// The speed goes through 0; a position 2 m away does not, and its product with the input would be nearly the input itself.
TEST(Scan, OfAProductIsAtTheFactorNearestToZero) {
  const auto [of_speed, same] = scanned(carriage(2.0), "bilinear");
  EXPECT_EQ(of_speed, 0.0);
  EXPECT_EQ(same, 0.0);
  EXPECT_NEAR(scanned(carriage(2.0), "bilinear", "x").first, 1.95, 0.005);
  EXPECT_NEAR(scanned(carriage(-2.0), "bilinear", "x").first, -1.95, 0.005);
}

/// The amplitude of the input is 0.3 sqrt(37) m/s^2, its samples are 20 ms apart.
TEST(Scan, OfARateLimitIsOverWhatTheInputCouldDoBetweenSamples) {
  const double largest = 0.3 * std::sqrt(1.0 + 36.0), per_sample = largest / 0.02;
  const auto [least, most] = scanned(carriage(0.0), "rate_limit");
  EXPECT_NEAR(least, 0.003 * per_sample, 0.02 * 0.003 * per_sample);
  EXPECT_NEAR(most, 0.3 * per_sample, 0.02 * 0.3 * per_sample);
}

/// Of a carriage alone four values; with what follows it, a third state, one.
TEST(Scan, OfASideShapeIsOneValueInALargerSystem) {
  const std::vector<Signals> signals = {carriage(0.0)};
  const auto follow_times = [&](const std::string& text) {
    const auto systems = registry_with(text);
    const ModelRequest request = request_of("text");
    const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
    std::set<double> out;
    for (const CandidateModel& c : candidate_models(estimate, request, *systems, nullptr)) {
      if (c.effect != "rate_limit") continue;
      for (const auto& cell : c.cells) out.insert(cell.at(1));
    }
    return out;
  };
  const std::set<double> small = follow_times(carriage_text);
  ASSERT_EQ(small.size(), 4U);
  EXPECT_NEAR(*small.begin(), 0.01, 1e-9) << "half a sampling interval";
  EXPECT_NEAR(*small.rbegin(), 0.64, 1e-9) << "32 of them";
  std::string larger = carriage_text;
  larger.replace(larger.find("[inputs]"), 0, "w = { unit = \"m\", scale = 0.1 }\n");
  larger.replace(larger.find("[outputs]"), 0, "w = \"c*(x - w)\"\n");
  EXPECT_EQ(follow_times(larger), std::set<double>{*small.begin()});
}

/// Times with four digits, of which no difference of two is the interval.
TEST(Scan, OfAFieldOffsetIsAtTheRateOfTheSamples) {
  constexpr double rate = 50.2;
  Signals flight = fly(10.0, 38);
  for (std::size_t k = 0; k < flight.samples(); ++k) {
    flight.t[k] = std::round(static_cast<double>(k) / rate * 1e4) / 1e4;
    flight.measured[1].values[k] += k % 2 == 0 ? 0.5 : -0.5;
  }
  const std::vector<Signals> signals = {flight};
  const ModelRequest request = request_for(signals);
  const FilterEstimate estimate = fitted(request, signals);
  for (const CandidateModel& candidate : candidate_models(estimate, request, registry(), nullptr)) {
    if (candidate.effect != "field_offset") continue;
    ASSERT_EQ(candidate.cells.size(), 1U);
    EXPECT_NEAR(candidate.cells[0][0], rate, 1e-3);
    const Eigen::MatrixXd columns = sensitivity_columns(estimate, candidate, candidate.cells[0]);
    const ScoreResult result = ScoreTest(estimate).test(columns);
    EXPECT_NEAR(result.amplitude[0], 0.5, 0.1);
    EXPECT_GT(result.chi2, 100.0);
    return;
  }
  FAIL() << "no field offset";
}

}  // namespace
}  // namespace misfit
