// What the parameters of a model can do is at its maximum no sign of something missing, whatever their size.
#include <gtest/gtest.h>

#include "misfit/diagnose/score.h"
#include "tests/fit/room.h"

namespace misfit {
namespace {

using namespace testing_room;

/// At the maximum no column that is a combination of the parameters' has a score.
TEST(ScoreTest, OfACombinationOfLargeParametersIsSmall) {
  const FilterEstimate estimate = estimate_of(warming("tau", "2e4"));
  Eigen::MatrixXd columns = estimate.jacobians.front().J * Eigen::Vector2d(1.0, 0.5);
  columns(columns.rows() / 2, 0) += 1e-3 * columns.norm();  // so that it is not one of them altogether
  const ScoreResult result = ScoreTest(estimate).test(columns);
  EXPECT_EQ(result.dof, 1);
  EXPECT_LT(result.chi2, 10.0);
}

}  // namespace
}  // namespace misfit
