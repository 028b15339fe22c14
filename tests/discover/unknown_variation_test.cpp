// A wall that boils a fluid: the heat transfer coefficient has a peak over the temperature of the wall (nucleate boiling, then film
// boiling: Nukiyama 1934), where the model has a constant in the balances of both. No line and no exponential describes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "misfit/discover/unknown_curves.h"
#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::Contains;
using testing::ElementsAre;

const std::string wall_text = R"toml(
[states]
wall = { unit = "K", scale = 30.0 }
fluid = { unit = "K", scale = 10.0 }
[inputs]
power = { unit = "W", hold = "zero_order" }
[parameters]
G = { unit = "W/K", value = 15.0, bounds = [0.0, 1e3], free = true }
loss = { unit = "W/K", value = 20.0, bounds = [0.0, 1e3], free = true }
Cw = { unit = "J/K", value = 200.0 }
Cf = { unit = "J/K", value = 400.0 }
[equations]
wall = "(power - G*(wall - fluid))/Cw"
fluid = "(G*(wall - fluid) - loss*fluid)/Cf"
[outputs]
wall = { unit = "K", noise = 0.3 }
fluid = { unit = "K", noise = 0.2 }
)toml";

/// [W/K] of the temperature of the wall and the time.
using Transfer = double (*)(double, double);
double constant(double /*wall*/, double /*t*/) { return 12.0; }
double with_a_peak(double wall, double /*t*/) { return 12.0 + 13.0 * std::exp(-std::pow((wall - 80.0) / 15.0, 2)); }
/// A stirrer that runs faster and slower, once in 90 s.
double stirred(double /*wall*/, double t) { return 12.0 + 3.0 * std::sin(2.0 * std::numbers::pi * t / 90.0); }

/// By Euler steps of 20 ms, which share nothing with sim/; sampled every 2 s.
Signals heated(Transfer transfer, unsigned seed) {
  constexpr double step = 2.0, fine = 0.02;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(400.0, 1100.0);
  Signals s;
  s.name = "heated";
  s.measured = {{"wall", "K", {}, 0.0}, {"fluid", "K", {}, 0.0}};
  s.inputs = {{"power", "W", {}, 0.0}};
  double wall = 60.0, fluid = 25.0, power = 700.0;
  for (int n = 0, next = 0; n < 500; ++n) {
    if (n == next) power = level(random), next += 8 + static_cast<int>(random() % 25);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(power);
    s.measured[0].values.push_back(wall + 0.3 * normal(random));
    s.measured[1].values.push_back(fluid + 0.2 * normal(random));
    for (int i = 0; i < 100; ++i) {
      const double over = transfer(wall, step * n + fine * i) * (wall - fluid);
      wall += fine * (power - over) / 200.0;
      fluid += fine * (over - 20.0 * fluid) / 400.0;
    }
  }
  return s;
}

TEST(AParameterWithAPeak, IsAChangeOfUnknownFormOfThatParameterWithWhatItDependsOn) {
  const Discovery d = Found(heated(with_a_peak, 5), wall_text).discover_missing();
  ASSERT_EQ(d.outcome, SearchOutcome::unknown_form) << d.verdict;
  EXPECT_TRUE(d.unexplained_parameter) << d.verdict;
  EXPECT_FALSE(d.unexplained_error);
  EXPECT_EQ(d.unexplained_port, "G");
  EXPECT_EQ(d.unexplained_quantity, "wall");
  EXPECT_EQ(unexplained_place(d), "a change of G");
  ASSERT_FALSE(d.unexplained_effects.empty());
  EXPECT_EQ(effect_at(d.unexplained_effects.front().effect, d.unexplained_effects.front().roles),
            "unknown_variation (parameter = G, with = wall)");
  EXPECT_EQ(candidate_to_begin_with(d), nullptr) << "a line is a part of the curve";
}

/// The parameter's own value is a curve, too: both could not be estimated.
TEST(AParameterWithAPeak, IsFixedWhereItsCurveIsAdded) {
  DiscoverOptions options;
  options.only = "unknown_variation";
  const Discovery d = Found(heated(with_a_peak, 5), wall_text).discover_missing(options);
  ASSERT_FALSE(d.candidates.empty());
  const Candidate& first = d.candidates.front();
  EXPECT_EQ(first.roles, (std::map<std::string, std::string>{{"parameter", "G"}, {"with", "wall"}}));
  EXPECT_THAT(first.fixed_in_model, ElementsAre(testing::Key("G")));
}

TEST(AParameterWithAPeak, IsNotFoundWhereItIsConstant) {
  const Discovery d = Found(heated(constant, 6), wall_text).discover_missing();
  EXPECT_EQ(d.outcome, SearchOutcome::none_missing) << d.verdict;
  EXPECT_TRUE(std::any_of(d.candidates.begin(), d.candidates.end(), [](const Candidate& c) { return c.effect == "unknown:G(wall)"; }))
      << "it was tested";
}

/// What goes over depends on G itself: a G that depended on that could not be added to the model.
TEST(AParameterWithAPeak, IsNotToBeAddedOverWhatDependsOnParameters) {
  std::string text = wall_text;
  text.replace(text.find("[equations]"), 0, "[quantities]\nover = { unit = \"W\", formula = \"G*(wall - fluid)\" }\n");
  const Discovery d = Found(heated(with_a_peak, 5), text).discover_missing();
  EXPECT_EQ(d.outcome, SearchOutcome::unknown_form) << d.verdict;
  for (const auto& [effect, roles] : d.unexplained_effects)
    EXPECT_FALSE(effect == "unknown_variation" && roles.at("with") == "over") << d.verdict;
}

TEST(AParameterThatGoesUpAndDown, IsNamedWithItsFrequencyAndSize) {
  const Discovery d = Found(heated(stirred, 7), wall_text).discover_missing();
  ASSERT_FALSE(d.candidates.empty());
  const Candidate& first = d.candidates.front();
  EXPECT_EQ(effect_at(first.effect, first.roles), "periodic_forcing (port = G)") << d.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate frequency = first.parameters.at("frequency"), sine = first.parameters.at("sine");
  EXPECT_NEAR(frequency.value, 1.0 / 90.0, 4.0 * frequency.sigma);
  EXPECT_LT(frequency.sigma, 1e-4);
  EXPECT_NEAR(sine.value, 3.0, 4.0 * sine.sigma);
  EXPECT_LT(sine.sigma, 0.5);
}

TEST(ParametersOfUnknownCurves, AreThoseThatAreFreeInTheModel) {
  const auto systems = registry_with(wall_text);
  ModelRequest request = request_of("text");
  const auto names = [&] {
    const Model model = assemble(request, *systems);
    std::vector<std::string> out;
    for (const int p : parameters_of_unknown_curves(model)) out.push_back(model.system->spec().quantity_ports[p].name);
    return out;
  };
  EXPECT_THAT(names(), Contains("G"));
  request.parameters["G"].free = false;
  EXPECT_THAT(names(), testing::Not(Contains("G")));
}

}  // namespace
}  // namespace misfit
