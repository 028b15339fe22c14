#include "misfit/math/bspline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "misfit/core/error.h"

namespace misfit {
namespace {

const std::vector<double> uneven = {0.05, 0.11, 0.13, 0.3, 0.31, 0.62, 1.4};

/// Cox–de Boor as in the books, on doubles, with coalescent ends: independent of the polynomial pieces under test.
double cox_de_boor(const std::vector<double>& t, std::size_t i, int degree, double x) {
  if (degree == 0) return t[i] <= x && x < t[i + 1] ? 1.0 : 0.0;
  const auto p = static_cast<std::size_t>(degree);
  double sum = 0.0;
  if (t[i + p] > t[i]) sum += (x - t[i]) / (t[i + p] - t[i]) * cox_de_boor(t, i, degree - 1, x);
  if (t[i + p + 1] > t[i + 1]) sum += (t[i + p + 1] - x) / (t[i + p + 1] - t[i + 1]) * cox_de_boor(t, i + 1, degree - 1, x);
  return sum;
}

std::vector<double> with_ends(const std::vector<double>& knots) {
  std::vector<double> t(3, knots.front());
  t.insert(t.end(), knots.begin(), knots.end());
  t.insert(t.end(), 3, knots.back());
  return t;
}

std::vector<double> random_coefficients(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> c(static_cast<std::size_t>(n));
  for (double& value : c) value = uniform(random);
  return c;
}

double dot(const std::array<double, 4>& w, int first, const std::vector<double>& c) {
  double sum = 0.0;
  for (std::size_t j = 0; j < 4; ++j) sum += w[j] * c.at(static_cast<std::size_t>(first) + j);
  return sum;
}
double value(const CubicSpline& s, const std::vector<double>& c, double x) { return dot(s.at(x).w, s.at(x).first, c); }
double slope(const CubicSpline& s, const std::vector<double>& c, double x) { return dot(s.at(x).d, s.at(x).first, c); }
double sine_value(const CubicSpline& s, const std::vector<double>& c, double x) { return dot(s.over_sine(x).w, s.over_sine(x).first, c); }
double sine_slope(const CubicSpline& s, const std::vector<double>& c, double x) { return dot(s.over_sine(x).d, s.over_sine(x).first, c); }

TEST(CubicSplineTest, AgreesWithTheRecurrenceOfCoxAndDeBoorOnUnevenKnots) {
  const CubicSpline s(uneven);
  const auto t = with_ends(uneven);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(uneven.front(), uneven.back());
  for (int trial = 0; trial < 500; ++trial) {
    const double x = inside(random);
    const CurvePoint p = s.at(x);
    for (int i = 0; i < s.size(); ++i) {
      const double expected = cox_de_boor(t, static_cast<std::size_t>(i), 3, x);
      const bool local = i >= p.first && i < p.first + 4;
      EXPECT_NEAR(local ? p.w[static_cast<std::size_t>(i - p.first)] : 0.0, expected, 1e-12) << "x = " << x << ", basis " << i;
    }
  }
}

TEST(CubicSplineTest, WeightsSumToOneAndSlopesToZeroInsideAndOnTheStraightContinuation) {
  const CubicSpline s(uneven);
  for (double x : {-3.0, 0.05, 0.0500001, 0.11, 0.2, 0.3, 0.305, 1.0, 1.4, 1.5, 40.0}) {
    const CurvePoint p = s.at(x);
    EXPECT_NEAR(p.w[0] + p.w[1] + p.w[2] + p.w[3], 1.0, 1e-9) << x;
    EXPECT_NEAR(p.d[0] + p.d[1] + p.d[2] + p.d[3], 0.0, 1e-9) << x;
  }
}

class CubicSplineOfParity : public testing::TestWithParam<Parity> {};
INSTANTIATE_TEST_SUITE_P(All, CubicSplineOfParity, testing::Values(Parity::none, Parity::odd, Parity::even));

TEST_P(CubicSplineOfParity, SlopeIsTheCentralDifferenceOfTheValueInsideAndOutside) {
  const CubicSpline s(uneven, GetParam());
  const auto c = random_coefficients(s.size(), 2);
  constexpr double h = 1e-6;
  for (double x = -2.0; x < 2.5; x += 0.0137) {
    const double difference = (value(s, c, x + h) - value(s, c, x - h)) / (2.0 * h);
    EXPECT_NEAR(slope(s, c, x), difference, 1e-6 * (1.0 + 100.0 * std::abs(difference))) << x;
  }
}

TEST_P(CubicSplineOfParity, ValueAndSlopeAreContinuousAtKnotsAndWhereTheContinuationsBegin) {
  const CubicSpline s(uneven, GetParam());
  const auto c = random_coefficients(s.size(), 3);
  for (double knot : uneven) {
    for (double sign : {-1.0, 1.0}) {
      const double x = sign * knot;
      const double before = std::nextafter(x, -10.0), after = std::nextafter(x, 10.0);
      EXPECT_NEAR(value(s, c, before), value(s, c, after), 1e-12) << x;
      EXPECT_NEAR(slope(s, c, before), slope(s, c, after), 1e-9) << x;
    }
  }
}

TEST_P(CubicSplineOfParity, SecondDerivativeIsContinuousAtInnerKnots) {
  const CubicSpline s(uneven, GetParam());
  const auto c = random_coefficients(s.size(), 4);
  constexpr double h = 1e-5;
  for (std::size_t k = 1; k + 1 < uneven.size(); ++k) {
    const double x = uneven[k];
    const double left = (slope(s, c, x) - slope(s, c, x - h)) / h, right = (slope(s, c, x + h) - slope(s, c, x)) / h;
    EXPECT_NEAR(left, right, 1e-2 * (1.0 + std::abs(left))) << x;
  }
}

TEST_P(CubicSplineOfParity, AboveTheLastKnotItIsAStraightLine) {
  const CubicSpline s(uneven, GetParam());
  const auto c = random_coefficients(s.size(), 5);
  const double end = value(s, c, 1.4), direction = slope(s, c, 1.4);
  EXPECT_NEAR(value(s, c, 7.4), end + 6.0 * direction, 1e-12);
  EXPECT_NEAR(slope(s, c, 7.4), direction, 1e-12);
}

TEST(CubicSplineTest, WithoutParityItIsAStraightLineBelowTheFirstKnot) {
  const CubicSpline s(uneven);
  const auto c = random_coefficients(s.size(), 6);
  EXPECT_NEAR(value(s, c, -1.95), value(s, c, 0.05) - 2.0 * slope(s, c, 0.05), 1e-12);
}

TEST(CubicSplineTest, AnOddCurveChangesSignWithItsArgumentAndIsZeroAtZero) {
  const CubicSpline s(uneven, Parity::odd);
  const auto c = random_coefficients(s.size(), 7);
  EXPECT_EQ(value(s, c, 0.0), 0.0);
  for (double x : {1e-9, 0.01, 0.05, 0.2, 1.39, 5.0}) {
    EXPECT_EQ(value(s, c, -x), -value(s, c, x)) << x;
    EXPECT_EQ(slope(s, c, -x), slope(s, c, x)) << x;
  }
}

TEST(CubicSplineTest, AnEvenCurveKeepsItsValueUnderChangeOfSignAndIsFlatAtZero) {
  const CubicSpline s(uneven, Parity::even);
  const auto c = random_coefficients(s.size(), 8);
  EXPECT_EQ(slope(s, c, 0.0), 0.0);
  for (double x : {1e-9, 0.01, 0.05, 0.2, 1.39, 5.0}) {
    EXPECT_EQ(value(s, c, -x), value(s, c, x)) << x;
    EXPECT_EQ(slope(s, c, -x), -slope(s, c, x)) << x;
  }
}

TEST(CubicSplineTest, OverSineIsTheCurveDividedByTheSine) {
  const CubicSpline s(uneven, Parity::odd);
  const auto c = random_coefficients(s.size(), 9);
  for (double x : {-1.2, -0.3, -2e-4, 1.1e-4, 1e-3, 0.05, 0.5, 1.3, 1.6})
    EXPECT_NEAR(sine_value(s, c, x), value(s, c, x) / std::sin(x), 1e-9) << x;
}

TEST(CubicSplineTest, OverSineAtZeroIsTheSlopeOfTheCurveAndFlat) {
  const CubicSpline s(uneven, Parity::odd);
  const auto c = random_coefficients(s.size(), 10);
  EXPECT_NEAR(sine_value(s, c, 0.0), slope(s, c, 0.0), 1e-12 * std::abs(slope(s, c, 0.0)));
  EXPECT_EQ(sine_slope(s, c, 0.0), 0.0);
}

TEST(CubicSplineTest, OverSineIsSmoothThroughZeroAndThroughTheChangeOfFormula) {
  const CubicSpline s(uneven, Parity::odd);
  const auto c = random_coefficients(s.size(), 11);
  // C = a x + b x³ near 0, so C/sin x = a + (b + a/6) x² + O(x⁴), its slope 2 (b + a/6) x.
  const double a = slope(s, c, 0.0);
  const double b = (value(s, c, 0.04) / 0.04 - a) / (0.04 * 0.04);
  for (double x : {1e-9, 1e-7, 1e-5, 0.99e-4, 0.9999999e-4, 1.0000001e-4, 1.01e-4, 3e-4}) {
    for (double sign : {-1.0, 1.0}) {
      EXPECT_NEAR(sine_value(s, c, sign * x), a + (b + a / 6.0) * x * x, 1e-11 * (std::abs(a) + std::abs(b))) << x;
      // Beyond the change of formula the slope is a difference of two numbers of size 1/x: half its digits are lost there, no more.
      const double allowed = (x < 1e-4 ? 1e-6 * x : 1e-15 / x * 10.0 + 1e-6 * x) * (std::abs(a) + std::abs(b));
      EXPECT_NEAR(sine_slope(s, c, sign * x), sign * 2.0 * (b + a / 6.0) * x, allowed) << x;
    }
  }
}

TEST(CubicSplineTest, RoughnessIsTheIntegralOfTheSquaredSecondDerivative) {
  const CubicSpline s(uneven);
  const auto c = random_coefficients(s.size(), 12);
  const Eigen::Map<const Eigen::VectorXd> v(c.data(), s.size());
  // C'' is linear between knots: two Gauss points per interval are exact for its square; C'' from the exact slope differences of a
  // parabola.
  double integral = 0.0;
  for (std::size_t i = 0; i + 1 < uneven.size(); ++i) {
    const double middle = (uneven[i] + uneven[i + 1]) / 2.0, half = (uneven[i + 1] - uneven[i]) / 2.0;
    for (double node : {-1.0, 1.0}) {
      const double x = middle + node * half / std::numbers::sqrt3;
      const double h = 0.1 * half;  // slopes are parabolas: central differences of them are exact
      const double second = (slope(s, c, x + h) - slope(s, c, x - h)) / (2.0 * h);
      integral += half * second * second;
    }
  }
  EXPECT_NEAR(v.dot(s.roughness() * v), integral, 1e-8 * integral);
}

TEST(CubicSplineTest, RoughnessIsSymmetricAndNoLineHasAny) {
  const CubicSpline s(uneven);
  const Eigen::MatrixXd omega = s.roughness();
  EXPECT_LT((omega - omega.transpose()).norm(), 1e-10 * omega.norm());
  EXPECT_LT((omega * s.line(0.3, 2.0, -5.0)).norm(), 1e-10 * omega.norm());
}

TEST(CubicSplineTest, LineIsExactInsideAndOutside) {
  const CubicSpline s(uneven);
  const Eigen::VectorXd line = s.line(0.2, 1.5, -0.7);
  const std::vector<double> c(line.data(), line.data() + line.size());
  for (double x = -1.0; x < 2.0; x += 0.031) {
    EXPECT_NEAR(value(s, c, x), 1.5 - 0.7 * (x - 0.2), 1e-12);
    EXPECT_NEAR(slope(s, c, x), -0.7, 1e-10);
  }
}

TEST_P(CubicSplineOfParity, NoArgumentReachesOutsideTheCoefficients) {
  const CubicSpline s(uneven, GetParam());
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double most = std::numeric_limits<double>::max();
  for (double x :
       {inf, -inf, std::nan(""), -std::nan(""), most, -most, 1e300, -1e300, 0.0, -0.0, std::numeric_limits<double>::denorm_min()}) {
    for (const CurvePoint& p : {s.at(x), s.over_sine(x)}) {
      EXPECT_GE(p.first, 0) << x;
      EXPECT_LE(p.first + 4, s.size()) << x;
    }
  }
}

TEST_P(CubicSplineOfParity, NotANumberGivesNotANumber) {
  const CubicSpline s(uneven, GetParam());
  for (double weight : s.at(std::nan("")).w) EXPECT_TRUE(std::isnan(weight));
  for (double weight : s.over_sine(std::nan("")).d) EXPECT_TRUE(std::isnan(weight));
}

TEST(CubicSplineTest, TwoKnotsAreOneCubic) {
  const CubicSpline s({1.0, 3.0});
  ASSERT_EQ(s.size(), 4);
  const std::vector<double> bernstein = {1.0, 0.0, 0.0, 0.0};  // (1 − u)³ with u = (x − 1)/2
  EXPECT_NEAR(value(s, bernstein, 1.5), std::pow(0.75, 3), 1e-15);
  EXPECT_NEAR(slope(s, bernstein, 1.5), -1.5 * 0.75 * 0.75, 1e-15);
}

TEST(CubicSplineTest, AKnotAtZeroOfAnOddOrEvenCurveDoesNotCount) {
  EXPECT_EQ(CubicSpline({0.0, 0.1, 0.2}, Parity::odd).size(), 4);
  EXPECT_EQ(CubicSpline({0.0, 0.1, 0.2}, Parity::even).lowest(), 0.1);
  EXPECT_EQ(CubicSpline({0.0, 0.1, 0.2}).size(), 5);
}

TEST(CubicSplineTest, KnotsThatMakeNoCurveAreRefused) {
  EXPECT_THROW(CubicSpline(std::vector<double>{}), InputError);
  EXPECT_THROW(CubicSpline({1.0}), InputError);
  EXPECT_THROW(CubicSpline({0.0, 1.0}, Parity::odd), InputError);  // the one at 0 does not count
  EXPECT_THROW(CubicSpline({0.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(CubicSpline({0.0, 2.0, 1.0}), InputError);
  EXPECT_THROW(CubicSpline({0.0, std::nan(""), 1.0}), InputError);
  EXPECT_THROW(CubicSpline({-1.0, 1.0, 2.0}, Parity::even), InputError);
}

TEST(CubicSplineTest, KnotsThatAreNotFiniteAreRefused) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(CubicSpline({0.0, 1.0, inf}), InputError);
  EXPECT_THROW(CubicSpline({-inf, 1.0, 2.0}), InputError);
}

}  // namespace
}  // namespace misfit
