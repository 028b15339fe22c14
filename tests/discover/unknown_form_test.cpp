// Which effects add a force or an error of unknown form to the model, and where.

#include "misfit/discover/unknown_form.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::ElementsAre;
using testing::IsEmpty;

UnknownCurve curve(const std::string& port, const std::string& quantity, double log_p, PortKind kind = PortKind::dynamic) {
  UnknownCurve out;
  out.port = port;
  out.quantity = quantity;
  out.log_p = log_p;
  out.kind = kind;
  return out;
}

/// "unknown_force of x1 on dx2/dt"
std::vector<std::string> effects(const UnknownCurve& unexplained) {
  const std::vector<UnknownCurve> screened = {curve("dx1/dt", "x1", -90.0),
                                              curve("dx2/dt", "x1", -20.0),
                                              curve("dx2/dt", "x2", -50.0),
                                              curve("dx2/dt", "t", -70.0),
                                              curve("y", "x1", -60.0, PortKind::sensor),
                                              curve("y", "x2", -10.0, PortKind::sensor)};
  std::vector<std::string> out;
  for (const EffectPlace& place :
       effects_of_unknown_form(unexplained, screened, registry().system("test_tanks").make({})->spec(), registry()))
    out.push_back(effect_at(place.effect, place.roles));
  return out;
}

TEST(EffectsOfUnknownForm, OfAForceIsTheCurveOfItsQuantityOnItsPort) {
  EXPECT_THAT(effects(curve("dx2/dt", "x1", -30.0)), ElementsAre("unknown_force (of = x1, port = dx2/dt)"));
}

TEST(EffectsOfUnknownForm, OfAnErrorIsThatOfItsOutput) {
  EXPECT_THAT(effects(curve("y", "x2", -30.0, PortKind::sensor)), ElementsAre("unknown_error (of = x2, output = y)"));
}

TEST(EffectsOfUnknownForm, OfASurfaceAreTheCurvesOfBothQuantitiesTheStrongerFirst) {
  UnknownCurve surface = curve("dx2/dt", "x1", -80.0);
  surface.other = "x2";
  EXPECT_THAT(effects(surface), ElementsAre("unknown_force (of = x2, port = dx2/dt)", "unknown_force (of = x1, port = dx2/dt)"));
}

TEST(EffectsOfUnknownForm, ThereIsNoneOfTimeNorOfTheFormOfAMemory) {
  EXPECT_THAT(effects(curve("dx2/dt", "t", -30.0)), IsEmpty());
  UnknownCurve memory = curve("dx2/dt", "x1", -30.0);
  memory.memory = "another dependence of its own state";
  EXPECT_THAT(effects(memory), IsEmpty());
}

}  // namespace
}  // namespace misfit
