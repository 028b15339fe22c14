// A scale whose reading ends above and below, below, or above: a spring that is pushed and pulled.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string scale_text = R"toml(
[states]
x = { unit = "m", scale = 0.01 }
v = { unit = "m/s", scale = 0.1, rate_of = "x" }
[inputs]
F = { unit = "N", hold = "zero_order" }
[parameters]
k = { unit = "N/m", value = 3500.0, free = true }
c = { unit = "N s/m", value = 50.0, free = true }
m = { unit = "kg", value = 2.0 }
[equations]
x = "v"
v = "(F - k*x - c*v)/m"
[outputs]
reading = { unit = "N", formula = "k*x", noise = 0.3 }
)toml";

/// By leapfrog steps of 0.1 ms, which share nothing with sim/; sampled every 4 ms.
Signals scale(double floor, double ceiling, unsigned seed) {
  constexpr double step = 0.004, fine = 1e-4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "scale";
  s.measured = {{"reading", "N", {}, 0.0}};
  s.inputs = {{"F", "N", {}, 0.0}};
  double x = 0.0, v = 0.0, force = 0.0;
  for (int n = 0; n < 900; ++n) {
    if (n % 60 == 0) force = 25.0 * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(force);
    s.measured[0].values.push_back(std::clamp(4000.0 * x, floor, ceiling) + 0.3 * normal(random));
    for (int i = 0; i < 40; ++i) {
      x += 0.5 * fine * v;
      v += fine * (force - 4000.0 * x - 60.0 * v) / 2.0;
      x += 0.5 * fine * v;
    }
  }
  return s;
}

void expect_first(const Signals& recording, const char* effect, const char* edge, double truth) {
  const Discovery found = Found(recording, scale_text).discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, effect) << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  if (first.effect != effect) return;
  const Estimate at = first.parameters.at(edge);
  EXPECT_NEAR(at.value, truth, 5.0 * at.sigma);
  EXPECT_LT(at.sigma, 0.2);
}

TEST(ASensorThatEnds, ToBothSidesIsFoundWithItsRange) { expect_first(scale(-20.0, 40.0, 11), "sensor_range", "ceiling", 40.0); }
TEST(ASensorThatEnds, BelowIsFoundWithItsFloor) { expect_first(scale(-5.0, 1e9, 12), "sensor_floor", "floor", -5.0); }
TEST(ASensorThatEnds, AboveIsFoundWithItsCeiling) { expect_first(scale(-1e9, 30.0, 13), "sensor_saturation", "ceiling", 30.0); }

TEST(ASensorThatEnds, IsNotFoundWhereItDoesNot) {
  const Discovery found = Found(scale(-1e9, 1e9, 14), scale_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << found.verdict;
}

}  // namespace
}  // namespace misfit
