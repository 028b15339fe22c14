#include "misfit/discover/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

std::vector<Roles> places(const std::string& effect, const std::string& system) {
  return places_of(registry().effect(effect).spec(), registry().system(system).make({})->spec());
}

TEST(Places, ALevelEffectHasOnePerPortThatALevelDrives) {
  EXPECT_THAT(places("overflow", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"level", "x1"}, {"port", "dx1/dt"}}, Roles{{"level", "x2"}, {"port", "dx2/dt"}}));
}

TEST(Places, WhatSpillsGoesToEachOtherPort) {
  EXPECT_THAT(places("overflow_into", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"level", "x1"}, {"to_port", "dx2/dt"}}, Roles{{"level", "x2"}, {"to_port", "dx1/dt"}}));
}

TEST(Places, AMotionHasItsRateAndWhatThatIsTheRateOf) {
  EXPECT_THAT(places("quadratic_drag", "test_oscillator"), ElementsAre(Roles{}, Roles{{"port", "force"}, {"rate", "v"}}));
  EXPECT_THAT(places("cubic_stiffness", "test_oscillator"), ElementsAre(Roles{}, Roles{{"displacement", "x"}, {"port", "force"}}));
  EXPECT_THAT(places("cubic_stiffness", "test_tanks"), ElementsAre(Roles{})) << "a tank has no displacement";
}

TEST(Places, SensorsAndInputsAreTriedWhereTheSystemHasADefaultForThem) {
  EXPECT_THAT(places("sensor_scale", "test_tanks"), ElementsAre(Roles{}, Roles{{"output", "y1"}}, Roles{{"output", "y2"}}));
  EXPECT_THAT(places("input_gain", "test_tanks"),
              ElementsAre(Roles{}, Roles{{"input", "u"}, {"port", "dx1/dt"}}, Roles{{"input", "u"}, {"port", "dx2/dt"}}));
  EXPECT_THAT(places("sensor_scale", "parachute_spherical"), ElementsAre(Roles{}));
  EXPECT_THAT(places("quadratic_drag", "parachute_spherical"), ElementsAre(Roles{})) << "its own default stays the only one";
}

TEST(Places, ASystemsOwnEffectHasItsOwnPlaceAlone) { EXPECT_THAT(places("strut_wake", "parachute_spherical"), ElementsAre(Roles{})); }

}  // namespace
}  // namespace misfit
