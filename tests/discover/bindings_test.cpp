#include "misfit/discover/bindings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/declared_texts.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::Contains;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

std::vector<Roles> bindings(const std::string& effect, const std::string& system) {
  return enumerate_bindings(registry().effect(effect).spec(), registry().system(system).make({})->spec());
}

TEST(Bindings, ALevelEffectHasOnePerPortThatALevelDrives) {
  EXPECT_THAT(bindings("overflow", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"level", "x1"}, {"port", "dx1/dt"}}, Roles{{"level", "x2"}, {"port", "dx2/dt"}}));
}

TEST(Bindings, ALeakIsOfWhatThePortFills) {
  EXPECT_THAT(bindings("leak", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"content", "x1"}, {"port", "dx1/dt"}}, Roles{{"content", "x2"}, {"port", "dx2/dt"}}));
  EXPECT_THAT(bindings("leak", "test_oscillator"), ElementsAre(Roles{})) << "of a displacement it would be a spring";
}

TEST(Bindings, WhatSpillsGoesToEachOtherPort) {
  EXPECT_THAT(bindings("overflow_into", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"level", "x1"}, {"to_port", "dx2/dt"}}, Roles{{"level", "x2"}, {"to_port", "dx1/dt"}}));
}

TEST(Bindings, WhatIsSpilledIsLostWhereItWas) {
  EXPECT_THAT(bindings("overflow_between", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"level", "x1"}, {"port", "dx1/dt"}, {"to_port", "dx2/dt"}},
                          Roles{{"level", "x2"}, {"port", "dx2/dt"}, {"to_port", "dx1/dt"}}));
}

TEST(Bindings, NeitherHeatNorAConcentrationNorASpeedSpills) {
  for (const char* unit : {"K", "g/l", "m/s", "rad/s"}) {
    SystemSpec bodies = registry().system("test_tanks").make({})->spec();
    for (StateSpec& state : bodies.states) state.unit = unit;
    EXPECT_THAT(enumerate_bindings(registry().effect("overflow_between").spec(), bodies), ElementsAre(Roles{})) << unit;
  }
}

TEST(Bindings, AMotionHasItsRateAndWhatThatIsTheRateOf) {
  EXPECT_THAT(bindings("quadratic_drag", "test_oscillator"), ElementsAre(Roles{}, Roles{{"port", "force"}, {"rate", "v"}}));
  EXPECT_THAT(bindings("cubic_stiffness", "test_oscillator"), ElementsAre(Roles{}, Roles{{"displacement", "x"}, {"port", "force"}}));
  EXPECT_THAT(bindings("cubic_stiffness", "test_tanks"), ElementsAre(Roles{})) << "a tank has no displacement";
}

TEST(Bindings, TheSpeedOfAMotorIsARateThoughNobodyModelsItsAngle) {
  SystemSpec motor = registry().system("test_tanks").make({})->spec();
  motor.states[0].unit = "rad/s";
  EXPECT_THAT(enumerate_bindings(registry().effect("coulomb_friction").spec(), motor),
              ElementsAre(Roles{}, Roles{{"port", "dx1/dt"}, {"rate", "x1"}}));
  motor.states[0].unit = "rad/s^2";
  EXPECT_THAT(enumerate_bindings(registry().effect("coulomb_friction").spec(), motor), ElementsAre(Roles{})) << "an acceleration is none";
}

TEST(Bindings, LevelsOfOneUnitMayExchange) {
  EXPECT_THAT(bindings("exchange", "test_tanks"), ElementsAre(Roles{}, Roles{{"level", "x1"}, {"other", "x2"}, {"port", "dx1/dt"}},
                                                              Roles{{"level", "x2"}, {"other", "x1"}, {"port", "dx2/dt"}}));
  SystemSpec of_two_kinds = registry().system("test_tanks").make({})->spec();
  of_two_kinds.states[0].unit = "K";
  EXPECT_THAT(enumerate_bindings(registry().effect("exchange").spec(), of_two_kinds), ElementsAre(Roles{}));
}

/// A force elsewhere would not show in that output.
TEST(Bindings, AnInputMultipliesStatesAndDifferencesOfLevels) {
  EXPECT_THAT(bindings("bilinear", "test_oscillator"), ElementsAre(Roles{}, Roles{{"factor", "v"}, {"input", "drive"}, {"port", "force"}},
                                                                   Roles{{"factor", "x"}, {"input", "drive"}, {"port", "force"}},
                                                                   Roles{{"factor", "v"}, {"input", "x"}, {"port", "force"}}))
      << "a product of two states once";
  EXPECT_THAT(bindings("bilinear_exchange", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"input", "u"}, {"level", "x1"}, {"other", "x2"}, {"port", "dx1/dt"}},
                          Roles{{"input", "u"}, {"level", "x2"}, {"other", "x1"}, {"port", "dx2/dt"}}));
  SystemSpec tank = registry().system("test_tanks").make({})->spec();
  std::erase_if(tank.states, [](const StateSpec& state) { return state.name == "x2"; });
  std::erase_if(tank.dynamic_ports, [](const auto& port) { return port.conjugate == "x2"; });
  tank.inputs.push_back({.name = "outside", .unit = "m", .doc = "level outside"});
  EXPECT_THAT(enumerate_bindings(registry().effect("bilinear_exchange").spec(), tank),
              ElementsAre(Roles{}, Roles{{"input", "u"}, {"level", "x1"}, {"other", "outside"}, {"port", "dx1/dt"}}))
      << "an input may be the other level, but does not multiply itself";
}

/// A reaction whose rate stands in the balances of mass and of heat, beside parameters of one of them and one that is known.
TEST(Bindings, AFreeParameterOfSeveralEquationsMayVaryWithEachStateAndInput) {
  const auto systems = registry_with(R"toml(
[states]
c = { unit = "-" }
T = { unit = "K" }
[inputs]
cool = { unit = "K" }
[parameters]
k = { unit = "1/s", value = 0.1, free = true }
flow = { unit = "1/s", value = 0.1 }
heat = { unit = "K", value = 200.0, free = true }
[quantities]
reaction = { unit = "1/s", formula = "k*c" }
[equations]
c = "flow*(1 - c) - reaction"
T = "flow*(cool - T) + heat*reaction"
[outputs]
c = { unit = "-", noise = 0.01 }
T = { unit = "K", noise = 0.1 }
)toml");
  const auto with = [](const char* quantity) { return Roles{{"parameter", "k"}, {"with", quantity}}; };
  EXPECT_THAT(enumerate_bindings(systems->effect("varying_parameter").spec(), systems->system("text").make({})->spec()),
              ElementsAre(with("c"), with("T"), with("cool")));
  EXPECT_THAT(enumerate_bindings(systems->effect("drift").spec(), systems->system("text").make({})->spec()),
              ElementsAre(Roles{}, Roles{{"port", "dc/dt"}}, Roles{{"port", "dT/dt"}}, Roles{{"port", "k"}}, Roles{{"port", "heat"}}))
      << "what is known does not drift";
  EXPECT_THAT(bindings("varying_parameter", "test_oscillator"), testing::IsEmpty());
}

/// A fuse: what heats it goes with the square of the current, what cools it with its temperature; R0 that grows with T is no product of T
/// and I, h that grows with I is.
TEST(Bindings, AFreeFactorOfAFunctionOfAnInputMayVaryWithAllButThat) {
  const auto systems = registry_with(R"toml(
[states]
T = { unit = "K" }
[inputs]
I = { unit = "A" }
[parameters]
R0 = { unit = "ohm", value = 0.05, free = true }
h = { unit = "W/K", value = 0.08, free = true }
leak = { unit = "W", value = 0.0, free = true }
C = { unit = "J/K", value = 2.0 }
[equations]
T = "(R0*I^2 - h*T - leak)/C"
[outputs]
T = { unit = "K", noise = 0.1 }
)toml");
  const auto system = systems->system("text").make({});
  const SystemSpec& spec = system->spec();
  EXPECT_THAT(enumerate_bindings(systems->effect("varying_parameter").spec(), spec),
              ElementsAre(Roles{{"parameter", "R0"}, {"with", "T"}}));
  const auto port = [&](const char* name) { return spec.quantity_ports[index_of(spec.quantity_ports, name)]; };
  EXPECT_TRUE(is_more_than_a_force(port("R0"), "T") && is_more_than_a_force(port("h"), "I") && is_more_than_a_force(port("h"), "time"));
  EXPECT_FALSE(is_more_than_a_force(port("R0"), "I")) << "a force that depends on I";
  EXPECT_FALSE(is_more_than_a_force(port("h"), "T"));
  EXPECT_LT(index_of(spec.quantity_ports, "leak"), 0) << "a constant force, whatever it depends on";
}

TEST(Bindings, AnInputThatAnOutputsFormulaReadsIsAPlaceOfItsOwn) {
  SystemSpec tanks = registry().system("test_tanks").make({})->spec();
  const std::string input = tanks.inputs.front().name;
  const Roles itself = {{"input", input}, {"port", input}};
  for (const char* effect : {"input_gain", "input_offset", "input_lag", "delay", "saturation"}) {
    tanks.ports_in_outputs.clear();
    EXPECT_THAT(enumerate_bindings(registry().effect(effect).spec(), tanks), testing::Not(Contains(itself))) << effect;
    tanks.ports_in_outputs = {input};
    EXPECT_THAT(enumerate_bindings(registry().effect(effect).spec(), tanks), Contains(itself)) << effect;
  }
  EXPECT_THAT(enumerate_bindings(registry().effect("delay").spec(), tanks), ElementsAre(itself)) << "of the input itself, there only";
  EXPECT_THAT(enumerate_bindings(registry().effect("input_offset").spec(), tanks), testing::SizeIs(4)) << "or a force on either level";
  EXPECT_THAT(enumerate_bindings(registry().effect("leak").spec(), tanks), testing::Not(Contains(itself)));
}

TEST(Bindings, AQuantityThatAPortCallsItsRateHasNoLevelToExchange) {
  SystemSpec twisted = registry().system("test_oscillator").make({})->spec();
  twisted.quantities.push_back({.name = "twist", .unit = "rad/s", .doc = "of two ends"});
  twisted.dynamic_ports.push_back({.name = "torque", .unit = "N m", .doc = "of the shaft", .conjugate = "twist"});
  EXPECT_THAT(enumerate_bindings(registry().effect("coulomb_friction").spec(), twisted),
              Contains(Roles{{"port", "torque"}, {"rate", "twist"}}));
  EXPECT_THAT(enumerate_bindings(registry().effect("exchange").spec(), twisted), ElementsAre(Roles{}));
  twisted.quantities.push_back({.name = "angle", .unit = "rad", .doc = "between two ends"});
  twisted.quantities[twisted.quantities.size() - 2].rate_of = "angle";
  EXPECT_THAT(enumerate_bindings(registry().effect("cubic_stiffness").spec(), twisted),
              Contains(Roles{{"port", "torque"}, {"displacement", "angle"}}));
  EXPECT_THAT(enumerate_bindings(registry().effect("exchange").spec(), twisted), ElementsAre(Roles{})) << "no state, hence no other one";
}

TEST(Bindings, SensorsAndInputsAreTriedWhereTheSystemHasADefaultForThem) {
  EXPECT_THAT(bindings("sensor_scale", "test_tanks"), ElementsAre(Roles{}, Roles{{"output", "y1"}}, Roles{{"output", "y2"}}));
  EXPECT_THAT(bindings("input_gain", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"input", "u"}, {"port", "dx1/dt"}}, Roles{{"input", "u"}, {"port", "dx2/dt"}}));
  EXPECT_THAT(bindings("sensor_scale", "parachute_spherical"), ElementsAre(Roles{}));
  EXPECT_THAT(bindings("quadratic_drag", "parachute_spherical"), ElementsAre(Roles{})) << "its own default stays the only one";
}

TEST(Bindings, EachOutputMayShowEachInputAtOnce) {
  EXPECT_THAT(bindings("feedthrough", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"input", "u"}, {"output", "y1"}}, Roles{{"input", "u"}, {"output", "y2"}}));
  EXPECT_THAT(bindings("feedthrough", "parachute_spherical"), ElementsAre(Roles{})) << "it has no input";
}

TEST(Bindings, AClockIsOffOnlyBesideAnotherOne) {
  EXPECT_THAT(bindings("time_offset", "test_tanks"), ElementsAre(Roles{})) << "its input has a clock";
  EXPECT_THAT(bindings("time_offset", "parachute_spherical"), testing::IsEmpty()) << "a motion at another time is as likely";
}

TEST(Bindings, AChannelMayShowPartOfEachOtherOfItsUnitAndEachPairMayBeTurned) {
  EXPECT_THAT(bindings("cross_talk", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"other_signal", "y2"}, {"output", "y1"}}, Roles{{"other_signal", "y1"}, {"output", "y2"}}));
  EXPECT_THAT(bindings("output_rotation", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"other_output", "y2"}, {"other_signal", "y2"}, {"output", "y1"}}));
  SystemSpec of_two_kinds = registry().system("test_tanks").make({})->spec();
  of_two_kinds.outputs[0].unit = "K";
  EXPECT_THAT(enumerate_bindings(registry().effect("cross_talk").spec(), of_two_kinds), ElementsAre(Roles{}));
}

TEST(Bindings, PlayMayLieBehindAnInputOfTheUnitOfWhatItMoves) {
  SystemSpec servo = registry().system("test_oscillator").make({})->spec();
  servo.inputs.push_back({.name = "demand", .unit = servo.states[0].unit, .doc = "where it is to go"});
  servo.inputs.push_back({.name = "torque", .unit = "N m", .doc = "on its shaft"});
  EXPECT_THAT(enumerate_bindings(registry().effect("backlash").spec(), servo),
              ElementsAre(Roles{}, Roles{{"displacement", "x"}, {"port", "force"}}, Roles{{"displacement", "demand"}, {"port", "force"}}));
  EXPECT_THAT(enumerate_bindings(registry().effect("cubic_stiffness").spec(), servo),
              ElementsAre(Roles{}, Roles{{"displacement", "x"}, {"port", "force"}}))
      << "a spring is of what moves";
}

TEST(Bindings, ASystemsOwnEffectHasItsOwnPlaceAlone) { EXPECT_THAT(bindings("strut_wake", "parachute_spherical"), ElementsAre(Roles{})); }

}  // namespace
}  // namespace misfit
