// A system of two domains: what drives one equation is no measure of what drives the other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double inductance = 0.02, resistance = 1.0, constant = 0.1, inertia = 0.01, damping = 0.02;

const std::string motor_text = R"toml(
[states]
i = { unit = "A", scale = 5.0 }
w = { unit = "rad/s", scale = 20.0 }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
L = { unit = "V s/A", value = 0.02 }
R = { unit = "V/A", value = 1.2, bounds = [0.0, 100.0], free = true }
k = { unit = "V s", value = 0.1 }
J = { unit = "V A s^3", value = 0.01 }
b = { unit = "V A s^2", value = 0.03, bounds = [0.0, 1.0], free = true }
[equations]
i = "(u - R*i - k*w)/L"
w = "(k*i - b*w)/J"
[outputs]
i = { unit = "A", noise = 0.01 }
w = { unit = "rad/s", noise = 0.05 }
)toml";

/// A random torque of 5 rad/s^2, correlated over 0.1 s, and nothing on the current; Euler steps of 0.1 ms, 10 ms apart.
Signals record() {
  constexpr double h = 1e-4, step = 1e-2, memory = 0.1, torque = 5.0;
  constexpr int samples = 2000, held = 40, steps = 100;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "motor";
  s.inputs = {{"u", "V", {}, 0.0}};
  s.measured = {{"i", "A", {}, 0.0}, {"w", "rad/s", {}, 0.0}};
  double i = 0.0, w = 0.0, u = 0.0, force = 0.0;
  for (int n = 0; n < samples; ++n) {
    if (n % held == 0) u = 6.0 * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(i + 0.01 * normal(random));
    s.measured[1].values.push_back(w + 0.05 * normal(random));
    for (int k = 0; k < steps; ++k) {
      const double di = (u - resistance * i - constant * w) / inductance, dw = (constant * i - damping * w) / inertia + force;
      i += h * di;
      w += h * dw;
      force += -h * force / memory + torque * std::sqrt(2.0 * h / memory) * normal(random);
    }
  }
  return s;
}

Fit fitted(const std::optional<KnownForce>& prior) {
  const auto registry = registry_with(motor_text);
  Model model = assemble(request_of("text"), *registry);
  model.force_strength = prior;
  const std::vector<Signals> experiments{record()};
  FilterOptions options;
  options.threads = 1;
  return filter_error(trajectory_start(model, experiments).from, experiments, options).fit;
}

const Fit& fitted_without_prior() {
  static const Fit fit = fitted({});
  return fit;
}

TEST(RandomForce, HasAStrengthForEachUnitOfItsPorts) {
  const Fit& fit = fitted_without_prior();
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_TRUE(fit.driven);
  const Estimate torque = fit.force.at("dw/dt"), voltage = fit.force.at("di/dt");
  EXPECT_NEAR(torque.value, 5.0, 4.0 * torque.sigma);
  EXPECT_LT(torque.sigma, 1.0);
  EXPECT_LT(voltage.value, 0.5) << "nothing drives the current: its rates are some hundred A/s";
  EXPECT_NEAR(fit.parameters.at("R").value, resistance, 4.0 * fit.parameters.at("R").sigma);
  EXPECT_NEAR(fit.parameters.at("b").value, damping, 4.0 * fit.parameters.at("b").sigma);
  EXPECT_LT(fit.parameters.at("R").sigma, 0.002);
}

/// Two normal densities of its logarithm, the likelihood's (nearly) and a prior as sharp, a sigma apart: their product lies in the middle
/// and is sharper by sqrt 2.
TEST(RandomForce, PriorOfItsStrengthIsLogNormal) {
  const Estimate alone = fitted_without_prior().force.at("dw/dt");
  const double log_sigma = alone.sigma / alone.value, median = std::exp(log_sigma) * alone.value;
  const Fit fit = fitted(KnownForce{median, log_sigma * median, "rad/s^2"});
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  const Estimate both = fit.force.at("dw/dt");
  EXPECT_NEAR(std::log(both.value / alone.value), 0.5 * log_sigma, 0.1 * log_sigma);
  EXPECT_NEAR(both.sigma / both.value, log_sigma / std::sqrt(2.0), 0.15 * log_sigma);
  EXPECT_LT(fit.force.at("di/dt").value, 0.5) << "the prior is of the other unit";
}

TEST(RandomForce, SharpPriorHoldsItsStrength) {
  const Fit fit = fitted(KnownForce{2.0, 2e-3, "rad/s^2"});
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_NEAR(fit.force.at("dw/dt").value, 2.0, 0.01);
}

}  // namespace
}  // namespace misfit
