// What acts at one place of the way only: a slide that a magnet beside it catches, over a hundredth of its way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string slide_text = R"toml(
[states]
x = { unit = "m", scale = 0.05 }
v = { unit = "m/s", scale = 0.2, rate_of = "x" }
[inputs]
F = { unit = "N", hold = "zero_order" }
[parameters]
k = { unit = "N/m", value = 30.0, free = true }
c = { unit = "N s/m", value = 5.0, free = true }
m = { unit = "kg", value = 2.0 }
[equations]
x = "v"
v = "(F - k*x - c*v)/m"
[outputs]
x = { unit = "m", noise = 2e-4 }
)toml";

constexpr double magnet_at = 0.06, magnet_width = 0.012;  // [m]

/// [m/s^2] Towards the magnet, `size` at most.
double pull(double x, double size) {
  const double at = (x - magnet_at) / magnet_width;
  return -size * at * std::exp(0.5 - 0.5 * at * at);
}

/// By leapfrog steps of 0.1 ms (of what the damper does the mean over a step), which share nothing with sim/; sampled every 20 ms.
Signals slide(double size, unsigned seed) {
  constexpr double step = 0.02, fine = 1e-4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "slide";
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"F", "N", {}, 0.0}};
  double x = 0.0, v = 0.0, force = 0.0;
  for (int n = 0; n < 3000; ++n) {
    if (n % 40 == 0) force = 8.0 * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(force);
    s.measured[0].values.push_back(x + 2e-4 * normal(random));
    for (int i = 0; i < 200; ++i) {
      x += 0.5 * fine * v;
      v = (v * (1.0 - 0.5 * fine * 4.0) + fine * (0.5 * force - 20.0 * x + pull(x, size))) / (1.0 + 0.5 * fine * 4.0);
      x += 0.5 * fine * v;
    }
  }
  return s;
}

TEST(AForceAtOnePlaceOfTheWay, IsFoundAsACurveOfIt) {
  const Discovery found = Found(slide(2.0, 5), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "x");
  EXPECT_EQ(found.unexplained_port, "dv/dt");
}

TEST(AForceAtOnePlaceOfTheWay, HasKnotsAsCloseAsItIsNarrowAndOthersAllAlongTheWay) {
  const Discovery found = Found(slide(2.0, 5), slide_text).discover_missing({.only = "unknown_force"});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.roles, (std::map<std::string, std::string>{{"of", "x"}, {"port", "dv/dt"}}));
  ASSERT_GT(first.knots.size(), 8U);
  EXPECT_TRUE(std::is_sorted(first.knots.begin(), first.knots.end()));
  const auto near =
      std::count_if(first.knots.begin(), first.knots.end(), [](double knot) { return std::abs(knot - magnet_at) < 2.0 * magnet_width; });
  EXPECT_GE(near, 3) << "a pull to and fro";
  EXPECT_LT(first.knots.front(), -0.1);
  EXPECT_GT(first.knots.back(), 0.1);
}

TEST(AForceAtOnePlaceOfTheWay, IsNotFoundWhereThereIsNone) {
  const Discovery found = Found(slide(0.0, 6), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << found.verdict;
}

}  // namespace
}  // namespace misfit
