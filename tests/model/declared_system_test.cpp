#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/core/display.h"
#include "misfit/core/units.h"
#include "misfit/model/declared_parameter.h"
#include "misfit/model/evaluator.h"
#include "tests/core/temporary_folder.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("no '" + what + "' in the text");
  return text.replace(at, what.size(), by);
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(declared_system(text, "text.toml", "text"));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(DeclaredDuffing, HasTheRatesAndDerivativesOfTheClosedForm) {
  const auto known = registry_with(duffing_text);
  const Model model = assemble(request_of("text"), *known);
  Evaluator evaluator(model);
  const double x[] = {0.3, -1.2}, u[] = {0.7};
  double dx[2], D[2 * kRowStride];
  evaluator.rates(x, u, 0.0, dx);
  EXPECT_DOUBLE_EQ(dx[0], -1.2);
  EXPECT_NEAR(dx[1], 10.0 * 0.7 + 0.4 * 1.2 - 30.0 * 0.3 - 50.0 * 0.027, 1e-14);
  Slots slots;
  evaluator.linearise_rates({x, u, 0.0}, slots, dx, D);
  EXPECT_EQ(D[0], 0.0);
  EXPECT_EQ(D[1], 1.0);
  EXPECT_NEAR(D[kRowStride], -30.0 - 150.0 * 0.09, 1e-13);
  EXPECT_NEAR(D[kRowStride + 1], -0.4, 1e-15);
  const double by_parameter[] = {-0.3, 1.2, -0.027};  // stiffness, damping, cubic
  ASSERT_EQ(slots.count(), 3);
  for (int s = 0; s < 3; ++s) EXPECT_NEAR(D[kRowStride + 2 + s], by_parameter[slots.column(s)], 1e-15) << slots.column(s);
}

/// A strut between a body and a wheel: its rate is the derivative of its stroke, which only the equations say.
TEST(DeclaredQuantities, ThatAreRatesOfOthersAreFound) {
  const auto known = registry_with(R"toml([states]
zs = { unit = "m" }
vs = { unit = "m/s" }
zu = { unit = "m" }
vu = { unit = "m/s" }
[parameters]
k = { unit = "1/s^2", value = 3.0 }
[quantities]
stroke = { unit = "m", formula = "zs - zu" }
stroke_rate = { unit = "m/s", formula = "vs - vu" }
sum_rate = { unit = "m/s", formula = "vs + vu" }
[ports]
strut = { unit = "m/s^2", rate = "stroke_rate" }
[equations]
zs = "vs"
vs = "-k*stroke + strut"
zu = "vu"
vu = "k*stroke - strut"
[outputs]
d = { unit = "m", formula = "zs - zu" }
)toml");
  const SystemSpec spec = known->system("text").make({})->spec();
  const auto rate_of = [&](const std::string& name) {
    return std::find_if(spec.quantities.begin(), spec.quantities.end(), [&](const auto& q) { return q.name == name; })->rate_of;
  };
  EXPECT_EQ(rate_of("stroke_rate"), "stroke");
  EXPECT_EQ(rate_of("sum_rate"), "");
  EXPECT_EQ(rate_of("stroke"), "");
}

TEST(DeclaredDuffing, SaysWhatMisfitWantsToKnow) {
  const auto known = registry_with(duffing_text);
  const SystemSpec spec = known->system("text").make({})->spec();
  EXPECT_EQ(spec.states[1].rate_of, 0) << "y' = v, so v is the rate of y";
  EXPECT_EQ(spec.outputs[0].observes, 0);
  EXPECT_THAT(spec.force_ports, ElementsAre("dv/dt")) << "y' = v holds by definition";
  EXPECT_EQ(spec.roles.at("rate"), "v");
  EXPECT_EQ(spec.roles.at("level"), "y");
  EXPECT_EQ(spec.roles.at("port"), "push");
  EXPECT_EQ(spec.roles.at("output"), "y");
  EXPECT_THAT(spec.equation_inputs, ElementsAre("u"));
  std::vector<std::string> ports;
  for (const auto& port : spec.dynamic_ports) ports.push_back(port.name + " [" + port.unit + "] " + port.conjugate);
  EXPECT_THAT(ports, ElementsAre("push [V/s^2] v", "dy/dt [V/s] y", "dv/dt [V/s^2] v"));
  EXPECT_TRUE(spec.constants[0].strength && spec.constants[0].free);
  EXPECT_NEAR(spec.fastest_rate, std::sqrt(30.0 + 150.0 * 0.01), 1e-12);
}

TEST(DeclaredHold, OfAStudyIsInPlaceOfThatOfTheFile) {
  const auto hold_of = [](const std::map<std::string, HoldStudy>& holds) {
    return declared_system(duffing_text, "text.toml", "text", holds).make({})->spec().inputs.at(0).hold;
  };
  EXPECT_EQ(hold_of({}), Hold::first_order);
  EXPECT_EQ(hold_of({{"u", {"zero_order", {}}}}), Hold::zero_order);
  EXPECT_EQ(hold_of({{"u", {"band_limited", {}}}}), Hold::band_limited);
  EXPECT_THAT(message_of<InputError>([&] {
                (void)hold_of({{"v", {"zero_order", {"study.toml", 4, 9}}}});
              }),
              AllOf(HasSubstr("study.toml:4"), HasSubstr("no input 'v'"), HasSubstr("u")));
}

/// A cell: its voltage is a formula of the current that charges the capacitor, too.
const std::string cell_text = R"toml(
[states]
v = { unit = "V" }
[inputs]
i = { unit = "A" }
[parameters]
R0 = { unit = "V/A", value = 0.02, free = true }
C = { unit = "A*s/V", value = 40.0 }
E = { unit = "V", value = 4.0 }
[quantities]
drop = { unit = "V", formula = "R0*i" }
[equations]
v = "i/C"
[outputs]
U = { unit = "V", formula = "E - drop - v" }
)toml";

struct OutputOfACell {
  double value = 0.0;
  std::vector<double> by;  ///< v, own states, then R0 and what the effect has
};

OutputOfACell output_of_a_cell(const EffectRequest& effect, const std::map<std::string, double>& values, std::vector<double> x) {
  const auto known = registry_with(cell_text);
  Model model = assemble(request_of("text", {effect}), *known);
  for (const auto& [name, value] : values) set(model, name, value);
  Evaluator evaluator(model);
  const double current[] = {3.0};
  OutputOfACell out;
  std::vector<double> y(evaluator.sensor_ports());
  evaluator.predict(x.data(), current, 0.0, y.data());
  out.value = y[0];
  std::vector<double> rows(y.size() * kRowStride);
  Slots slots;
  evaluator.linearise_outputs({x.data(), current, 0.0}, slots, y.data(), rows.data());
  EXPECT_DOUBLE_EQ(y[0], out.value);
  out.by.assign(rows.begin(), rows.begin() + evaluator.states());
  for (int column = 0; column < evaluator.columns(); ++column) {
    double by = 0.0;
    for (int s = 0; s < slots.count(); ++s) by += slots.column(s) == column ? rows[evaluator.states() + s] : 0.0;
    out.by.push_back(by);
  }
  return out;
}

/// A current that is measured 0.5 A too small charges the cell, and it drops its voltage as well.
TEST(AnEffectOnAnInput, ReachesOutputsThatAreFormulasOfIt) {
  const OutputOfACell out = output_of_a_cell(effect("bias", {{"output", "i"}}), {{"offset", 0.5}}, {0.3});
  EXPECT_DOUBLE_EQ(out.value, 4.0 - 0.02 * 3.5 - 0.3);
  EXPECT_THAT(out.by, testing::Pointwise(testing::DoubleNear(1e-14), {-1.0, -3.5, -0.02}));
}

TEST(AnEffectOnAnInput, ReachesOutputsThroughItsMemory) {
  const OutputOfACell out =
      output_of_a_cell(effect("input_lag", {{"input", "i"}, {"port", "i"}}), {{"lagged_gain", 1.0}, {"input_tau", 0.5}}, {0.3, 2.0});
  EXPECT_DOUBLE_EQ(out.value, 4.0 - 0.02 * 2.0 - 0.3);
  EXPECT_THAT(out.by, testing::Pointwise(testing::DoubleNear(1e-14), {-1.0, -0.02, -2.0, 0.02, 0.0}));
}

/// A quantity means the same in an output as in an equation.
TEST(AnEffectOnAQuantity, ReachesOutputsThatAreFormulasOfIt) {
  const OutputOfACell out = output_of_a_cell(effect("bias", {{"output", "drop"}}), {{"offset", 0.1}}, {0.3});
  EXPECT_DOUBLE_EQ(out.value, 4.0 - 0.02 * 3.0 - 0.1 - 0.3);
  EXPECT_THAT(out.by, testing::Pointwise(testing::DoubleNear(1e-14), {-1.0, -3.0, -1.0}));
}

/// Its outputs have the names of a state and of a quantity, and formulas of their own.
const std::string namesake_text = R"toml(
[states]
w = { unit = "V" }
[parameters]
k = { unit = "1/s", value = 3.0 }
g = { unit = "-", value = 2.0 }
[quantities]
flow = { unit = "V/s", formula = "k*w" }
[equations]
w = "-flow"
[outputs]
w = { unit = "V", formula = "g*w" }
flow = { unit = "V/s", formula = "g*flow" }
half = { unit = "V", formula = "w/2" }
)toml";

struct Answer {
  double dw = 0.0, w = 0.0, flow = 0.0, half = 0.0;
};

/// Of the system with this effect at w = 0.5 V.
Answer answer_with(const std::string& text, const EffectRequest& effect, const std::map<std::string, double>& values) {
  const auto known = registry_with(text);
  Model model = assemble(request_of("text", {effect}), *known);
  for (const auto& [name, value] : values) set(model, name, value);
  Evaluator evaluator(model);
  const double x[] = {0.5};
  double dx[1];
  std::vector<double> y(static_cast<std::size_t>(evaluator.sensor_ports()));
  evaluator.rates(x, nullptr, 0.0, dx);
  evaluator.predict(x, nullptr, 0.0, y.data());
  return {dx[0], y[0], y[1], y[2]};
}

TEST(AnOutputWithTheNameOfSomethingElse, IsWhatSensorEffectsMean) {
  const Answer bias = answer_with(namesake_text, effect("bias", {{"output", "flow"}}), {{"offset", 0.25}});
  EXPECT_DOUBLE_EQ(bias.dw, -1.5) << "the equation is as it was";
  EXPECT_DOUBLE_EQ(bias.flow, 3.25);
  const Answer scale = answer_with(namesake_text, effect("sensor_scale", {{"output", "w"}}), {{"scale_error", 0.1}});
  EXPECT_DOUBLE_EQ(scale.w, 1.1) << "of what is measured, not of the state";
  const Answer talk = answer_with(namesake_text, effect("cross_talk", {{"output", "half"}, {"other_signal", "w"}}), {{"cross_share", 0.1}});
  EXPECT_DOUBLE_EQ(talk.half, 0.25 + 0.1 * 1.0);
}

TEST(AnOutputThatIsTheQuantityOfItsName, IsChangedWithIt) {
  const std::string text = replaced(replaced(namesake_text, ", formula = \"g*flow\"", ""), "k*w", "g*k*w");
  const Answer bias = answer_with(text, effect("bias", {{"output", "flow"}}), {{"offset", 0.25}});
  EXPECT_DOUBLE_EQ(bias.dw, -3.25);
  EXPECT_DOUBLE_EQ(bias.flow, 3.25);
}

const std::string turntable_text = R"toml(
[display]
angle = "rad"
[states]
angle = { unit = "rad" }
w = { unit = "rad/s", rate_of = "angle" }
[inputs]
u = { unit = "V" }
[parameters]
gain = { unit = "rad/s^2/V", value = 10.0 }
[equations]
w = "gain*u"
[outputs]
angle = { unit = "rad", noise = 1e-3 }
w = { unit = "rad/s", noise = 1e-2 }
)toml";

/// Units of what effects add follow those of the system.
TEST(DeclaredDisplay, InRadiansShowsAnglesTheirRatesAndWhatEffectsAddInRadians) {
  const auto known = registry_with(turntable_text);
  const Model model = assemble(request_of("text", {effect("coulomb_friction"), effect("viscous_friction")}), *known);
  const SystemSpec& spec = model.system->spec();
  EXPECT_EQ(display_unit(spec.states[0].unit), "rad");
  EXPECT_EQ(display_unit(spec.outputs[1].unit), "rad/s");
  std::map<std::string, std::string> shown_units;
  for (const Parameter& p : model.parameters) shown_units[p.name] = display_unit(p.unit);
  EXPECT_EQ(shown_units.at("gain"), "rad/s^2/V");
  EXPECT_EQ(shown_units.at("friction"), "rad/s^2");
  EXPECT_EQ(shown_units.at("width"), "rad/s");
  EXPECT_EQ(shown_units.at("viscosity"), "1/s");
}

TEST(DeclaredDisplay, InUnitsOfTheRecordingShowsWhatIsMeasuredInThemAndWhatEffectsAdd) {
  std::string text = turntable_text;
  text.replace(text.find("angle = \"rad\"\n"), 14, "units = [\"rpm\", \"kV\"]\n");
  const auto known = registry_with(text);
  const Model model = assemble(request_of("text", {effect("coulomb_friction"), effect("viscous_friction")}), *known);
  const SystemSpec& spec = model.system->spec();
  EXPECT_EQ(display_unit(spec.states[0].unit), "deg");
  EXPECT_EQ(display_unit(spec.states[1].unit), "rpm");
  EXPECT_EQ(display_unit(spec.inputs[0].unit), "kV");
  std::map<std::string, std::string> shown_units;
  for (const Parameter& p : model.parameters) shown_units[p.name] = display_unit(p.unit);
  EXPECT_EQ(shown_units.at("gain"), "rad/s^2/V");
  EXPECT_EQ(shown_units.at("friction"), "rpm/s");
  EXPECT_EQ(shown_units.at("width"), "rpm");
  EXPECT_EQ(shown_units.at("viscosity"), "1/s");
}

struct WrongUnits {
  std::string units, said;
};

TEST(DeclaredSystem, UnitsMadeOfSeveralAreShownWithThoseOfTheSystem) {
  SystemSpec spec;
  for (const char* unit : {"degC", "kW", "km/h", "mm"}) spec.shown_units.push_back(shown_in(unit));
  const auto shown_as = [&](const std::string& unit) { return display_unit(declared::shown_unit(unit, spec)); };
  EXPECT_EQ(declared::shown_unit("K/W", spec), "K/W (shown in K/kW)");
  EXPECT_EQ(shown_as("K s/m"), "K h/km") << "per km/h, not per mm";
  EXPECT_EQ(shown_as("W/K"), "kW/K");
  EXPECT_EQ(shown_as("K/s/W"), "K/s/kW");
  EXPECT_EQ(shown_as("m/s^2"), "mm/s^2");
  EXPECT_EQ(shown_as("1/m"), "1/mm");
  EXPECT_EQ(shown_as("m^2"), "m^2") << "neither one mm nor per mm";
  EXPECT_EQ(shown_as("1/K"), "1/K") << "of a difference";
  EXPECT_EQ(shown_as("rad/s/W"), "rad/s/W") << "angles are shown in two ways only";
  EXPECT_EQ(shown_as("V"), "V");
  EXPECT_NEAR(display_value(-6.37, declared::shown_unit("K s/m", spec)), -6.37 / 3.6, 1e-12);
  EXPECT_NEAR(display_value(0.0653, declared::shown_unit("K/W", spec)), 65.3, 1e-9);
}

TEST(DeclaredDisplay, RefusesUnitsThatAreNoneAndSecondOnesInWords) {
  for (const auto& [units, said] : std::vector<WrongUnits>{{R"(["rmp"])", "unknown unit 'rmp' — did you mean 'rpm'"},
                                                           {R"(["kW", "MW"])", "MW is a second unit for what is W"},
                                                           {R"(["min"])", "times are shown in s, not in min"},
                                                           {R"(["mrad"])", "angles and their rates are shown as angle ="},
                                                           {R"(["deg/s"])", "angles and their rates are shown as angle ="}}) {
    std::string text = turntable_text;
    text.replace(text.find("angle = \"rad\"\n"), 14, "units = " + units + "\n");
    try {
      static_cast<void>(registry_with(text));
      ADD_FAILURE() << units;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("text.toml:3"), HasSubstr(said)));
    }
  }
}

TEST(DeclaredDisplay, TakesDegreesOrRadiansAlone) {
  std::string text = turntable_text;
  text.replace(text.find("\"rad\""), 5, "\"radians\"");
  try {
    static_cast<void>(registry_with(text));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("text.toml:3"), HasSubstr("radians"), HasSubstr("rad")));
  }
}

TEST(DeclaredDuffing, TakesEffectsOnItsPortsQuantitiesAndInputs) {
  const auto known = registry_with(duffing_text);
  for (const std::string port : {"push", "dv/dt", "dy/dt", "u", "spring", "y"}) {
    auto with = std::make_shared<Registry>(Registry::over(*known));
    const std::string unit = port == "u" || port == "y" ? "V" : port == "dy/dt" ? "V/s" : "V/s^2";
    with->add(declared_effect(effect_in_one_line("extra", "{ port = \"" + port + "\", formula = \"c\", parameters = { c = { unit = \"" +
                                                              unit + "\", value = 0.25 } } }"),
                              known->system("text").make({})->spec()));
    const Model without = assemble(request_of("text"), *known), model = assemble(request_of("text", {effect("extra")}), *with);
    Evaluator plain(without), more(model);
    const double x[] = {0.3, -1.2}, u[] = {0.7};
    double a[2], b[2], ya[2], yb[2];
    plain.rates(x, u, 0.0, a);
    more.rates(x, u, 0.0, b);
    plain.predict(x, u, 0.0, ya);
    more.predict(x, u, 0.0, yb);
    EXPECT_NEAR(b[0] - a[0], port == "dy/dt" ? 0.25 : 0.0, 1e-14) << port;
    const double by_port = port == "push" || port == "dv/dt" ? 0.25 : port == "u" ? 2.5 : port == "spring" ? -0.25 : 0.0;
    EXPECT_NEAR(b[1] - a[1], by_port, 1e-14) << port;
    EXPECT_NEAR(yb[0] - ya[0], port == "y" ? 0.25 : 0.0, 1e-14) << port;
  }
}

/// Arrhenius' reactor: c' = f (1 - c) - k c, T' = f (cool - T) + 200 K k c, with k + 0.002 (T - 300 K).
TEST(AnEffectOnAParameterOfSeveralEquations, ActsInAllOfThem) {
  const std::string text = R"toml(
[states]
c = { unit = "-" }
T = { unit = "K" }
[parameters]
k = { unit = "1/s", value = 0.1, free = true }
f = { unit = "1/s", value = 0.05 }
heat = { unit = "K", value = 200.0, free = true }
cool = { unit = "K", value = 300.0 }
cool_rate = { unit = "K/s", value = 0.0 }
[equations]
c = "f*(1 - c) - k*c"
T = "f*(cool - T) + heat*k*c + cool_rate"
[outputs]
c = { unit = "-", noise = 0.01 }
T = { unit = "K", noise = 0.1 }
)toml";
  const auto systems = registry_with(text);
  const auto varying = [](const char* parameter) { return effect("varying_parameter", {{"parameter", parameter}, {"with", "T"}}); };
  Model model = assemble(request_of("text", {varying("k")}), *systems);
  model.parameters[static_cast<std::size_t>(model.find_parameter("slope"))].value = 0.002;
  model.parameters[static_cast<std::size_t>(model.find_parameter("middle"))].value = 300.0;
  Evaluator evaluator(model);
  const std::vector<double> x = {0.4, 310.0};
  std::vector<double> dx(2);
  evaluator.rates(x.data(), nullptr, 0.0, dx.data());
  constexpr double k = 0.1 + 0.002 * 10.0;
  EXPECT_NEAR(dx[0], 0.05 * 0.6 - k * 0.4, 1e-12);
  EXPECT_NEAR(dx[1], -0.05 * 10.0 + 200.0 * k * 0.4, 1e-12);
  EXPECT_NO_THROW(static_cast<void>(assemble(request_of("text", {varying("heat")}), *systems))) << "how much it does depends on the motion";
  EXPECT_THROW(static_cast<void>(assemble(request_of("text", {varying("cool_rate")}), *systems)), InputError)
      << "it is a force, and there is a port for that";
}

TEST(DeclaredSystems, KeepStatesInTheirRange) {
  const auto known = registry_with(R"toml(
[states]
x1 = { unit = "V", min = 0.0, max = 2.0 }
[parameters]
k1 = { unit = "V^0.5/s", value = 0.5, free = true }
[equations]
x1 = "-k1*sqrt(x1)"
[outputs]
y = { unit = "V", formula = "x1" }
)toml");
  const Model model = assemble(request_of("text"), *known);
  Evaluator evaluator(model);
  double dx[1], D[kRowStride], y[2];
  const double below = -0.3, above = 2.5;
  Slots slots;
  evaluator.linearise_rates({&below, nullptr, 0.0}, slots, dx, D);
  EXPECT_EQ(dx[0], 0.0);
  EXPECT_EQ(D[0], 0.0);
  evaluator.predict(&below, nullptr, 0.0, y);
  EXPECT_EQ(y[0], 0.0);
  evaluator.rates(&above, nullptr, 0.0, dx);
  EXPECT_DOUBLE_EQ(dx[0], -0.5 * std::sqrt(2.0));
}

TEST(DeclaredSystems, ErrorsNamePlaceAndNearestName) {
  EXPECT_THAT(error_of(replaced(duffing_text, "damping*v", "dampng*v")),
              AllOf(HasSubstr("text.toml:18:"), HasSubstr("equation v"), HasSubstr("did you mean 'damping'")));
  EXPECT_THAT(error_of(replaced(duffing_text, "gain*u -", "gain*v -")),
              AllOf(HasSubstr("text.toml:18:"), HasSubstr("measure different things")));
  EXPECT_THAT(error_of(replaced(duffing_text, "y = \"v\"", "y = \"v*y\"")),
              AllOf(HasSubstr("equation y"), HasSubstr("[V^2/s]"), HasSubstr("needs [V/s]")));
  EXPECT_THAT(error_of(replaced(duffing_text, "[inputs]", "[input]")), HasSubstr("input"));
  EXPECT_THAT(error_of(replaced(duffing_text, "v = \"gain", "w = \"gain")), HasSubstr("no state 'w'"));
  EXPECT_THAT(error_of(replaced(duffing_text, "gain = {", "unused = { unit = \"-\", value = 1 }\ngain = {")),
              HasSubstr("nothing depends on parameter 'unused'"));
  EXPECT_THAT(error_of(replaced(duffing_text, "unit = \"1/s\"", "unit = \"1/ms\"")),
              AllOf(HasSubstr("is not an SI unit"), HasSubstr("declare it as \"1/s\""), HasSubstr("\"5 1/ms\"")));
  EXPECT_THAT(error_of(replaced(duffing_text, "unit = \"1/s\", ", "")), HasSubstr("the unit is missing"));
  EXPECT_THAT(error_of(replaced(duffing_text, "gain = {", "sin = {")), HasSubstr("is no function of formulas"));
  EXPECT_THAT(error_of(replaced(duffing_text, "gain = {", "u = {")), HasSubstr("'u' is taken"));
  EXPECT_THAT(error_of(replaced(duffing_text, "stiffness*y +", "spring +")), HasSubstr("depends on itself"));
  EXPECT_THAT(error_of(replaced(duffing_text, "stiffness*y +", "push +")), AllOf(HasSubstr("in equations only"), HasSubstr("quantity")));
  EXPECT_THAT(error_of(replaced(duffing_text, "value = 0.4, bounds", "value = -1.0, bounds")), HasSubstr("is outside its bounds"));
  EXPECT_THAT(error_of(duffing_text + "[roles]\nrate = \"w\"\n"), HasSubstr("[roles] rate: there is no 'w'"));
  EXPECT_THAT(error_of("[states]\nx = { unit = \"V\" }\n"), HasSubstr("[equations] is missing"));
  EXPECT_THAT(error_of("x = ["), HasSubstr("not valid TOML"));
}

TEST(DeclaredSystems, AStateThatIsTheRateOfAnotherStandsInItsEquation) {
  const std::string rate = replaced(duffing_text, "unit = \"V/s\", scale", "unit = \"V/s\", rate_of = \"y\", scale");
  EXPECT_EQ(error_of(rate), "");
  EXPECT_EQ(error_of(replaced(rate, "y = \"v\"\n", "")), "");
  EXPECT_THAT(error_of(replaced(rate, "y = \"v\"", "y = \"2*v\"")),
              AllOf(HasSubstr("text.toml:17:"), HasSubstr("the equation of 'y' is not 'v'"), HasSubstr("take rate_of out")));
}

TEST(DeclaredSystems, AnOutputThatStepsWithAStateIsNoWayToReadIt) {
  const auto readable = [](const std::string& outputs) {
    return registry_with(
               "[states]\nx = { unit = \"V\" }\n[parameters]\nk = { unit = \"1/s\", value = 1 }\n"
               "[equations]\nx = \"-k*x\"\n[outputs]\n" +
               outputs)
        ->system("text")
        .make({})
        ->spec()
        .readable_states;
  };
  const std::string line = "y = { unit = \"V\", formula = \"2*x\" }\n";
  EXPECT_THAT(readable(line), ElementsAre(0));
  EXPECT_THAT(readable(line + "side = { unit = \"-\", formula = \"if(x > 0, 1, 0)\" }\n"), ElementsAre(0));
  EXPECT_THAT(readable("side = { unit = \"-\", formula = \"sign(x)\" }\n"), ElementsAre());
}

const Parameter& parameter_of(const Model& model, const std::string& name) {
  return model.parameters.at(static_cast<std::size_t>(model.find_parameter(name)));
}

TEST(DeclaredSystems, TheScaleOfAParameterIsItsTypicalSize) {
  const auto scale = [](const std::string& keys) {
    const auto known = registry_with(replaced(duffing_text, "unit = \"1/s^2\", value = 10.0", "unit = \"1/s^2\", " + keys));
    return parameter_of(assemble(request_of("text"), *known), "gain").scale;
  };
  EXPECT_EQ(scale("value = 10.0, scale = 0.5"), 0.5);
  EXPECT_EQ(scale("value = 10.0, sigma = 0.1"), 10.0);
  EXPECT_EQ(scale("value = 0.0, sigma = 0.1"), 0.1);
  EXPECT_EQ(scale("value = 0.0"), 1.0);
}

TEST(DeclaredSystems, AStartMovesNoPriorAndAValueWithItsSigmaDoes) {
  const auto known = registry_with(replaced(duffing_text, "value = 10.0", "value = 10.0, sigma = 0.5, free = true"));
  ModelRequest request = request_of("text");
  request.parameters["gain"].value = 7.0;
  const Model started = assemble(request, *known);
  EXPECT_EQ(parameter_of(started, "gain").value, 7.0);
  EXPECT_EQ(parameter_of(started, "gain").prior_mean, 10.0);
  EXPECT_EQ(parameter_of(started, "gain").prior_sigma, 0.5);
  request.constants["gain"] = 9.0;
  EXPECT_EQ(parameter_of(assemble(request, *known), "gain").prior_mean, 9.0) << "of [geometry]";
  request.parameters["gain"].sigma = 0.2;
  EXPECT_EQ(parameter_of(assemble(request, *known), "gain").prior_mean, 7.0);
  EXPECT_EQ(parameter_of(assemble(request, *known), "gain").prior_sigma, 0.2);
}

TEST(DeclaredSystems, SayWhereAFormulaIsNotDefined) {
  const auto known = registry_with(R"toml(
[states]
x1 = { unit = "V" }
[parameters]
k1 = { unit = "V^0.5/s", value = 0.05, free = true }
[equations]
x1 = "-k1*sqrt(x1)"
[outputs]
y = { unit = "V", formula = "x1" }
)toml");
  const Model model = assemble(request_of("text"), *known);
  const double x = -0.2;
  EXPECT_EQ(Evaluator(model).explain(&x, nullptr, 84.0),
            "x1 is -0.2 V: sqrt(x1) is not finite there, in equation x1; with k1 = 0.05 V^0.5/s");
}

TEST(DeclaredSystems, InitialStatesAreFreeSharedOrFixedAndAStudyMayChangeThat) {
  const std::string text = replaced(duffing_text, "scale = 0.1", "initial = \"shared\"");
  const auto known = registry_with(replaced(text, "scale = 4.0", "initial = 2.5"));
  ModelRequest request = request_of("text");
  Model model = assemble(request, *known);
  EXPECT_EQ(model.state_specs[0].initial, Initial::shared);
  EXPECT_EQ(model.state_specs[1].initial, Initial::fixed);
  EXPECT_EQ(model.state_specs[1].start, 2.5);
  request.initial["v"].initial = Initial::free;
  model = assemble(request, *known);
  EXPECT_EQ(model.state_specs[1].initial, Initial::free);
  request.initial["w"].initial = Initial::free;
  EXPECT_THROW(static_cast<void>(assemble(request, *known)), InputError);
}

TEST(DeclaredSystems, MeasurementNoiseOfOutputsIsWhatTheStudyKnows) {
  const auto known = registry_with(duffing_text);
  ModelRequest request = request_of("text");
  EXPECT_FALSE(assemble(request, *known).noise_is_given());
  const std::string output = known->system("text").make({})->spec().outputs.front().name;
  request.noise[output] = {0.3, true, {}};
  const Model model = assemble(request, *known);
  EXPECT_TRUE(model.noise_is_given());
  EXPECT_EQ(model.known_noise.front().sigma, 0.3);
  request.noise["nothing"] = {0.3, true, {}};
  EXPECT_THROW(static_cast<void>(assemble(request, *known)), InputError);
}

TEST(DeclaredEffects, TellStrengthsFromShapes) {
  const auto known = registry_with(duffing_text);
  const SystemSpec system = known->system("text").make({})->spec();
  const auto kinds = [&](const std::string& line) {
    std::string out;
    const auto made = declared_effect(effect_in_one_line("extra", line), system);
    for (const auto& c : made->spec().coefficients) out += std::string(c.name) + (c.kind == CoefficientKind::strength ? "+" : "") + " ";
    return out;
  };
  EXPECT_EQ(
      kinds(
          R"toml({ port = "dv/dt", formula = "c*max(y - level, 0)", parameters = { c = { unit = "1/s^2" }, level = { unit = "V" } } })toml"),
      "c+ level ");
  EXPECT_EQ(
      kinds(R"toml({ port = "dv/dt", formula = "a*y + b*y^3", parameters = { a = { unit = "1/s^2" }, b = { unit = "1/V^2/s^2" } } })toml"),
      "a+ b+ ");
  EXPECT_EQ(
      kinds(R"toml({ port = "dv/dt", formula = "c*(y - level)", parameters = { c = { unit = "1/s^2" }, level = { unit = "V" } } })toml"),
      "c+ level ");
}

TEST(DeclaredEffects, ErrorsAreWords) {
  const auto known = registry_with(duffing_text);
  const SystemSpec system = known->system("text").make({})->spec();
  const auto error = [&](const std::string& line) -> std::string {
    try {
      static_cast<void>(declared_effect(effect_in_one_line("extra", line), system));
    } catch (const InputError& caught) {
      return caught.what();
    }
    return {};
  };
  EXPECT_THAT(error(R"toml({ port = "dw/dt", formula = "c", parameters = { c = { unit = "-" } } })toml"),
              AllOf(HasSubstr("no port 'dw/dt'"), HasSubstr("dv/dt")));
  EXPECT_THAT(
      error(
          R"toml({ port = "dv/dt", formula = "c*max(y - levl, 0)", parameters = { c = { unit = "1/s^2" }, level = { unit = "V" } } })toml"),
      AllOf(HasSubstr("study.toml:2:"), HasSubstr("'levl'"), HasSubstr("did you mean 'level'")));
  EXPECT_THAT(error(R"toml({ port = "dv/dt", formula = "c*y", parameters = { c = { unit = "1/s" } } })toml"),
              AllOf(HasSubstr("[V/s]"), HasSubstr("needs [V/s^2]")));
  EXPECT_THAT(error(R"toml({ port = "dv/dt", formula = "c*y", parameters = { c = { unit = "1/s^2" }, d = { unit = "V" } } })toml"),
              HasSubstr("nothing depends on its parameter 'd'"));
  EXPECT_THAT(error(R"toml({ port = "dv/dt", formula = "exp(c)*v*stiffness/damping", parameters = { c = { unit = "-" } } })toml"),
              HasSubstr("switches it off"));
}

TEST(DeclaredEffects, AreRefusedWhereANameMeansAnOutputAndSomethingElse) {
  const SystemSpec system = registry_with(namesake_text)->system("text").make({})->spec();
  const auto error = [&](const std::string& port, const std::string& formula, const std::string& unit) {
    return message_of<InputError>([&] {
      static_cast<void>(declared_effect(effect_in_one_line("extra", "{ port = \"" + port + "\", formula = \"" + formula +
                                                                        "\", parameters = { c = { unit = \"" + unit + "\" } } }"),
                                        system));
    });
  };
  for (const std::string& message : {error("flow", "c", "V/s"), error("w", "c*w", "-")})
    EXPECT_THAT(message, AllOf(HasSubstr("study.toml:2"), HasSubstr("is an output with a formula of its own"),
                               HasSubstr("call the output otherwise")));
  const auto made = declared_effect(
      effect_in_one_line("extra", "{ port = \"dw/dt\", formula = \"c*w\", parameters = { c = { unit = \"1/s\" } } }"), system);
  EXPECT_EQ(made->spec().quantities.size(), 1U) << "the state: forces read no outputs";
}

TEST(DeclaredEffects, ASigmaIsAPriorAboutTheValueInEveryFit) {
  const auto known = registry_with(duffing_text);
  const auto made = declared_effect(
      effect_in_one_line(
          "extra", R"toml({ port = "dv/dt", formula = "c*y", parameters = { c = { unit = "1/s^2", value = 2.0, sigma = 0.25 } } })toml"),
      known->system("text").make({})->spec());
  EXPECT_EQ(made->spec().coefficients.front().own_sigma, 0.25);
  Registry with = Registry::over(*known);
  with.add(declared_effect(
      effect_in_one_line(
          "extra", R"toml({ port = "dv/dt", formula = "c*y", parameters = { c = { unit = "1/s^2", value = 2.0, sigma = 0.25 } } })toml"),
      known->system("text").make({})->spec()));
  ModelRequest request = request_of("text", {effect("extra")});
  request.parameters["c"].value = 3.0;
  const Model model = assemble(request, with);
  EXPECT_EQ(parameter_of(model, "c").value, 3.0);
  EXPECT_EQ(parameter_of(model, "c").prior_mean, 2.0) << "a start is no value that is known";
}

}  // namespace
}  // namespace misfit
