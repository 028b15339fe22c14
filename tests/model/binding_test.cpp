// What a request becomes: names, units, defaults and what is free.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/model/cases.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::ElementsAre;

TEST(Binding, OneEffectTwiceIsBoundTwiceWithCoefficientsNamedAfterEach) {
  const Model m = assemble(
      cart({effect("viscous_friction", {}, "bearing"), effect("viscous_friction", {{"rate", "x"}, {"port", "slip"}}, "leak")}), registry());
  ASSERT_EQ(m.effects.size(), 2U);
  EXPECT_GE(m.find_parameter("bearing.viscosity"), 0);
  EXPECT_GE(m.find_parameter("leak.viscosity"), 0);
  EXPECT_EQ(m.find_parameter("viscosity"), -1);
  EXPECT_EQ(m.parameters[static_cast<std::size_t>(m.find_parameter("bearing.viscosity"))].unit, "N s/m");
  EXPECT_EQ(m.parameters[static_cast<std::size_t>(m.find_parameter("leak.viscosity"))].unit, "1/s");
  Model with_values = m;
  set(with_values, "bearing.viscosity", 3.0);
  set(with_values, "leak.viscosity", 0.5);
  set(with_values, "stiffness", 0.0);
  Evaluator evaluator(with_values);
  const double x[] = {0.4, 2.0}, u[] = {0.0};
  double dx[2];
  evaluator.rates(x, u, 0.0, dx);
  EXPECT_NEAR(dx[0], 2.0 - 0.5 * 0.4, 1e-15);
  EXPECT_NEAR(dx[1], -3.0 * 2.0 / 2.0, 1e-15);
}

TEST(Binding, AGenericEffectHasTheUnitsOfWhatItIsBoundTo) {
  const Model planar =
      assemble(parachute(true, {effect("viscous_friction"), effect("lag"), effect("bias"), effect("coulomb_friction")}), registry());
  const auto unit = [&](const std::string& name) {
    return planar.parameters.at(static_cast<std::size_t>(planar.find_parameter(name))).unit;
  };
  EXPECT_EQ(unit("viscosity"), "N m s/rad");
  EXPECT_EQ(unit("lag_stiffness"), "N m/rad");
  EXPECT_EQ(unit("offset"), "rad");
  EXPECT_EQ(unit("width"), "rad/s");
  EXPECT_THAT(planar.own_state_names, ElementsAre("lag.z"));
  EXPECT_THAT(planar.own_state_units, ElementsAre("rad"));
}

TEST(Binding, AStudyMayCallTheFirstOfAKindByItsBareNameAndAnyByItsEffect) {
  ModelRequest r = cart({effect("viscous_friction", {}, "bearing"), effect("viscous_friction", {{"rate", "x"}, {"port", "slip"}}, "leak")});
  r.parameters["viscosity"].value = 3.0;
  r.parameters["leak.viscosity"].value = 0.5;
  const Model m = assemble(r, registry());
  const auto value = [](const Model& model, const std::string& name) {
    return model.parameters.at(static_cast<std::size_t>(model.find_parameter(name))).value;
  };
  EXPECT_EQ(value(m, "bearing.viscosity"), 3.0);
  EXPECT_EQ(value(m, "leak.viscosity"), 0.5);
  ModelRequest alone = cart({effect("viscous_friction", {}, "bearing")});
  alone.parameters["bearing.viscosity"].value = 2.0;
  EXPECT_EQ(value(assemble(alone, registry()), "viscosity"), 2.0);
  alone.parameters["leak.viscosity"].value = 2.0;
  EXPECT_THROW(static_cast<void>(assemble(alone, registry())), InputError);
}

TEST(Binding, AValueUnderTheEffectsNameTurnsADefaultCurveIntoANumber) {
  for (const char* name : {"C_mq", "pitch_damping.C_mq"}) {
    ModelRequest r = parachute(true);
    r.curves.erase("C_mq");
    r.parameters[name].value = -0.1;
    const Model m = assemble(r, registry());
    EXPECT_EQ(m.find_curve("C_mq"), nullptr) << name;
    EXPECT_GE(m.find_parameter("C_mq"), 0) << name;
    EXPECT_FALSE(curves_without_knots(r, registry()).contains("C_mq")) << name;
  }
}

/// A study names a curve before a second effect of the kind comes into the model: the curve stays that of the first.
TEST(Binding, ACurveOfTheFirstOfAKindMayHaveItsBareName) {
  ModelRequest r = cart({effect("viscous_friction", {}, "bearing"), effect("viscous_friction", {{"rate", "x"}, {"port", "slip"}}, "leak")});
  r.curves["viscosity"] = {"v", {}, 7.0, {}};
  EXPECT_THAT(curves_without_knots(r, registry()), ElementsAre(std::pair<const std::string, std::string>("viscosity", "v")));
  r.curves["viscosity"].knots = {-1.0, 0.0, 1.0};
  EXPECT_TRUE(curves_without_knots(r, registry()).empty());
  const Model m = assemble(r, registry());
  ASSERT_NE(m.find_curve("bearing.viscosity"), nullptr);
  EXPECT_EQ(m.find_curve("bearing.viscosity")->roughness, 7.0);
  EXPECT_GE(m.find_parameter("leak.viscosity"), 0);
  ModelRequest alone = cart({effect("viscous_friction", {}, "bearing")});
  alone.curves["bearing.viscosity"] = {"v", {-1.0, 0.0, 1.0}, 7.0, {}};
  EXPECT_NE(assemble(alone, registry()).find_curve("viscosity"), nullptr) << "by its effect, too";
}

TEST(Binding, ARoleMayNeedTheUnitOfAnother) {
  const auto spill = [](const std::string& level, const std::string& port) {
    return tanks({effect("overflow", {{"level", level}, {"port", port}})});
  };
  EXPECT_NO_THROW(static_cast<void>(assemble(spill("x1", "dx2/dt"), registry())));
  try {
    static_cast<void>(assemble(spill("u", "dx1/dt"), registry()));
    ADD_FAILURE() << "volts cannot spill into metres per second";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("role 'port' needs [V/s], port 'dx1/dt' has [m/s]"));
  }
  EXPECT_THROW(static_cast<void>(assemble(cart({effect("overflow")}), registry())), InputError) << "a force is no rate of a level";
}

TEST(Binding, ASensorReadsTheOutputThatItIsBoundTo) {
  const Model m = assemble(cart({effect("sensor_lag", {{"output", "speed_reading"}})}), registry());
  const SystemSpec& spec = m.system->spec();
  EXPECT_EQ(m.effects.front().quantities.front(), static_cast<int>(spec.quantities.size()) + 1);
  EXPECT_EQ(m.own_state_units.front(), "m/s");
}

TEST(Binding, ABorrowedCoefficientIsThatOfTheOtherEffect) {
  const Model m = assemble(spherical({effect("strut_wake")}), registry());
  EXPECT_EQ(std::count_if(m.parameters.begin(), m.parameters.end(), [](const auto& p) { return p.name == "C_m[0]"; }), 1);
  const BoundEffect &lender = m.effects.front(), &user = m.effects.back();
  EXPECT_EQ(user.coefficients.back().curve, lender.coefficients.front().curve);
  EXPECT_GE(user.coefficients.back().curve, 0);
}

TEST(Binding, ABorrowedCoefficientThatNobodyHasIsAnError) {
  ModelRequest r = spherical({effect("strut_wake")});
  r.effects.erase(r.effects.begin());
  r.curves.erase("C_m");
  try {
    static_cast<void>(assemble(r, registry()));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'C_m', and no effect of the model has one: static_moment has one, and comes first"));
  }
}

TEST(Binding, ARoleThatCompletesAnotherIsLeftOutWhereAStudyBindsThatOneAlone) {
  const Model whole = assemble(spherical({effect("coulomb_friction")}), registry());
  EXPECT_GE(whole.effects.back().ports.at(1), 0) << "friction opposes the rotation as a whole";
  const Model one = assemble(spherical({effect("coulomb_friction", {{"rate", "n_y"}, {"port", "moment_z"}})}), registry());
  EXPECT_EQ(one.effects.back().ports.at(1), -1);
  EXPECT_EQ(one.effects.back().quantities.at(1), -1);
}

TEST(Binding, UnitsOfParametersAreKnownBeforeAssembling) {
  const ModelRequest r =
      parachute(false, {effect("viscous_friction", {}, "bearing"), effect("viscous_friction", {}, "second"), effect("lag")});
  const auto units = parameter_units(r, registry());
  const Model m = assemble(r, registry());
  for (const auto& p : m.parameters) {
    if (p.curve >= 0) continue;
    EXPECT_EQ(units.at(p.name), p.unit) << p.name;
  }
  for (const auto& c : m.curves) EXPECT_EQ(units.at(c.name), c.unit) << c.name;
  EXPECT_EQ(units.at("bearing.viscosity"), "N m s/rad");
}

TEST(Binding, ASmoothingWidthIsFixedUnlessTheStudyFreesIt) {
  ModelRequest r = parachute(true, {effect("coulomb_friction")});
  const auto free = [&] {
    const Model m = assemble(r, registry());
    return m.parameters[static_cast<std::size_t>(m.find_parameter("width"))].free;
  };
  EXPECT_FALSE(free());
  r.parameters["width"].free = true;
  EXPECT_TRUE(free());
}

TEST(Binding, RolesTakeTheSystemsDefaults) {
  const Model m = assemble(cart({effect("viscous_friction"), effect("bias")}), registry());
  EXPECT_EQ(m.effects[0].quantities.front(), 1);  // v
  EXPECT_EQ(m.effects[0].ports.front(), 0);       // force
  EXPECT_EQ(m.effects[1].kind, PortKind::sensor);
  EXPECT_EQ(m.effects[1].ports.front(), 0);  // position_reading
}

TEST(Binding, AnOptionalConstantHasItsDefault) {
  const Model m = assemble(cart({}), registry());
  EXPECT_EQ(m.parameters[static_cast<std::size_t>(m.find_parameter("gain"))].value, 1.0);
}

TEST(Binding, SystemConstantsAreFixedAndEffectsCoefficientsFreeUnlessTheStudySaysOtherwise) {
  const Model m = assemble(parachute(true, {effect("lag")}), registry());
  for (const auto& p : m.parameters) EXPECT_EQ(p.free, m.find_parameter(p.name) >= 7) << p.name;
  ModelRequest r = parachute(true);
  r.parameters["m_a"] = {true, 0.3, 0.1, 0.5, 0.05, {}};
  const Model freed = assemble(r, registry());
  const Parameter& m_a = freed.parameters[static_cast<std::size_t>(freed.find_parameter("m_a"))];
  EXPECT_TRUE(m_a.free);
  EXPECT_EQ(m_a.value, 0.3);
  EXPECT_EQ(m_a.prior_mean, 0.3);
  EXPECT_EQ(m_a.prior_sigma, 0.05);
  EXPECT_EQ(m_a.lower, 0.1);
}

TEST(Binding, InputsThatNobodyReadsAreNotNeeded) {
  EXPECT_THAT(assemble(parachute(false), registry()).needed_inputs(), ElementsAre("phi", "phi_rate"));
  ModelRequest bare = parachute(false);
  bare.effects = {effect("static_moment"), effect("pitch_damping")};
  EXPECT_TRUE(assemble(bare, registry()).needed_inputs().empty());
}

TEST(Binding, CurvesWithoutKnotsAreListedWithTheirQuantity) {
  ModelRequest r = parachute(false);
  r.curves.clear();
  EXPECT_THAT(curves_without_knots(r, registry()), ElementsAre(std::pair<const std::string, std::string>("C_m", "alpha_T"),
                                                               std::pair<const std::string, std::string>("C_m_alphadot", "alpha_T")));
}

}  // namespace
}  // namespace misfit
