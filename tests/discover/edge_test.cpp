// A threshold is one only where values lie on both sides of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace misfit
