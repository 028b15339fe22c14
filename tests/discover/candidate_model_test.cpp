// What discovery lets the coefficients of a candidate be.
#include "misfit/discover/candidate_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/diagnose/distinct_ports.h"
#include "tests/discover/record.h"
#include "tests/fit/gimbal.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Of the cart's record, one sample every 50 ms.
std::vector<CandidateModel> candidates_of_cart() {
  static std::vector<Signals> signals;  // an estimate points to it
  signals = {record_of_cart({}, {})};
  ModelRequest request = cart({effect("viscous_friction")});
  request.parameters["stiffness"].free = true;
  return candidate_models(estimate_filter(assemble(request, registry()), {}, signals), request, registry(), nullptr);
}

const Parameter& coefficient(const std::vector<CandidateModel>& candidates, const std::string& effect, const std::string& name) {
  const auto found = std::find_if(candidates.begin(), candidates.end(), [&](const CandidateModel& c) { return c.effect == effect; });
  if (found == candidates.end()) throw std::invalid_argument("no candidate " + effect);
  const auto& parameters = found->model.parameters;
  return *std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
}

TEST(ACandidate, HasItsClockWithinFortySamples) {
  const std::vector<CandidateModel> candidates = candidates_of_cart();
  const Parameter& offset = coefficient(candidates, "time_offset", "clock_offset");
  EXPECT_NEAR(offset.lower, -40 * 0.05, 1e-9);
  EXPECT_NEAR(offset.upper, 40 * 0.05, 1e-9);
  const Parameter& of_one = coefficient(candidates, "sensor_clock", "sensor_offset");
  EXPECT_EQ(of_one.lower, 0.0) << "a late sensor is a sensor_delay";
  EXPECT_NEAR(of_one.upper, 40 * 0.05, 1e-9);
  EXPECT_EQ(coefficient(candidates, "sensor_clock", "clock_rate").upper, 0.1) << "a rate, no time";
}

TEST(TwinsAmongCandidates, AreThoseAtTheRateThatADeclaredMomentIsAMultipleOf) {
  const auto known = testing_gimbal::registry_with(testing_gimbal::gimbal("J"));
  const FilterEstimate estimate = testing_gimbal::estimate_of(*known);
  std::vector<CandidateModel> all = candidate_models(estimate, testing_gimbal::request_of("text"), *known, nullptr);
  const auto count = [&](const std::string& port) {
    return std::count_if(all.begin(), all.end(),
                         [&](const CandidateModel& c) { return c.effect == "cubic_stiffness" && c.port_names == std::vector{port}; });
  };
  ASSERT_EQ(count("cable"), 1);
  ASSERT_EQ(count("dw/dt"), 1);
  leave_out(twins_among(all, sought_at(estimate.model.system->spec(), ForceSensitivity(estimate))), all);
  EXPECT_EQ(count("cable"), 1);
  EXPECT_EQ(count("dw/dt"), 0);
}

}  // namespace
}  // namespace misfit
