// A stirred reactor whose rate constant grows with its temperature (Arrhenius), where the model has a constant in the balances of mass and
// heat: two forces of unknown form, or one parameter that varies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "misfit/discover/verdict.h"
#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string reactor_text = R"toml(
[states]
c = { unit = "-", scale = 0.5 }
T = { unit = "K", scale = 10.0 }
[inputs]
cool = { unit = "K", hold = "zero_order" }
[parameters]
k = { unit = "1/s", value = 7e-4, bounds = [0.0, 1.0], free = true }
flow = { unit = "1/s", value = 0.016666667 }
feed = { unit = "K", value = 350.0 }
heat = { unit = "K", value = 200.0, free = true }
loss = { unit = "1/s", value = 0.035, free = true }
[equations]
c = "flow*(1 - c) - k*c"
T = "flow*(feed - T) + heat*k*c + loss*(cool - T)"
[outputs]
c = { unit = "-", noise = 0.004 }
T = { unit = "K", noise = 0.15 }
)toml";

constexpr double per_kelvin = 8750.0;  // E/R [K] (Bequette, Process Dynamics (1998), module 9)
double rate_constant(double T) { return 1.2e9 * std::exp(-per_kelvin / T); }

/// By Euler steps of 10 ms, which share nothing with sim/; sampled every 4 s. `varies`: or as it is at 306 K.
Signals reactor(bool varies, unsigned seed) {
  constexpr double step = 4.0, fine = 0.01;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(278.0, 290.0);
  Signals s;
  s.name = "reactor";
  s.measured = {{"c", "-", {}, 0.0}, {"T", "K", {}, 0.0}};
  s.inputs = {{"cool", "K", {}, 0.0}};
  double c = 0.9, T = 306.0, cool = 284.0;
  for (int n = 0, next = 0; n < 900; ++n) {
    if (n == next) cool = level(random), next += 15 + static_cast<int>(random() % 40);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(cool);
    s.measured[0].values.push_back(c + 0.004 * normal(random));
    s.measured[1].values.push_back(T + 0.15 * normal(random));
    for (int i = 0; i < 400; ++i) {
      const double k = rate_constant(varies ? T : 306.0), dc = (1.0 - c) / 60.0 - k * c;
      T += fine * ((350.0 - T) / 60.0 + 209.2 * k * c + 0.03483 * (cool - T));
      c += fine * dc;
    }
  }
  return s;
}

TEST(ARateConstantThatVaries, IsNamedWithWhatItVariesWith) {
  const Discovery found = Found(reactor(true, 3), reactor_text).discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "varying_parameter") << found.verdict;
  EXPECT_EQ(first.roles, (std::map<std::string, std::string>{{"parameter", "k"}, {"with", "T"}}));
  EXPECT_TRUE(first.accepted) << first.why;
  const double middle = first.parameters.at("middle").value;
  const double truth = rate_constant(middle) * per_kelvin / (middle * middle);
  const Estimate slope = first.parameters.at("slope");
  EXPECT_NEAR(slope.value, truth, 0.1 * truth) << "the middle of the range of its states, where the exponential has this slope";
  EXPECT_LT(slope.sigma, 0.1 * truth);
}

TEST(ARateConstantThatVaries, IsNotNamedWhereItIsConstant) {
  const Discovery found = Found(reactor(false, 4), reactor_text).discover_missing();
  for (const Candidate& c : found.candidates) EXPECT_FALSE(c.accepted) << c.effect << ": " << c.why;
}

const std::string fuse_text = R"toml(
[states]
T = { unit = "K", scale = 40.0 }
[inputs]
I = { unit = "A", hold = "zero_order" }
[parameters]
R0 = { unit = "ohm", value = 0.06, free = true }
h = { unit = "W/K", value = 0.06, free = true }
C = { unit = "J/K", value = 2.0 }
[equations]
T = "(R0*I^2 - h*T)/C"
[outputs]
T = { unit = "K", noise = 0.2 }
)toml";

/// A fuse link (over its surroundings) whose resistance grows by 0.4 % per K, as copper's does; by Euler steps of 5 ms, sampled every 0.5
/// s.
Signals fuse(unsigned seed) {
  constexpr double step = 0.5, fine = 0.005;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(1.0, 9.0);
  Signals s;
  s.name = "fuse";
  s.measured = {{"T", "K", {}, 0.0}};
  s.inputs = {{"I", "A", {}, 0.0}};
  double T = 10.0, I = 5.0;
  for (int n = 0, next = 0; n < 1200; ++n) {
    if (n == next) I = level(random), next += 20 + static_cast<int>(random() % 80);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(I);
    s.measured[0].values.push_back(T + 0.2 * normal(random));
    for (int i = 0; i < 100; ++i) T += fine * (0.05 * (1.0 + 0.004 * T) * I * I - 0.08 * T) / 2.0;
  }
  return s;
}

/// It multiplies the square of the current in one equation: with the temperature it is no product of temperature and current.
TEST(AResistanceThatVaries, IsNoProductOfTemperatureAndCurrent) {
  const Discovery found = Found(fuse(6), fuse_text).discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(effect_at(first.effect, first.roles), "varying_parameter (parameter = R0, with = T)") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate slope = first.parameters.at("slope");
  EXPECT_NEAR(slope.value, 2e-4, 4.0 * slope.sigma);
  EXPECT_LT(slope.sigma, 4e-6);
}

/// Where it has the model's value is a matter of counting: a state of which the beginning is estimated may have moved away from there.
TEST(AResistanceThatVaries, MayHaveItsOwnValueWhereNothingWas) {
  const std::vector<Signals> recording = {fuse(6)};
  ModelRequest request = request_of("text", {effect("varying_parameter", {{"parameter", "R0"}, {"with", "T"}})});
  request.parameters["middle"].value = -100.0;
  EXPECT_FALSE(edge_not_visited(estimate_filter(assemble(request, *registry_with(fuse_text)), {}, recording)));
}

}  // namespace
}  // namespace misfit
