// The strength at which an effect of an input is whole: the gain by which the model lets the input act.
#include "misfit/discover/whole_strength.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/discover/found.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

/// A microampere is a large input here: the gain falls by a tenth of itself at 0.6 of one.
const std::string coil_text = R"toml(
[states]
v = { unit = "m/s", scale = 1.0 }
[inputs]
i = { unit = "A" }
[parameters]
c = { unit = "1/s", value = 1.0, bounds = [0.0, 100.0], free = true }
gain = { unit = "m/s^2/A", value = 1e6 }
bend = { unit = "m/s^2/A^3", value = 1e17 }
[ports]
push = { unit = "m/s^2" }
[equations]
v = "gain*i - bend*i^3 - c*v + push"
[outputs]
v = { unit = "m/s", noise = 1e-3 }
)toml";

/// What a current that is recorded, and in no equation, does is no lag of it.
TEST(IdleInput, IsOneThatMovesNothingInTheRestOfTheModel) {
  std::string idle = coil_text;
  idle.replace(idle.find("1e6"), 3, "0");
  idle.replace(idle.find("1e17"), 4, "0");
  Signals s;
  s.measured = {{"v", "m/s", {}, 0.0}};
  s.inputs = {{"i", "A", {}, 0.0}};
  for (int k = 0; k < 100; ++k) {
    s.t.push_back(0.05 * k);
    s.inputs[0].values.push_back(1e-6 * std::sin(s.t.back()));
    s.measured[0].values.push_back(0.01 * std::cos(s.t.back()));
  }
  const auto found = [&](const std::string& text, const std::string& key) {
    const auto systems = registry_with(text);
    ModelRequest request = request_of("text", {effect(key, {{"input", "i"}, {"port", "push"}})});
    for (auto& [name, parameter] : request.parameters) parameter.free = name == "c";
    const std::vector<Signals> signals{s};
    return idle_input(estimate_filter(assemble(request, *systems), {}, signals));
  };
  EXPECT_EQ(found(idle, "input_lag"), "i");
  EXPECT_EQ(found(coil_text, "input_lag"), std::nullopt);
  EXPECT_EQ(found(idle, "input_gain"), std::nullopt) << "no share of anything";
}

TEST(WholeStrength, OfASmallInputIsTheGainWithinItsRange) {
  const auto systems = registry_with(coil_text);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::vector<Signals> signals(1);
  Signals& s = signals.front();
  s.measured = {{"v", "m/s", {}, 0.0}};
  s.inputs = {{"i", "A", {}, 0.0}};
  for (int k = 0; k < 300; ++k) {
    s.t.push_back(0.05 * k);
    s.inputs[0].values.push_back(1e-6 * std::sin(s.t.back()));
    s.measured[0].values.push_back(0.65 * std::sin(s.t.back() - 0.785) + noise(random));
  }
  ModelRequest request = request_of("text", {effect("input_lag", {{"input", "i"}, {"port", "push"}})});
  request.parameters["lagged_gain"].free = request.parameters["input_tau"].free = false;
  const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
  const std::vector<WholeStrength> whole = whole_strengths(estimate);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_GT(whole[0].value, 0.6e6);
  EXPECT_LT(whole[0].value, 1.0e6);
}

const std::string cell_text = R"toml(
[states]
soc = { unit = "-", initial = { kind = "free", value = 0.5 } }
[inputs]
I = { unit = "A", hold = "zero_order" }
[parameters]
Q = { unit = "A s", value = 3000.0 }
E0 = { unit = "V", value = 3.4 }
E1 = { unit = "V", value = 0.7, free = true }
R0 = { unit = "V/A", value = 0.02, free = true }
[equations]
soc = "-I/Q"
[outputs]
V = { unit = "V", formula = "E0 + E1*soc - R0*I", noise = 0.002 }
)toml";

/// Currents up to 5 A either way; V lacks 30 mV with the sign of the current. The charge is exact, by sums.
Signals cell_of_sticky_voltage() {
  constexpr double step = 2.0;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> amperes(-5.0, 5.0);
  Signals s;
  s.name = "cell";
  s.measured = {{"V", "V", {}, 0.0}};
  s.inputs = {{"I", "A", {}, 0.0}};
  double soc = 0.5, current = 0.0;
  for (int n = 0; n < 400; ++n) {
    if (n % 8 == 0) current = amperes(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(current);
    s.measured[0].values.push_back(3.4 + 0.8 * soc - 0.015 * current - 0.03 * std::tanh(current / 0.2) + 0.002 * normal(random));
    soc -= step * current / 3000.0;
  }
  return s;
}

/// Most of what the input does and little of its charge would have to be limited to a tenth of an ampere.
TEST(WholeStrength, OfASaturationThatExplainsLittleAsAWholeMakesItAPart) {
  const Discovery found = Found(cell_of_sticky_voltage(), cell_text).discover_missing();
  const auto saturation =
      std::find_if(found.candidates.begin(), found.candidates.end(), [](const Candidate& c) { return c.effect == "saturation"; });
  ASSERT_NE(saturation, found.candidates.end());
  EXPECT_FALSE(saturation->accepted);
  ASSERT_TRUE(saturation->actual_drop);
  EXPECT_GT(*saturation->actual_drop, 100.0);
  EXPECT_THAT(saturation->why, testing::HasSubstr("only a part of it is found"));
}

}  // namespace
}  // namespace misfit
