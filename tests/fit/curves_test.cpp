#include "misfit/inference/curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_planar;

TEST(ChooseKnots, ValuesThatAreNotKnownAreNoneOfTheVisited) {
  std::vector<double> visited, with_gaps;
  for (int i = 0; i < 2000; ++i) {
    const double value = std::sin(0.1 * i);
    visited.push_back(value);
    with_gaps.push_back(value);
    if (i % 3 == 0) with_gaps.push_back(std::nan(""));
  }
  EXPECT_EQ(choose_knots(with_gaps, 8, "C"), choose_knots(visited, 8, "C"));
}

/// The grid that describe() gives C_m over these knots [rad].
std::vector<double> grid_of(const std::vector<double>& knots) {
  ModelRequest request = eq_8();
  request.curves.at("C_m").knots = knots;
  const Model model = assemble(request, registry());
  const auto n = static_cast<Eigen::Index>(model.free_parameters().size());
  Fit fit;
  describe(model, Eigen::MatrixXd::Identity(n, n), RowMatrix(0, model.system->spec().quantities.size()), fit);
  return fit.curves.front().x;
}

TEST(GridOfACurve, OfAnAngleThatHardlyMovesHasTwentySteps) {
  const std::vector<double> x = grid_of({0.2, 0.2005, 0.201});
  EXPECT_GE(x.size(), 21U);
  EXPECT_NEAR(x[1] - x[0], 0.001 / 20.0, 1e-12);
}

TEST(GridOfACurve, OfAnAngleOfSeveralDegreesStepsByATenthOfADegree) {
  const std::vector<double> x = grid_of({0.1, 0.2, 0.3});
  EXPECT_NEAR(x[1] - x[0], 0.1 * degree, 1e-12);
  EXPECT_NEAR(x[0] / (0.1 * degree), std::round(x[0] / (0.1 * degree)), 1e-9);
}

}  // namespace
}  // namespace misfit
