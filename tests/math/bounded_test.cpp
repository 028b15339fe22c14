#include "misfit/math/bounded.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <random>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

TEST(MaximumInside, IsTheCentreWhereNoBoundIsInTheWay) {
  const Eigen::Vector2d centre(0.3, -0.2), lower(-1.0, -none), upper(none, 1.0);
  const BoundedMaximum found = maximum_inside(centre, Eigen::Matrix2d{{2.0, 0.5}, {0.5, 1.0}}, lower, upper);
  EXPECT_EQ(found.at, Eigen::VectorXd(centre));
  EXPECT_EQ(found.below, 0.0);
}

/// By hand: x held at 0 is 1 above its centre −1; y follows by Σ_yx/Σ_xx = 0.8/1 to 2 + 0.8 = 2.8; it is lower by ½·1²/1.
TEST(MaximumInside, TheOthersFollowWhatIsHeldAtItsBound) {
  const Eigen::Vector2d centre(-1.0, 2.0), lower(0.0, -none), upper(none, none);
  const BoundedMaximum found = maximum_inside(centre, Eigen::Matrix2d{{1.0, 0.8}, {0.8, 1.0}}, lower, upper);
  EXPECT_DOUBLE_EQ(found.at[0], 0.0);
  EXPECT_DOUBLE_EQ(found.at[1], 2.8);
  EXPECT_DOUBLE_EQ(found.below, 0.5);
}

/// y is beyond its bound at the centre, but no longer once x is held: it must be let go. P = Σ⁻¹, x held at 0: y = 0.5 − 0.9·(−2)… = 2.3.
TEST(MaximumInside, LetsGoWhatIsNoLongerBeyondItsBound) {
  const Eigen::Vector2d centre(-2.0, -0.5), lower(0.0, 0.0), upper(none, none);
  const BoundedMaximum found = maximum_inside(centre, Eigen::Matrix2d{{1.0, 0.9}, {0.9, 1.0}}, lower, upper);
  EXPECT_DOUBLE_EQ(found.at[0], 0.0);
  EXPECT_DOUBLE_EQ(found.at[1], 1.3);  // −0.5 + 0.9·2
}

/// Against what no method is needed for: no point of a random cloud in the box is higher.
TEST(MaximumInside, NoPointOfTheBoxIsHigher) {
  std::mt19937 dice(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int world = 0; world < 50; ++world) {
    constexpr int n = 5;
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(dice); });
    const Eigen::MatrixXd covariance = A * A.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd centre = Eigen::VectorXd::NullaryExpr(n, [&] { return 2.0 * normal(dice); });
    const Eigen::VectorXd lower = Eigen::VectorXd::Constant(n, -1.0), upper = Eigen::VectorXd::Constant(n, 0.5);
    const Eigen::MatrixXd P = inverse(covariance);
    const auto depth = [&](const Eigen::VectorXd& x) { return 0.5 * (x - centre).dot(P * (x - centre)); };
    const BoundedMaximum found = maximum_inside(centre, covariance, lower, upper);
    EXPECT_NEAR(found.below, depth(found.at), 1e-8 * (1.0 + found.below));
    for (int i = 0; i < n; ++i) EXPECT_TRUE(found.at[i] >= -1.0 && found.at[i] <= 0.5);
    for (int k = 0; k < 2000; ++k) {
      const double near = k % 2 == 0 ? 1.0 : 0.05;
      Eigen::VectorXd x = found.at + near * Eigen::VectorXd::NullaryExpr(n, [&] { return normal(dice); });
      x = x.cwiseMax(lower).cwiseMin(upper);
      EXPECT_GE(depth(x), found.below - 1e-9);
    }
  }
}

}  // namespace
}  // namespace misfit
