// Every mistake of a request, with its place and the nearest name. What a right one becomes: binding_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/cases.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::AllOf;
using testing::HasSubstr;

std::string message_of(const ModelRequest& request) {
  try {
    static_cast<void>(assemble(request, registry()));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Assemble, ASystemThatIsNotKnownNamesTheNearest) {
  ModelRequest r = parachute(true);
  r.system = "parachute_plane";
  EXPECT_THAT(message_of(r),
              AllOf(HasSubstr("study.toml:4"), HasSubstr("unknown system 'parachute_plane'"), HasSubstr("'parachute_planar'")));
}

TEST(Assemble, AnOptionThatTheSystemLacksNamesTheNearest) {
  ModelRequest flag = parachute(true);
  flag.options.flags["induced_angel"] = true;
  EXPECT_THAT(message_of(flag), AllOf(HasSubstr("study.toml:4"), HasSubstr("no option 'induced_angel'"), HasSubstr("'induced_angle'")));
  ModelRequest number = parachute(true);
  number.options.numbers["step"] = 0.01;
  EXPECT_THAT(message_of(number), AllOf(HasSubstr("study.toml:4"), HasSubstr("no option 'step'")));
}

TEST(Assemble, AnEffectThatIsNotKnownNamesTheNearest) {
  EXPECT_THAT(message_of(parachute(true, {effect("columb_friction")})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("unknown effect 'columb_friction'"), HasSubstr("'coulomb_friction'")));
}

TEST(Assemble, ARoleThatTheEffectLacksNamesTheNearest) {
  EXPECT_THAT(message_of(parachute(true, {effect("viscous_friction", {{"rat", "pitch_rate"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("no role 'rat'"), HasSubstr("'rate'")));
}

TEST(Assemble, AQuantityThatTheSystemLacksNamesTheNearest) {
  EXPECT_THAT(message_of(parachute(true, {effect("viscous_friction", {{"rate", "pitchrate"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("no quantity 'pitchrate'"), HasSubstr("'pitch_rate'")));
}

TEST(Assemble, APortThatTheSystemLacksNamesTheNearest) {
  EXPECT_THAT(message_of(parachute(true, {effect("viscous_friction", {{"port", "pitching_momnt"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("no port 'pitching_momnt'"), HasSubstr("'pitching_moment'")));
}

TEST(Assemble, AnOptionalRoleThatTheStudyBindsMustExist) {
  EXPECT_THAT(message_of(parachute(true, {effect("coulomb_friction", {{"rate_lateral", "pitch_rat"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("no quantity 'pitch_rat'"), HasSubstr("'pitch_rate'")));
}

TEST(Assemble, AnInertiaThatFrictionNoLongerReadsIsToBeLeftOut) {
  EXPECT_THAT(message_of(parachute(true, {effect("coulomb_friction", {{"inertia", "inertia"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("no role 'inertia'"), HasSubstr("leave the role out")));
}

TEST(Assemble, UnitsOfRolesAndWhatTheyAreBoundToMustAgree) {
  EXPECT_THAT(message_of(parachute(true, {effect("coning", {{"inertia", "dynamic_pressure"}}, "again")})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("role 'inertia' needs [kg m^2]"), HasSubstr("'dynamic_pressure' has [Pa]")));
  EXPECT_THAT(message_of(cart({effect("dynamic_pressure_drift", {{"dynamic_pressure", "force"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("needs [Pa]"), HasSubstr("port 'force' has [N]")));
}

TEST(Assemble, AGeometryConstantThatIsMissingIsNamedWithWhatItIs) {
  ModelRequest r = parachute(true);
  r.constants.erase("m_a");
  EXPECT_THAT(message_of(r),
              AllOf(HasSubstr("study.toml:4"), HasSubstr("[geometry] m_a is missing"), HasSubstr("apparent mass"), HasSubstr("[kg]")));
}

TEST(Assemble, ANegativeMassIsRefusedWithItsBounds) {
  ModelRequest r = parachute(true);
  r.constants["m"] = -0.2;
  EXPECT_THAT(message_of(r), AllOf(HasSubstr("study.toml:12"), HasSubstr("m = -0.2"), HasSubstr("outside its bounds")));
  r.constants["m"] = std::nan("");
  EXPECT_THAT(message_of(r), HasSubstr("outside its bounds"));
}

TEST(Assemble, AnEffectThatNeedsAConstantOfAnotherSystemSaysWhich) {
  EXPECT_THAT(message_of(parachute(true, {effect("own_weight")})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("needs 'mass'"), HasSubstr("'parachute_planar' does not have")));
}

ModelRequest with_parameter(const std::string& name, const ParameterRequest& parameter) {
  ModelRequest r = parachute(true, {effect("periodic_forcing")});
  r.parameters[name] = parameter;
  r.parameters[name].where = {"study.toml", 50, 1};
  return r;
}

TEST(Assemble, AParameterOutsideItsBoundsIsRefused) {
  ParameterRequest p;
  p.value = 5e10;
  EXPECT_THAT(message_of(with_parameter("frequency", p)),
              AllOf(HasSubstr("study.toml:50"), HasSubstr("frequency = 5e+10 Hz"), HasSubstr("1e-09 Hz to 1e+09 Hz")));
}

TEST(Assemble, AStartOutsideTheStudysOwnBoundsIsRefused) {
  ParameterRequest p;
  p.lower = 2.0;
  p.upper = 3.0;
  EXPECT_THAT(message_of(with_parameter("frequency", p)), AllOf(HasSubstr("study.toml:50"), HasSubstr("outside its bounds")));
}

TEST(Assemble, ReversedBoundsAreRefused) {
  ParameterRequest p;
  p.lower = 3.0;
  p.upper = 2.0;
  EXPECT_THAT(message_of(with_parameter("frequency", p)),
              AllOf(HasSubstr("study.toml:50"), HasSubstr("bounds of frequency must increase")));
}

TEST(Assemble, AParameterThatTheModelLacksNamesTheNearest) {
  EXPECT_THAT(message_of(with_parameter("frequenzy", {})),
              AllOf(HasSubstr("study.toml:50"), HasSubstr("no parameter 'frequenzy'"), HasSubstr("'frequency'")));
}

ModelRequest with_curve(const std::string& name, const CurveRequest& curve) {
  ModelRequest r = parachute(true, {effect("bias")});
  r.curves[name] = curve;
  r.curves[name].where = {"study.toml", 60, 1};
  return r;
}

TEST(Assemble, ACurveThatTheModelLacksNamesTheNearest) {
  EXPECT_THAT(message_of(with_curve("C_mp", {"alpha_T", {0.1, 0.2}, {}, {}})),
              AllOf(HasSubstr("study.toml:60"), HasSubstr("no coefficient 'C_mp'"), HasSubstr("'C_m")));
}

TEST(Assemble, ACurveOfAQuantityThatIsNotKnownNamesTheNearest) {
  EXPECT_THAT(message_of(with_curve("C_m", {"alpha_t", {0.1, 0.2}, {}, {}})),
              AllOf(HasSubstr("study.toml:60"), HasSubstr("no quantity 'alpha_t'"), HasSubstr("'alpha_T'")));
  EXPECT_THAT(message_of(with_curve("offset", {"", {0.1, 0.2}, {}, {}})),
              AllOf(HasSubstr("study.toml:60"), HasSubstr("`of` must name a quantity")));
}

TEST(Assemble, ACurveWithoutAQuantityIsOneOfThatOfItsSpecification) {
  const Model model = assemble(with_curve("C_m", {"", {0.1, 0.2}, 3.0, {}}), registry());
  ASSERT_NE(model.find_curve("C_m"), nullptr);
  EXPECT_EQ(model.find_curve("C_m")->of, "alpha_T");
  EXPECT_EQ(model.find_curve("C_m")->roughness, 3.0);
}

TEST(Assemble, KnotsThatDoNotIncreaseAreRefused) {
  EXPECT_THAT(message_of(with_curve("C_m", {"alpha_T", {0.1, 0.3, 0.2}, {}, {}})),
              AllOf(HasSubstr("study.toml:60"), HasSubstr("curve C_m"), HasSubstr("increase")));
  EXPECT_THAT(message_of(with_curve("C_m", {"alpha_T", {0.1}, {}, {}})),
              AllOf(HasSubstr("study.toml:60"), HasSubstr("at least two knots")));
}

TEST(Assemble, ANumberWhereOnlyACurveIsRegularIsRefused) {
  ModelRequest r = parachute(true);
  r.curves.erase("C_m");
  r.parameters["C_m"].value = 0.01;
  EXPECT_THAT(message_of(r), AllOf(HasSubstr("study.toml:30"), HasSubstr("C_m must be a curve"), HasSubstr("[curves] C_m")));
}

/// As discovery asks for it: what the formula reads, C_m/sin(alpha_T). Where alpha_T carries its sign it would be a constant moment.
TEST(Assemble, ANumberOverASineIsTakenOfAnEffectThatNoFileHas) {
  for (const bool induced : {true, false}) {
    ModelRequest r = parachute(induced);
    r.curves.erase("C_m");
    r.effects.front().where = {};
    r.parameters["static_moment.C_m"].value = 0.01;
    if (!induced) {
      EXPECT_THAT(message_of(r), HasSubstr("C_m must be a curve"));
      continue;
    }
    const Model m = assemble(r, registry());
    EXPECT_EQ(m.find_curve("C_m"), nullptr);
    ASSERT_GE(m.find_parameter("C_m"), 0);
    EXPECT_EQ(m.parameters[static_cast<std::size_t>(m.find_parameter("C_m"))].value, 0.01);
  }
}

TEST(Assemble, BoundsAloneDoNotTurnADefaultCurveIntoANumber) {
  ModelRequest r = parachute(true);
  r.parameters["C_m"].lower = -0.2;
  r.parameters["C_m"].upper = 0.2;
  r.parameters["C_m"].sigma = 0.05;
  const Model m = assemble(r, registry());
  const Curve* curve = m.find_curve("C_m");
  ASSERT_NE(curve, nullptr);
  for (int i = 0; i < curve->spline.size(); ++i) {
    const Parameter& p = m.parameters[static_cast<std::size_t>(curve->first + i)];
    EXPECT_EQ(p.lower, -0.2);
    EXPECT_EQ(p.upper, 0.2);
    EXPECT_EQ(p.prior_sigma, 0.05);
    EXPECT_TRUE(p.free);
  }
  r.parameters["C_m"].upper = -0.3;
  EXPECT_THAT(message_of(r), HasSubstr("bounds of C_m must increase"));
}

TEST(Assemble, TooManyStatesAreRefusedWithTheLimit) {
  std::vector<EffectRequest> lags;
  for (int i = 0; i < kMaxStates - 1; ++i) lags.push_back(effect("lag", {}, "lag_" + std::to_string(i)));
  EXPECT_THAT(message_of(parachute(true, lags)), AllOf(HasSubstr("study.toml:4"), HasSubstr("81 states"), HasSubstr("at most 80")));
  lags.pop_back();
  EXPECT_EQ(assemble(parachute(true, lags), registry()).states(), kMaxStates);
}

TEST(Assemble, TooManyFreeParametersAreRefusedWithTheLimit) {
  ModelRequest r = parachute(true);
  r.curves["C_m"].knots.clear();
  for (int i = 1; i <= 300; ++i) r.curves["C_m"].knots.push_back(0.001 * i);
  EXPECT_THAT(message_of(r), AllOf(HasSubstr("free parameters"), HasSubstr("at most 256")));
}

TEST(Assemble, TwoEffectsOfOneNameAreRefused) {
  EXPECT_THAT(message_of(parachute(true, {effect("lag"), effect("lag")})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("'lag' is named twice")));
}

TEST(Assemble, AnEffectOnAQuantityCannotReadWhatDependsOnIt) {
  EXPECT_THAT(message_of(parachute(true, {effect("inertia_swell", {{"eta", "alpha_T"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("changes a quantity"), HasSubstr("'alpha_T'")));
  ModelRequest curve = parachute(true, {effect("inertia_swell")});
  curve.curves["swell"] = {"alpha_T", {0.1, 0.2}, {}, {"study.toml", 61, 1}};
  EXPECT_THAT(message_of(curve), AllOf(HasSubstr("study.toml:61"), HasSubstr("changes a quantity")));
}

TEST(Assemble, AForceCannotReadAPredictedOutput) {
  EXPECT_THAT(message_of(cart({effect("lag", {{"level", "position_reading"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("predicted output 'position_reading'"), HasSubstr("only effects on sensors")));
}

TEST(Assemble, AnEffectCannotActOnPortsOfDifferentKinds) {
  EXPECT_THAT(message_of(cart({effect("own_weight", {{"also", "speed_reading"}})})),
              AllOf(HasSubstr("study.toml:30"), HasSubstr("'speed_reading'"), HasSubstr("different kinds")));
}

TEST(Assemble, FreesNoConstantThatNobodyAskedFor) {
  for (const auto& request : {parachute(true), parachute(false), spherical(), cart({})}) {
    const Model model = assemble(request, registry());
    for (std::size_t k = 0; k < model.system->spec().constants.size(); ++k)
      EXPECT_FALSE(model.parameters[k].free) << request.system << ' ' << model.parameters[k].name;
  }
}

}  // namespace
}  // namespace misfit
