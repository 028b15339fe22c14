// The strength at which an effect of an input is whole: the gain by which the model lets the input act.
#include "misfit/discover/whole_strength.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

}  // namespace
}  // namespace misfit
