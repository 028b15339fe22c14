#include "misfit/discover/leaving.h"

#include <gtest/gtest.h>

#include "misfit/math/statistics.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Viscous friction acts on the cart, dry friction does not: both are in the model.
struct WithNeedlessFriction {
  ModelRequest request = cart({effect("viscous_friction"), effect("coulomb_friction")});
  std::vector<Signals> signals = {record_of_cart({}, {})};
  FilterEstimate estimate;

  WithNeedlessFriction() {
    request.parameters["stiffness"].free = true;
    estimate = estimate_filter(assemble(request, registry()), {}, signals);
  }
  [[nodiscard]] std::optional<Without> without(const std::string& name) const {
    return without_effect({estimate, request, registry(), signals}, name, 1);
  }
};

const WithNeedlessFriction& fitted() {
  static const WithNeedlessFriction out;
  return out;
}

TEST(WithoutAnEffect, WhatIsNotThereMayGo) {
  ASSERT_TRUE(fitted().estimate.converged);
  EXPECT_TRUE(may_leave(fitted().estimate, "coulomb_friction"));
  const auto without = fitted().without("coulomb_friction");
  ASSERT_TRUE(without);
  EXPECT_GT(without->drop, -0.1) << "a larger model is not worse, but for what a search leaves";
  EXPECT_LT(without->drop, 15.0) << "a friction that is not there";
  EXPECT_GE(without->parameters, 1);
  EXPECT_EQ(without->estimate.model.find_parameter("friction"), -1);
  EXPECT_EQ(without->request.effects.size(), 1U);
  EXPECT_NEAR(without->p_value, chi_square_tail(std::max(without->drop, 0.0), without->parameters), 1e-12);
}

/// `start = { ... }` of an effect's line names its coefficients behind its own name.
TEST(WithoutAnEffect, WhatItsLineSaysGoesWithIt) {
  WithNeedlessFriction started = fitted();
  started.request.parameters["coulomb_friction.friction"].value = 0.01;
  started.request.parameters["viscous_friction.viscosity"].value = 0.1;
  static_cast<void>(assemble(started.request, registry()));
  const auto without = started.without("coulomb_friction");
  ASSERT_TRUE(without);
  EXPECT_EQ(without->request.parameters.count("coulomb_friction.friction"), 0U);
  EXPECT_EQ(without->request.parameters.count("viscous_friction.viscosity"), 1U);
}

/// A bare name that two effects have is that of the first: without it, it would become that of the other one.
TEST(WithoutAnEffect, WhatIsCalledByItsBareNameGoesWithIt) {
  EffectRequest another = effect("coulomb_friction");
  another.name = "another";
  ModelRequest request = cart({effect("viscous_friction"), effect("coulomb_friction"), another});
  request.parameters["stiffness"].free = true;
  request.parameters["width"].value = 0.4;
  request.parameters["another.width"].value = 0.05;
  const std::vector<Signals> signals = {record_of_cart({}, {})};
  const FilterEstimate estimate = estimate_filter(assemble(request, registry()), {}, signals);
  const auto first = without_effect({estimate, request, registry(), signals}, "coulomb_friction", 1);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->request.parameters.count("width"), 0U);
  const int left = first->estimate.model.find_parameter("width");
  ASSERT_GE(left, 0);
  EXPECT_EQ(first->estimate.model.parameters[left].value, 0.05);
  const auto second = without_effect({estimate, request, registry(), signals}, "another", 1);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->request.parameters.count("width"), 1U);
}

TEST(WithoutAnEffect, WhatIsNeededStays) {
  EXPECT_FALSE(may_leave(fitted().estimate, "viscous_friction"));
  const auto without = fitted().without("viscous_friction");
  ASSERT_TRUE(without);
  EXPECT_GT(without->drop, 100.0);
  EXPECT_LT(without->p_value, 1e-12);
}

TEST(WithoutAnEffect, ADropMayBeChanceUpToThePercentileOfChiSquare) {
  EXPECT_TRUE(may_be_chance(6.6, 1, 1.0)) << "99 %: 6.635";
  EXPECT_FALSE(may_be_chance(6.7, 1, 1.0));
  EXPECT_TRUE(may_be_chance(6.7, 2, 1.0)) << "99 %: 9.210";
  EXPECT_TRUE(may_be_chance(-1.0, 1, 1.0));
  EXPECT_TRUE(may_be_chance(13.0, 1, 40.0)) << "1 - 0.99^(1/40) = 2.51e-4: 13.4";
  EXPECT_FALSE(may_be_chance(13.5, 1, 40.0));
}

TEST(WithoutAnEffect, AnEffectThatIsNotInTheModelCannotGo) {
  EXPECT_FALSE(fitted().without("quadratic_drag"));
  EXPECT_FALSE(may_leave(fitted().estimate, "quadratic_drag"));
}

/// Dry friction over a width of 0.1 m/s acts, and is in the model over `fixed`.
std::optional<FreedWidth> width_found(double fixed) {
  ModelRequest request = cart({effect("viscous_friction"), effect("coulomb_friction")});
  request.parameters["stiffness"].free = true;
  request.parameters["width"].value = fixed;
  const std::vector<Signals> signals = {record_of_cart({effect("coulomb_friction")}, {{"friction", 1.5}, {"width", 0.1}})};
  const FilterEstimate estimate = estimate_filter(assemble(request, registry()), {}, signals);
  return freed_width(estimate, signals, "coulomb_friction", 1);
}

TEST(AFixedWidth, ThatIsNotTheRightOneIsFound) {
  const auto wide = width_found(0.4);
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->coefficient, "width");
  EXPECT_NEAR(wide->value, 0.1, 0.04);
  EXPECT_FALSE(may_be_chance(wide->drop, 1, 40.0)) << wide->drop;
}

TEST(AFixedWidth, ThatIsRightGainsNothing) {
  const auto right = width_found(0.1);
  if (right) {
    EXPECT_TRUE(may_be_chance(right->drop, 1, 40.0)) << right->drop;
  }
}

TEST(AFixedWidth, IsOneOfTheEffectThatIsAskedFor) {
  EXPECT_FALSE(freed_width(fitted().estimate, fitted().signals, "viscous_friction", 1)) << "it has none";
}

}  // namespace
}  // namespace misfit
