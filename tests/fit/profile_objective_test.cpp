#include "misfit/fit/profile_objective.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "misfit/core/error.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/inference/curves.h"
#include "tests/fit/cart_filter.h"
#include "tests/fit/decay.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

/// The validation motion with a line of its own added to the model: a parameter whose profile can be taken.
struct Fitted {
  std::vector<Signals> experiments;
  FittedMethod method;
  Fit fit;
};

Fitted fitted(bool coloured) {
  Fitted out;
  Signals signals = testing_planar::validation_signals("alpha_T_true");
  constexpr std::size_t samples = 1200;
  signals.t.resize(samples);
  for (auto& s : signals.measured) s.values.resize(samples);
  for (auto& s : signals.inputs) s.values.resize(samples);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.1 * testing_planar::degree);
  double memory = 0.0;
  for (double& v : signals.measured.front().values) {
    memory = 0.7 * memory + normal(random);
    v += coloured ? memory : normal(random);
  }
  out.experiments = {signals};
  ModelRequest request = testing_planar::eq_8({"static_moment", "pitch_damping", "periodic_forcing"});
  request.curves.clear();
  request.parameters["frequency"].value = 1.3;
  request.parameters["frequency"].free = false;
  choose_all_knots(request, testing_planar::registry(), out.experiments, 8);
  const Model model = assemble(request, testing_planar::registry());
  FittedModel fit = output_error(equation_error(model, out.experiments), out.experiments);
  out.fit = fit.fit;
  out.method = {"output_error", std::move(fit), {}, {}, {}};
  return out;
}

TEST(ProfileObjective, OutputErrorDropsByTheSquareOfItsPlainSigmas) {
  const Fitted f = fitted(false);
  ASSERT_EQ(f.fit.status, FitStatus::converged) << f.fit.message;
  ProfileObjective held(f.method, f.experiments, "cosine");
  const double best = f.fit.parameters.at("cosine").value, sigma = f.fit.plain_sigmas.at("cosine");
  const std::optional<double> at_best = held(best), beside = held(best + 2.0 * sigma);
  ASSERT_TRUE(at_best && beside);
  EXPECT_NEAR(2.0 * (*at_best - *beside), 4.0, 0.4);
}

/// The cart on its spring, as filter_error leaves it.
FittedMethod filtered(const testing_cart::Cart& cart, FilterEstimate& estimate, const std::vector<KnownNoise>& noise = {}) {
  Model start = assemble(testing_models::cart({}), testing_models::registry());
  if (!noise.empty()) start.known_noise = noise;
  start.parameters[static_cast<std::size_t>(start.find_parameter("stiffness"))].free = true;
  estimate = estimate_filter(start, curve_penalties(start), {cart.signals});
  FittedMethod out{"filter_error", {{}, estimate.model, estimate.penalties, {}}, estimate.noise, estimate.reference, {}};
  out.use.emplace();
  for (const auto& data : estimate.data) out.use->push_back(data.use);
  return out;
}

TEST(ProfileObjective, FilterErrorDropsByTheSquareOfItsSigma) {
  const testing_cart::Cart cart(600);
  FilterEstimate estimate;
  const FittedMethod method = filtered(cart, estimate);
  ASSERT_TRUE(estimate.converged) << estimate.message;
  const std::vector<Signals> experiments{cart.signals};
  ProfileObjective held(method, experiments, "stiffness");
  const double best = estimate.model.parameters[static_cast<std::size_t>(estimate.model.find_parameter("stiffness"))].value;
  const double sigma = std::sqrt(estimate.covariance(0, 0));
  const std::optional<double> at_best = held(best), beside = held(best + 2.0 * sigma);
  ASSERT_TRUE(at_best && beside);
  EXPECT_NEAR(2.0 * (*at_best - *beside), 4.0, 0.8);
}

/// Elsewhere by the typical size of every parameter, or by a line over the curve's knots.
std::vector<double> moved(const Model& model, double by) {
  std::vector<double> values = model.values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& p = model.parameters[i];
    const double scale = p.curve >= 0 ? model.curves[static_cast<std::size_t>(p.curve)].scale : p.scale;
    if (p.free) values[i] = std::clamp(values[i] + by * scale, p.lower, p.upper);
  }
  return values;
}

TEST(MaximumFrom, ElsewhereOutputErrorComesBackToTheFit) {
  const Fitted f = fitted(false);
  const Maximisation near = maximise_near(f.method, f.experiments);
  ASSERT_TRUE(near.objective) << near.why;
  for (const double by : {-0.5, 0.5}) {
    const Maximisation there = maximise_from(f.method, {moved(f.method.fitted.model, by)}, f.experiments);
    ASSERT_TRUE(there.objective) << there.why;
    EXPECT_NEAR(*there.objective, *near.objective, 0.05) << by;
  }
}

/// With the measurement noise that was put in: estimated, its resonance has a maximum on every chance line of white noise.
TEST(MaximumFrom, ElsewhereFilterErrorComesBackToTheFit) {
  const testing_cart::Cart cart(600);
  FilterEstimate estimate;
  const FittedMethod method = filtered(cart, estimate, {{0.05, true}, {0.08, true}});
  const Maximisation near = maximise_near(method, {cart.signals});
  ASSERT_TRUE(near.objective) << near.why;
  EXPECT_NEAR(*near.objective, estimate.objective, 0.05);
  for (const double by : {-0.5, 1.0}) {
    const Maximisation there = maximise_from(method, {moved(method.fitted.model, by)}, {cart.signals});
    ASSERT_TRUE(there.objective) << there.why;
    EXPECT_NEAR(*there.objective, *near.objective, 0.05) << by;
  }
}

TEST(MaximumFrom, WhatCannotBeRunSaysWhy) {
  const Fitted f = fitted(false);
  const Maximisation there = maximise_from(f.method, {std::vector<double>(f.method.fitted.model.parameters.size(), 0.0)}, f.experiments);
  EXPECT_FALSE(there.objective);
  EXPECT_FALSE(there.why.empty());
}

TEST(ProfileObjective, RefitsOfTheSameDataStayWhereTheFitWas) {
  const Fitted f = fitted(false);
  const Fit again = fit_again(f.method, f.experiments);
  ASSERT_EQ(again.status, FitStatus::converged) << again.message;
  EXPECT_NEAR(again.parameters.at("cosine").value, f.fit.parameters.at("cosine").value, 0.02 * f.fit.parameters.at("cosine").sigma);
  EXPECT_LT(again.linearisations, f.fit.linearisations);
}

TEST(OutputErrorSigmas, AllowForColouredResiduals) {
  const Fitted f = fitted(true);
  ASSERT_EQ(f.fit.status, FitStatus::converged) << f.fit.message;
  // A first-order process of 0.7 at 60 Hz is flat up to a few Hz: (1 + 0.7)/(1 − 0.7) times the variance of white noise of its size.
  const double ratio = f.fit.parameters.at("cosine").sigma / f.fit.plain_sigmas.at("cosine");
  EXPECT_NEAR(ratio, std::sqrt(1.7 / 0.3), 0.5);
  EXPECT_THAT(f.fit.facts.at("covariance"), testing::HasSubstr("autocorrelated residuals"));
  EXPECT_GT(f.fit.trim->sigma, 1.2 * f.fit.plain_sigmas.at("trim"));
}

TEST(OutputErrorSigmas, OfWhiteResidualsAreNearlyThePlainOnes) {
  const Fitted f = fitted(false);
  for (const auto& [name, plain] : f.fit.plain_sigmas) {
    if (name == "trim" || !(plain > 0.0)) continue;
    EXPECT_NEAR(f.fit.parameters.at(name).sigma / plain, 1.0, 0.25) << name;
  }
}

TEST(ProfileObjective, OfTheOnlyFreeParameterOfOutputErrorIsThatOfTheInitialStateAndTheNoise) {
  const auto known = testing_decay::registry_with(testing_decay::decay_text);
  const std::vector<Signals> experiments{testing_decay::decay(300, 4)};
  const Model model = assemble(testing_decay::request_of("text"), *known);
  FittedModel fit = output_error(equation_error(model, experiments), experiments);
  ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
  const double best = fit.fit.parameters.at("a").value, sigma = fit.fit.plain_sigmas.at("a");
  ProfileObjective held({"output_error", std::move(fit), {}, {}, {}}, experiments, "a");
  const std::optional<double> at_best = held(best), beside = held(best + 2.0 * sigma);
  ASSERT_TRUE(at_best && beside);
  EXPECT_NEAR(2.0 * (*at_best - *beside), 4.0, 0.2);
}

TEST(ProfileObjective, WrongNamesAndMethodsAreSaid) {
  const Fitted f = fitted(false);
  EXPECT_THROW(ProfileObjective(f.method, f.experiments, "cosin"), InputError);
  EXPECT_THROW(ProfileObjective(f.method, f.experiments, "C_m[2]"), InputError);
  FittedMethod regression = f.method;
  regression.method = "equation_error";
  EXPECT_THROW(ProfileObjective(regression, f.experiments, "cosine"), InputError);
}

}  // namespace
}  // namespace misfit
