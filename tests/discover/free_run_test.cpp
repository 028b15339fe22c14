#include "misfit/discover/free_run.h"

#include <gtest/gtest.h>

#include "misfit/discover/discover.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Keeps pointers to the recordings.
FilterEstimate estimate_of(const std::vector<Signals>& recorded) {
  ModelRequest model = cart({effect("viscous_friction")});
  model.parameters["stiffness"].free = true;
  return estimate_filter(assemble(model, registry()), {}, recorded);
}

TEST(FreeRun, IsNotLookedAtWhereTheRandomForceDoesNothing) {
  const std::vector<Signals> recorded = {record_of_cart({}, {})};
  EXPECT_FALSE(free_run(estimate_of(recorded)));
}

TEST(FreeRun, ShowsWhatTheRandomForceTakesOver) {
  const std::vector<Signals> recorded = {
      record_of_cart({effect("periodic_forcing")}, {{"cosine", 0.4}, {"sine", 0.3}, {"frequency", 0.15}})};
  const FilterEstimate estimate = estimate_of(recorded);
  const auto calm = free_run(estimate);
  ASSERT_TRUE(calm);
  EXPECT_LT(calm->noise.force, 0.05 * estimate.noise.force);
  EXPECT_GT(calm->noise.channels.front().white, 1.2 * estimate.noise.channels.front().white);
  EXPECT_LT(calm->objective, estimate.objective) << "the estimate is the maximum";
}

}  // namespace
}  // namespace misfit
