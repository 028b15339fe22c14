// A random force that is slower than the motion can stand for what the model lacks: it is said.
#include "misfit/fit/filter/slow_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double stiffness = 100.0, damping = 1.0;  // period 0.63 s

const std::string oscillator_text = R"toml(
[states]
x = { unit = "m" }
v = { unit = "m/s", rate_of = "x" }
[parameters]
k = { unit = "1/s^2", value = 90.0, bounds = [0.0, 1e4], free = true }
c = { unit = "1/s", value = 1.2, bounds = [0.0, 100.0], free = true }
[equations]
x = "v"
v = "-k*x - c*v"
[outputs]
x = { unit = "m", noise = 1e-3 }
)toml";

/// 50 s at 50 Hz of an oscillator that a random force moves, correlated over `memory` [s]; Euler steps of 0.5 ms.
Signals record(double memory) {
  constexpr double h = 5e-4, force_sigma = 1.0;
  constexpr int samples = 2500, steps = 40;
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "oscillator";
  s.measured = {{"x", "m", {}, 0.0}};
  double x = 0.02, v = 0.0, force = 0.0;
  for (int n = 0; n < samples; ++n) {
    s.t.push_back(h * steps * n);
    s.measured[0].values.push_back(x + 2e-4 * normal(random));
    for (int k = 0; k < steps; ++k) {
      const double dv = -stiffness * x - damping * v + force;
      x += h * v;
      v += h * dv;
      force += -h * force / memory + force_sigma * std::sqrt(2.0 * h / memory) * normal(random);
    }
  }
  return s;
}

FilterErrorFit fitted(double memory) {
  const auto registry = registry_with(oscillator_text);
  const Model model = assemble(request_of("text"), *registry);
  static std::vector<Signals> experiments;  // an estimate points to its recording
  experiments = {record(memory)};
  FilterOptions options;
  options.threads = 1;
  return filter_error(trajectory_start(model, experiments).from, experiments, options);
}

TEST(SlowForce, IsSaidWithTimePeriodAndStrength) {
  const FilterErrorFit found = fitted(4.0);
  ASSERT_TRUE(found.estimate) << found.fit.message;
  EXPECT_GT(found.estimate->noise.force_time, 1.5) << "4 s put in";
  const double period = shortest_period(*found.estimate);
  EXPECT_GT(period, 0.5) << "natural period 0.63 s";
  EXPECT_LT(period, 2.5) << "slow forcing moves the equilibrium, which makes the motion slower";
  EXPECT_THAT(found.fit.warnings,
              testing::Contains(testing::AllOf(testing::HasSubstr("the random force is slow"), testing::HasSubstr(" m/s^2 on "),
                                               testing::HasSubstr("[force] correlation_time"))));
}

/// The noise as the search leaves it no longer knows what the study holds.
TEST(SlowForce, NothingIsSaidOfOneWhoseTimeTheStudyHolds) {
  FilterErrorFit found = fitted(4.0);
  ASSERT_TRUE(found.estimate) << found.fit.message;
  ASSERT_NE(warning_of_slow_force(*found.estimate), "");
  found.estimate->reference.time_is_given = true;
  EXPECT_EQ(warning_of_slow_force(*found.estimate), "");
}

TEST(SlowForce, NothingIsSaidOfAFastOne) {
  const FilterErrorFit found = fitted(0.05);
  ASSERT_TRUE(found.estimate) << found.fit.message;
  EXPECT_TRUE(found.fit.driven);
  EXPECT_NEAR(shortest_period(*found.estimate), 2.0 * M_PI / std::sqrt(stiffness), 0.1);
  EXPECT_THAT(found.fit.warnings, testing::Not(testing::Contains(testing::HasSubstr("the random force is slow"))));
}

}  // namespace
}  // namespace misfit
