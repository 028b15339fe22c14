// A damper whose coefficient depends on its stroke (J. C. Dixon, The Shock Absorber Handbook (2007): position-sensitive dampers), where the
// model has a constant: a factor of the rate that is a curve of the displacement, so that the force is a curve of neither.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "misfit/core/lists.h"
#include "misfit/discover/unknown_curves.h"
#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string damper_text = R"toml(
[states]
x = { unit = "m", scale = 0.05 }
v = { unit = "m/s", scale = 0.5 }
[inputs]
F = { unit = "N", hold = "zero_order" }
[parameters]
k = { unit = "N/m", value = 1500.0, bounds = [0.0, 1e5], free = true }
c = { unit = "N s/m", value = 40.0, bounds = [0.0, 1e4], free = true }
weight = { unit = "N", value = 0.0, bounds = [-1e3, 1e3], free = true }
m = { unit = "kg", value = 10.0 }
[equations]
x = "v"
v = "(F - k*x - c*v - weight)/m"
[outputs]
x = { unit = "m", noise = 2e-4 }
)toml";

constexpr double stroke = 0.04;  // [m]

/// [N s/m] of the displacement [m].
using Damper = double (*)(double);
double even(double /*x*/) { return 60.0; }
/// Soft in the middle of the stroke, hard to both ends, a hump that no line describes.
double hard_at_the_ends(double x) { return 30.0 + 90.0 * (1.0 - std::exp(-x * x / (2.0 * 0.5 * stroke * 0.5 * stroke))); }

/// By leapfrog steps of 0.1 ms, which share nothing with sim/; sampled every 10 ms.
Signals shaken(Damper damper, unsigned seed) {
  constexpr double step = 0.01, fine = 1e-4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "shaken";
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"F", "N", {}, 0.0}};
  double x = 0.0, v = 0.0, force = 0.0;
  for (int n = 0; n < 2500; ++n) {
    if (n % 12 == 0) force = 60.0 * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(force);
    s.measured[0].values.push_back(x + 2e-4 * normal(random));
    for (int i = 0; i < 100; ++i) {
      x += 0.5 * fine * v;
      v += fine * (force - 2000.0 * x - damper(x) * v) / 10.0;
      x += 0.5 * fine * v;
    }
  }
  return s;
}

TEST(AFactorThatDependsOnAnotherState, IsAChangeOfUnknownFormOfThatFactor) {
  const Discovery d = Found(shaken(hard_at_the_ends, 3), damper_text).discover_missing();
  ASSERT_EQ(d.outcome, SearchOutcome::unknown_form) << d.verdict;
  EXPECT_TRUE(d.unexplained_parameter) << d.verdict;
  EXPECT_EQ(d.unexplained_port, "c");
  EXPECT_EQ(d.unexplained_quantity, "x");
  EXPECT_THAT(d.unexplained_alike, testing::IsEmpty());
  ASSERT_FALSE(d.unexplained_effects.empty());
  EXPECT_EQ(effect_at(d.unexplained_effects.front().effect, d.unexplained_effects.front().roles),
            "unknown_variation (parameter = c, with = x)");
}

TEST(AFactorThatDependsOnAnotherState, IsNotFoundWhereItIsConstant) {
  const Discovery d = Found(shaken(even, 4), damper_text).discover_missing();
  EXPECT_EQ(d.outcome, SearchOutcome::none_missing) << d.verdict;
  const auto tested = [&](const char* curve) {
    return std::any_of(d.candidates.begin(), d.candidates.end(), [&](const Candidate& c) { return c.effect == curve; });
  };
  EXPECT_TRUE(tested("unknown:c(x)") && tested("unknown:k(v)") && tested("unknown:c(time)"));
  EXPECT_FALSE(tested("unknown:c(v)")) << "it is a force that depends on v";
  EXPECT_FALSE(tested("unknown:weight(x)") || tested("unknown:weight(F)")) << "they are forces that depend on x, on F";
}

/// The stroke of a damper with a lever of two to one is the same quantity: no data tell whether c depends on the one or the other. That it
/// depends on a quantity, which effects may change as they may change c, cannot be added to the model: the other is the answer.
TEST(AFactorThatDependsOnAnotherState, MayAsWellDependOnWhatIsTheSame) {
  std::string text = damper_text;
  text.insert(text.find("[equations]"), "[quantities]\nstroke = { unit = \"m\", formula = \"2*x\" }\n");
  const Discovery d = Found(shaken(hard_at_the_ends, 3), text).discover_missing();
  ASSERT_TRUE(d.unexplained_parameter) << d.verdict;
  EXPECT_EQ(d.unexplained_quantity, "x");
  EXPECT_THAT(d.unexplained_alike, testing::ElementsAre("a change of c that depends on stroke"));
  ASSERT_FALSE(d.unexplained_effects.empty());
  EXPECT_EQ(d.unexplained_effects.front().roles.at("with"), "x");
  EXPECT_THAT(d.sentences, testing::Contains(testing::StartsWith("these data cannot distinguish it from a change of c")));
}

TEST(AForce, MayNotActOnTheRateOfAPosition) {
  const auto systems = registry_with(damper_text);
  const auto system = systems->system("text").make({});
  const SystemSpec& spec = system->spec();
  EXPECT_FALSE(may_be_forced(spec, index_of(spec.dynamic_ports, "dx/dt")));
  EXPECT_TRUE(may_be_forced(spec, index_of(spec.dynamic_ports, "dv/dt")));
}

}  // namespace
}  // namespace misfit
