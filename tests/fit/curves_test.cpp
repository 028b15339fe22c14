#include "misfit/inference/curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "tests/fit/planar_model.h"
#include "tests/model/declared_texts.h"

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

/// A cell of which the voltage alone is read: charge and polarisation share it, so that no sample shows either.
const std::string cell = R"toml(
[states]
charge = { unit = "-", initial = { kind = "free", value = 0.5 } }
polarisation = { unit = "V", scale = 0.05 }
[inputs]
I = { unit = "A", hold = "zero_order" }
[parameters]
capacity = { unit = "A s", value = 100.0 }
R = { unit = "V/A", value = 0.01 }
E0 = { unit = "V", value = 3.0 }
E1 = { unit = "V", value = 0.6 }
tau = { unit = "s", value = 5.0 }
[equations]
charge = "-I/capacity"
polarisation = "(R*I - polarisation)/tau"
[outputs]
U = { unit = "V", formula = "E0 + E1*charge - polarisation" }
)toml";

std::vector<double> knots_over_charge(double current) {
  const auto known = testing_models::registry_with(cell);
  ModelRequest request =
      testing_models::request_of("text", {testing_models::effect("unknown_force", {{"of", "charge"}, {"port", "dpolarisation/dt"}})});
  Signals s;
  s.name = "record";
  s.measured = {{"U", "V", {}, 0.0}};
  s.inputs = {{"I", "A", {}, 0.0}};
  for (int i = 0; i <= 200; ++i) {
    s.t.push_back(0.1 * i);
    s.measured[0].values.push_back(3.3);
    s.inputs[0].values.push_back(current);
  }
  choose_all_knots(request, *known, {s}, 4);
  return request.curves.at("unknown_force").knots;
}

TEST(ChooseKnots, OverAStateThatNothingShowsAreWhereTheModelTakesIt) {
  const std::vector<double> knots = knots_over_charge(2.0);  // 2 A for 20 s of 100 A s: 0.5 to 0.1
  ASSERT_EQ(knots.size(), 5U);
  EXPECT_NEAR(knots.front(), 0.1, 0.005);
  EXPECT_NEAR(knots.back(), 0.5, 0.005);
}

TEST(ChooseKnots, OverAStateThatNothingMovesAreNone) { EXPECT_THROW(knots_over_charge(0.0), RunError); }

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
