#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/formula/formulas.h"

namespace misfit {
namespace {

using namespace testing_formulas;

constexpr double x = somewhere[0], y = somewhere[1], a = somewhere[3], n = somewhere[4];

TEST(FormulaValues, AreThoseOfTheFunctions) {
  const std::vector<std::pair<std::string, double>> all = {{"sqrt(x)", std::sqrt(x)},
                                                           {"exp(a)", std::exp(a)},
                                                           {"log(n)", std::log(n)},
                                                           {"log10(n)", std::log10(n)},
                                                           {"sin(a)", std::sin(a)},
                                                           {"cos(a)", std::cos(a)},
                                                           {"tan(a)", std::tan(a)},
                                                           {"asin(a)", std::asin(a)},
                                                           {"acos(a)", std::acos(a)},
                                                           {"atan(n)", std::atan(n)},
                                                           {"atan2(y, x)", std::atan2(y, x)},
                                                           {"sinh(a)", std::sinh(a)},
                                                           {"cosh(a)", std::cosh(a)},
                                                           {"tanh(a)", std::tanh(a)},
                                                           {"abs(y)", 0.3},
                                                           {"sign(y)", -1.0},
                                                           {"min(x, y)", y},
                                                           {"max(x, y)", x},
                                                           {"hypot(x, y)", std::hypot(x, y)},
                                                           {"saturate(n, 0, 1)", 1.0},
                                                           {"saturate(-n, 0, 1)", 0.0},
                                                           {"saturate(a, 0, 1)", a},
                                                           {"smooth_step(n, 2)", 0.5 * (1.0 + std::tanh(n / 2.0))},
                                                           {"sign(n, 2)", std::tanh(n / 2.0)},
                                                           {"abs(n, 2)", std::sqrt(n * n + 4.0)},
                                                           {"max(n, 1, 0.5)", 0.5 * (n + 1.0 + std::sqrt((n - 1.0) * (n - 1.0) + 0.25))},
                                                           {"if(x > y, x, y)", x},
                                                           {"if(x < y or n >= 2.5 and not (a > 1), 1, 2)", 1.0},
                                                           {"if(x == x and x != y, 3, 4)", 3.0},
                                                           {"pow(n, 1.3)", std::pow(n, 1.3)},
                                                           {"pi", std::numbers::pi}};
  for (const auto& [text, expected] : all) EXPECT_NEAR(value(text), expected, 1e-15 * (1.0 + std::abs(expected))) << text;
}

TEST(FormulaValues, BindAsInMathematics) {
  EXPECT_EQ(value("2 + 3*4"), 14.0);
  EXPECT_EQ(value("2*3^2"), 18.0);
  EXPECT_EQ(value("-3^2"), -9.0) << "a power binds tighter than a sign";
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^3^2"), 512.0) << "powers bind to the right";
  EXPECT_EQ(value("8/4/2"), 1.0);
  EXPECT_EQ(value("8 - 4 - 2"), 2.0);
  EXPECT_EQ(value("-2*-3"), 6.0);
  EXPECT_EQ(value("1.5e1 + .5"), 15.5);
  EXPECT_EQ(value("if(1 < 2 and not 3 < 2 or 0 > 1, 5, 6)"), 5.0);
}

TEST(FormulaValues, ShareWhatIsCommonAndFoldWhatIsConstant) {
  const Made made("sin(a)*sin(a) + sin(a)*2*3 + 0*x/x");
  std::size_t sines = 0;
  const formula::Program alone(made.graph, {made.meaning.node}, static_cast<int>(known.size()));
  for (const auto& step : alone.steps()) sines += step.op == formula::Op::sin ? 1 : 0;
  EXPECT_EQ(sines, 1U);
  EXPECT_LE(alone.steps().size(), 5U);
}

double by_difference(const Made& made, Point at, std::size_t i) {
  const double h = 1e-6 * (1.0 + std::abs(at[i])), middle = at[i];
  at[i] = middle + h;
  const double above = made(at)[0];
  at[i] = middle - h;
  return (above - made(at)[0]) / (2.0 * h);
}

class FormulaDerivatives : public testing::TestWithParam<const char*> {};

TEST_P(FormulaDerivatives, AreThoseOfCentralDifferences) {
  const Made made(GetParam());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  for (int trial = 0; trial < 20; ++trial) {
    Point at;
    for (double& v : at) v = uniform(random);
    at[4] = 1.0 + 2.0 * uniform(random);
    const std::vector<double> exact = made(at);
    for (std::size_t i = 0; i < known.size(); ++i)
      EXPECT_NEAR(exact[i + 1], by_difference(made, at, i), 1e-7 * (1.0 + std::abs(exact[i + 1]))) << known[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, FormulaDerivatives,
                         testing::Values("x + 2*y - x*y/x", "x/y + y/x", "-x^3/y^2 + x", "sqrt(x*y)*n", "exp(a*n)", "log(n*a)", "log10(n)",
                                         "sin(a)*cos(n*a)", "tan(a)", "asin(a)", "acos(a*a)", "atan(n)", "atan2(y, x)*a", "sinh(n)",
                                         "cosh(n)", "tanh(n*a)", "abs(x - y)", "sign(x)*x", "min(x, y)*n", "max(x, 2*y)", "hypot(x, y)",
                                         "saturate(n, a, 2)", "smooth_step(x, y)", "sign(x - y, y)", "abs(x - y, y)", "min(x, y, y)",
                                         "max(x, y, y)", "saturate(x, y/2, y, y)", "if(x > y, x^2, x*y)", "n^a", "n^1.7", "n^0.3", "n^-2",
                                         "pow(a, n)", "k*sqrt(max(x - y, 0)/n)*t", "if(x > y, sqrt(x - y), sqrt(y - x))"));

TEST(FormulaDerivatives, OfABranchNotTakenAreNothingEvenWhereItIsNotDefined) {
  const Made made("if(x > 0, sqrt(x)*n, y/x*sqrt(x) + log(x/y)*0)");
  Point at = somewhere;
  at[0] = 0.25;
  at[1] = 0.0;
  const std::vector<double> out = made(at);
  EXPECT_DOUBLE_EQ(out[0], 1.25);
  EXPECT_DOUBLE_EQ(out[1], 2.5);
  EXPECT_DOUBLE_EQ(out[2], 0.0);
}

TEST(FormulaDerivatives, AreFiniteWhereFunctionsHaveNone) {
  for (const char* text :
       {"sqrt(x)", "hypot(x, y)", "atan2(y, x)", "abs(x)", "sign(x)*y", "asin(1 + a*0 + x/v*k)", "(x/v*k)^0.5", "max(x, y)"}) {
    Point at = somewhere;
    at[0] = at[1] = 0.0;
    for (double v : Made(text)(at)) EXPECT_TRUE(std::isfinite(v)) << text;
  }
}

TEST(FormulaDerivatives, AtAKinkAreThoseOfTheFirstBranch) {
  Point at = somewhere;
  at[0] = at[1] = 0.4;
  EXPECT_EQ(Made("max(x, y)")(at)[1], 1.0);
  EXPECT_EQ(Made("max(x, y)")(at)[2], 0.0);
  EXPECT_EQ(Made("min(y, x)")(at)[2], 1.0);
  EXPECT_EQ(Made("abs(x - y)")(at)[1], 0.0);
}

TEST(FormulaDerivatives, AtTheSteepestTakeASmoothedJumpInItsMiddle) {
  Point far = somewhere;
  far[4] = 50.0;
  EXPECT_LT(Made("sign(n, 0.1)")(far)[5], 1e-10);
  EXPECT_DOUBLE_EQ(Made("sign(n, 0.1)", true)(far)[5], 10.0);
}

}  // namespace
}  // namespace misfit
