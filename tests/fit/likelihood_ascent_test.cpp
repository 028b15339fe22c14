// Steps where derivatives do not lead: a shape is not determined, or the objective has a kink.
#include "misfit/fit/filter/likelihood_ascent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/fit/trajectory_start.h"
#include "tests/fit/decay.h"
#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;

double at(const LikelihoodAscent& ascent, const std::string& name) {
  const Model& model = ascent.out.model;
  return ascent.values()[static_cast<std::size_t>(model.find_parameter(name))];
}

/// Of an effect that is off the data say nothing of the time constant.
TEST(GaussNewtonStep, LeavesATimeConstantWhereItIsWhileItsEffectIsOff) {
  constexpr double tau = 0.06;
  const std::vector<Signals> flights = {fly(12.0, 73, {effect("aerodynamic_lag")}, {{"C_lag", 0.5}, {"tau_lag", tau}})};
  ModelRequest request = request_for(flights);
  request.effects.push_back(effect("aerodynamic_lag"));
  Model model = assemble(request, registry());
  set(model, "tau_lag", tau);
  const Model start = trajectory_start_as_given(model, flights)->from.model;
  LikelihoodAscent ascent(start, curve_penalties(start), flights, {});
  ASSERT_TRUE(ascent.linearise());
  ASSERT_EQ(at(ascent, "C_lag"), 0.0);
  const double before = ascent.objective;
  ascent.gauss_newton_step();
  EXPECT_GT(ascent.objective, before + 1.0);
  EXPECT_NEAR(at(ascent, "tau_lag"), tau, 1e-9);
  EXPECT_NE(at(ascent, "C_lag"), 0.0);
}

/// Of one that is nearly off they say little, and what they say is far from linear.
TEST(GaussNewtonStep, RisesFromANearlyVanishingStrength) {
  const std::vector<Signals> flights = {fly(12.0, 73, {effect("aerodynamic_lag")}, {{"C_lag", 0.5}, {"tau_lag", 0.06}})};
  ModelRequest request = request_for(flights);
  request.effects.push_back(effect("aerodynamic_lag"));
  Model model = assemble(request, registry());
  for (const double strength : {-0.01, -0.001, 0.001, 0.01}) {
    set(model, "C_lag", strength);
    const Model start = trajectory_start_as_given(model, flights)->from.model;
    LikelihoodAscent ascent(start, curve_penalties(start), flights, {});
    ASSERT_TRUE(ascent.linearise());
    const double before = ascent.objective;
    ascent.gauss_newton_step();
    EXPECT_GT(ascent.objective, before + 1.0) << strength;
  }
}

TEST(AxisStep, RisesTowardsAMaximumAndNotFromIt) {
  const auto known = testing_decay::registry_with(testing_decay::decay_text);
  const Model model = assemble(testing_decay::request_of("text"), *known);
  const std::vector<Signals> experiments{testing_decay::decay(200, 5)};
  LikelihoodAscent ascent(trajectory_start(model, experiments).from.model, {}, experiments, {});
  ASSERT_TRUE(ascent.linearise());
  ascent.iterate(25, 1e-6);
  const Eigen::VectorXd maximum = ascent.joint(), slope = Eigen::VectorXd::Zero(maximum.size() - 1);
  Eigen::VectorXd variances = Eigen::VectorXd::Constant(maximum.size(), 1e-12);  // the noise stays
  variances[0] = ascent.out.covariance(0, 0);
  const Eigen::MatrixXd covariance = variances.asDiagonal();
  EXPECT_FALSE(ascent.axis_step(covariance, slope));
  EXPECT_EQ(ascent.joint(), maximum);
  const double highest = ascent.objective;
  ASSERT_TRUE(ascent.move_to(maximum.head(1).array() + 2.0 * std::sqrt(variances[0]), ascent.out.noise_fit.logs));
  const double before = ascent.objective;
  const std::optional<double> gained = ascent.axis_step(covariance, slope);
  ASSERT_TRUE(gained);
  EXPECT_NEAR(ascent.objective - before, *gained, 1e-9);
  EXPECT_NEAR(*gained, 1.5, 0.2);  // from two sigmas to one: (4 - 1)/2 of a parabola
  EXPECT_LT(ascent.objective, highest);
}

}  // namespace
}  // namespace misfit
