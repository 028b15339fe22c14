// A motion of millimetres makes coefficients of tens of millions, of which nobody says a typical size.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/regression/equation_error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

constexpr double stiffness = 30.0, cubic = 3e7, noise = 2e-6;

const Registry& known() {
  static const auto made = testing_models::registry_with(R"toml([states]
y = { unit = "m", scale = 0.001 }
v = { unit = "m/s", scale = 0.01 }
[parameters]
stiffness = { unit = "1/s^2", value = 20.0, free = true }
cubic = { unit = "1/m^2/s^2", value = 0.0, free = true }
[equations]
y = "v"
v = "-stiffness*y - cubic*y^3"
[outputs]
y = { unit = "m", noise = 1e-5 }
)toml");
  return *made;
}

/// By a Runge-Kutta method of its own, from 1.5 mm.
Signals recorded() {
  constexpr double h = 0.02;
  std::mt19937_64 random(5);
  std::normal_distribution<double> error(0.0, noise);
  Signals out;
  out.name = "made";
  out.measured.push_back({"y", "m", {}});
  std::array<double, 2> x = {1.5e-3, 0.0};
  const auto rates = [](const std::array<double, 2>& s) {
    return std::array<double, 2>{s[1], -stiffness * s[0] - cubic * s[0] * s[0] * s[0]};
  };
  for (int i = 0; i < 400; ++i) {
    out.t.push_back(h * i);
    out.measured.front().values.push_back(x[0] + error(random));
    constexpr int parts = 10;
    for (int part = 0; part < parts; ++part) {
      constexpr double d = h / parts;
      const auto moved = [&](const std::array<double, 2>& k, double by) {
        return std::array<double, 2>{x[0] + by * k[0], x[1] + by * k[1]};
      };
      const auto a = rates(x), b = rates(moved(a, 0.5 * d)), c = rates(moved(b, 0.5 * d)), e = rates(moved(c, d));
      for (std::size_t j = 0; j < 2; ++j) x[j] += d / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + e[j]);
    }
  }
  return out;
}

void expect_truth(const Model& model, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd theta = model.theta();
  const double sigma = std::sqrt(covariance(1, 1));
  EXPECT_NEAR(theta[1], cubic, 4.0 * sigma);
  EXPECT_LT(sigma, 0.05 * cubic);
  EXPECT_GT(sigma, 1e3) << "the typical size of 1 says nothing";
}

TEST(LargeCoefficient, IsFoundFromZeroByTheFilter) {
  const Model start = assemble(testing_models::request_of("text"), known());
  const FilterEstimate estimate = estimate_filter(start, {}, {recorded()});
  EXPECT_TRUE(estimate.converged) << estimate.message;
  expect_truth(estimate.model, estimate.covariance);
}

TEST(LargeCoefficient, IsFoundFromZeroByTheRegression) {
  const FittedModel out = equation_error(assemble(testing_models::request_of("text"), known()), {recorded()});
  EXPECT_EQ(out.fit.status, FitStatus::converged) << out.fit.message;
  EXPECT_NEAR(out.model.theta()[1], cubic, 0.2 * cubic) << "differences over five samples flatten the motion";
}

}  // namespace
}  // namespace misfit
