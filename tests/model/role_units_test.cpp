#include "misfit/model/role_units.h"

#include <gtest/gtest.h>

#include "misfit/core/error.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

const std::map<std::string, std::string> roles = {{"port", "N m"}, {"rate", "rad/s"},   {"level", "V"},    {"same", "N m"},
                                                  {"flat", "-"},   {"twice", "kg m^2"}, {"tight", "m2/s2"}};

TEST(RoleUnits, AUnitWithoutRolesStaysAsItIsWritten) {
  EXPECT_EQ(bind_unit("1/s", roles), "1/s");
  EXPECT_EQ(bind_unit("-", roles), "-");
}

TEST(RoleUnits, ARoleBecomesItsUnit) { EXPECT_EQ(bind_unit("{port}", roles), "N m"); }

TEST(RoleUnits, DividingByARoleTurnsEachOfItsFactors) { EXPECT_EQ(bind_unit("{port}/{rate}", roles), "N m s/rad"); }

TEST(RoleUnits, PowersOfTheSameSymbolAreAdded) {
  EXPECT_EQ(bind_unit("{twice} m", roles), "kg m^3");
  EXPECT_EQ(bind_unit("{port} s/{twice}", roles), "N s/m/kg");
  EXPECT_EQ(bind_unit("{tight} s", roles), "m^2/s");
}

TEST(RoleUnits, WhatCancelsIsLeftOut) {
  EXPECT_EQ(bind_unit("{port}/{same}", roles), "-");
  EXPECT_EQ(bind_unit("{flat}", roles), "-");
  EXPECT_EQ(bind_unit("{flat}/{level}", roles), "1/V");
}

TEST(RoleUnits, ARoleThatIsAbsentCountsAsANumber) { EXPECT_EQ(bind_unit("{missing} s", roles), "s"); }

TEST(RoleUnits, TheResultMeasuresWhatTheProductMeasures) {
  const Unit bound = parse_unit(bind_unit("{port}/{rate}", roles));
  EXPECT_TRUE(bound.same_dimension(parse_unit("kg m^2/s")));
  EXPECT_TRUE(parse_unit(bind_unit("{port}/{tight}", roles)).same_dimension(parse_unit("kg")));
}

TEST(RoleUnits, AnOpenBraceIsRefused) { EXPECT_THROW(static_cast<void>(bind_unit("{port", roles)), InputError); }

TEST(RoleUnits, ARoleMayHaveABrokenPower) {
  EXPECT_EQ(bind_unit("{root}/s", {{"root", "V^(1/2)"}}), "V^0.5/s");
  EXPECT_EQ(bind_unit("1/{root}", {{"root", "V^-0.5"}}), "V^0.5");
}

TEST(RoleUnits, ARoleIsRaisedToThePowerBehindIt) {
  EXPECT_EQ(bind_unit("{level}^0.5/s", roles), "V^0.5/s");
  EXPECT_EQ(bind_unit("1/{level}^(1/2)", roles), "1/V^0.5");
  EXPECT_EQ(bind_unit("{port}/{rate}^2 s", roles), "N m s^3/rad^2");
  EXPECT_EQ(bind_unit("{flat}^0.5", roles), "-");
  EXPECT_THROW(static_cast<void>(bind_unit("{level}^", roles)), InputError);
  EXPECT_THROW(static_cast<void>(bind_unit("{level}^(1/2", roles)), InputError);
}

}  // namespace
}  // namespace misfit
