// A galvanometer on a torsion bar with dry friction, whose rate nobody measures: what hides the friction in the model without it is a large
// random force, beside which the filter resolves no edge of its width.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string mirror_text = R"toml(
[states]
angle = { unit = "rad", scale = 0.05 }
rate = { unit = "rad/s", scale = 20.0 }
[inputs]
i = { unit = "A", hold = "zero_order" }
[parameters]
J = { unit = "kg m^2", value = 2e-7 }
Kt = { unit = "N m/A", value = 0.008, free = true }
k = { unit = "N m/rad", value = 0.04, free = true }
b = { unit = "N m s/rad", value = 3e-5, free = true }
[equations]
angle = "rate"
rate = "(Kt*i - k*angle - b*rate)/J"
[outputs]
angle = { unit = "rad", noise = 3e-4 }
)toml";

constexpr double friction = 1500.0, width = 0.05;  // [rad/s^2], [rad/s]

/// By leapfrog steps of 1 us, which share nothing with sim/; sampled every 0.2 ms.
Signals mirror(unsigned seed) {
  constexpr double step = 2e-4, fine = 1e-6;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(-0.4, 0.4);
  Signals s;
  s.name = "mirror";
  s.measured = {{"angle", "rad", {}, 0.0}};
  s.inputs = {{"i", "A", {}, 0.0}};
  double angle = 0.0, rate = 0.0, i = 0.0;
  for (int n = 0, next = 0; n < 2000; ++n) {
    if (n == next) i = level(random), next += 20 + static_cast<int>(random() % 60);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(i);
    s.measured[0].values.push_back(angle + 3e-4 * normal(random));
    for (int f = 0; f < 200; ++f) {
      angle += 0.5 * fine * rate;
      rate += fine * ((0.01 * i - 0.05 * angle - 2e-5 * rate) / 2e-7 - friction * std::tanh(rate / width));
      angle += 0.5 * fine * rate;
    }
  }
  return s;
}

TEST(AFrictionThatIsSharperThanTheFilterResolvesWithoutIt, IsFoundAsSharpAsItIs) {
  DiscoverOptions options;
  options.max_refits = 1;
  const Discovery found = Found(mirror(8), mirror_text).discover_missing(options);
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "coulomb_friction") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate size = first.parameters.at("friction"), over = first.parameters.at("width");
  EXPECT_NEAR(size.value, friction, 4.0 * size.sigma);
  EXPECT_LT(size.sigma, 10.0) << "15 to 20 at a width of 0.8 rad/s, where it ended";
  EXPECT_NEAR(over.value, width, 4.0 * over.sigma);
  EXPECT_LT(over.sigma, 0.03);
}

}  // namespace
}  // namespace misfit
