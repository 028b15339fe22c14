// A threshold is one only where values lie on both sides of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "misfit/discover/verdict.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Two tanks of which the first spills above 1.4, fitted with the overflow's edge held at `threshold`.
std::optional<std::string> edge_of(double threshold) {
  const std::vector<EffectRequest> spills = {effect("overflow", {{"level", "x1"}, {"port", "dx1/dt"}})};
  static std::vector<Signals> signals;  // an estimate points to it
  signals = {record(tanks(spills), {{"spill", 0.5}, {"threshold", 1.4}}, 2.0, -8.0, {2e-3, 2e-3}, 42)};
  ModelRequest request = tanks(spills);
  request.parameters["threshold"].value = threshold;
  request.parameters["threshold"].free = false;
  request.parameters["spill"].value = 0.1;
  return edge_not_visited(estimate_filter(assemble(request, registry()), {}, signals));
}

TEST(AnEdge, AmongTheValuesVisitedIsOne) { EXPECT_FALSE(edge_of(1.4)); }

TEST(AnEdge, BelowAllThatWasVisitedIsNone) {
  const auto words = edge_of(-5.0);
  ASSERT_TRUE(words);
  EXPECT_THAT(*words, testing::AllOf(testing::StartsWith("its threshold = -5"), testing::HasSubstr("is outside of what was visited"),
                                     testing::HasSubstr("there it is no edge")));
}

/// A cart driven through an actuator with a lag of 60 ms, fitted with a limit of its rate held at `limit` [N/s].
std::optional<std::string> limit_of(double limit) {
  static std::vector<Signals> signals;  // an estimate points to it
  signals = {record_of_cart({effect("input_lag")}, {{"lagged_gain", 1.0}, {"input_tau", 0.06}})};
  ModelRequest request = cart({effect("viscous_friction"), effect("rate_limit")});
  for (const auto& [name, value] : std::map<std::string, double>{{"limited_gain", 1.0}, {"rate_limit", limit}, {"follow_time", 0.06}}) {
    request.parameters[name].value = value;
    request.parameters[name].free = false;
  }
  return hardly_reached(estimate_filter(assemble(request, registry()), {}, signals));
}

TEST(ALimitOfARate, ThatSamplesReachIsOne) { EXPECT_FALSE(limit_of(100.0)); }

TEST(ALimitOfARate, ThatIsHardlyReachedIsNone) {
  const auto words = limit_of(5000.0);
  ASSERT_TRUE(words);
  EXPECT_THAT(*words,
              testing::AllOf(testing::StartsWith("its rate_limit = 5000 N/s is reached in"), testing::HasSubstr("% of the samples")));
}

}  // namespace
}  // namespace misfit
