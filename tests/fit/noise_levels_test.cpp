// Outputs that no value of the model's parameter explains together: the likelihood has a maximum for each that it could follow best.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/fit/decay.h"

namespace misfit {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::string seen_twice = testing_decay::decay_text + "z = { unit = \"V\", formula = \"x\", noise = 0.01 }\n";

/// Rates and noise of two sensors that should show one decay.
struct TwoSensors {
  double rate_of_y = 1.0, rate_of_z = 1.0, noise_of_y = 0.01, noise_of_z = 0.01;
};

Signals record(const TwoSensors& truth, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "decay";
  s.measured = {{"y", "V", {}, 0.0}, {"z", "V", {}, 0.0}};
  constexpr std::size_t samples = 100;
  for (std::size_t i = 0; i < samples; ++i) {
    s.t.push_back(testing_decay::duration * static_cast<double>(i) / static_cast<double>(samples));
    s.measured[0].values.push_back(std::exp(-truth.rate_of_y * s.t.back()) + truth.noise_of_y * normal(random));
    s.measured[1].values.push_back(std::exp(-truth.rate_of_z * s.t.back()) + truth.noise_of_z * normal(random));
  }
  return s;
}

/// Fitted from these standard deviations of the noise.
FittedModel fitted(const Signals& signals, double noise_of_y, double noise_of_z) {
  const auto known = testing_decay::registry_with(seen_twice);
  ModelRequest request = testing_decay::request_of("text");
  request.noise["y"] = {noise_of_y, false, {}};
  request.noise["z"] = {noise_of_z, false, {}};
  const Model model = assemble(request, *known);
  return output_error(trajectory_start(model, {signals}).from, {signals});
}

/// Of filter_error, from these factors of the usual noise.
FilterEstimate filtered(const Signals& signals, double noise_of_y, double noise_of_z) {
  const auto known = testing_decay::registry_with(seen_twice);
  const Model model = assemble(testing_decay::request_of("text"), *known);
  FilterOptions options;
  options.noise_factors = {noise_of_y, noise_of_z, 1.0};
  return estimate_filter(model, {}, {signals}, options);
}

double rate(const FittedModel& fit) { return fit.fit.parameters.at("a").value; }

TEST(NoiseLevels, TheOutputThatIsFollowedDoesNotHangOnTheFirstNoise) {
  const Signals signals = record({.rate_of_y = 1.0, .rate_of_z = 1.3, .noise_of_y = 0.02, .noise_of_z = 0.002}, 3);
  const FittedModel of_z = fitted(signals, 0.5, 0.0005), of_y = fitted(signals, 0.0005, 0.5);
  ASSERT_EQ(of_z.fit.status, FitStatus::converged) << of_z.fit.message;
  ASSERT_EQ(of_y.fit.status, FitStatus::converged) << of_y.fit.message;
  EXPECT_NEAR(rate(of_z), 1.3, 0.01) << "z is the more precise: with it the likelihood is higher";
  EXPECT_NEAR(rate(of_y), rate(of_z), 1e-4);
  EXPECT_NEAR(*of_y.fit.loglik, *of_z.fit.loglik, 1e-3);
  EXPECT_THAT(of_y.fit.warnings, Not(Contains(HasSubstr("another maximum")))) << "the other is lower by hundreds";
}

TEST(NoiseLevels, NorInTheFilter) {
  const Signals signals = record({.rate_of_y = 1.0, .rate_of_z = 1.3, .noise_of_y = 0.02, .noise_of_z = 0.002}, 3);
  const FilterEstimate of_z = filtered(signals, 10.0, 0.1), of_y = filtered(signals, 0.1, 10.0);
  EXPECT_TRUE(of_z.converged) << of_z.message;
  EXPECT_TRUE(of_y.converged) << of_y.message;
  EXPECT_NEAR(of_y.model.parameters[0].value, 1.3, 0.02);
  EXPECT_NEAR(of_z.model.parameters[0].value, 1.3, 0.02);
  constexpr double of_coloured_noise = 3.0;  // what is left of y is no white noise: its spectrum has maxima of its own, 2 apart
  EXPECT_NEAR(of_y.objective, of_z.objective, of_coloured_noise) << "that which follows y is lower by hundreds";
}

TEST(NoiseLevels, AMaximumNearlyAsHighIsNamedWithItsNoise) {
  const FittedModel fit = fitted(record({.rate_of_y = 1.0, .rate_of_z = 1.3, .noise_of_z = 0.0085}, 4), 0.01, 0.01);
  ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
  EXPECT_THAT(fit.fit.warnings, Contains(HasSubstr("another maximum, lower by")));
}

TEST(NoiseLevels, OfOutputsThatAgreeNothingIsSaid) {
  const Signals signals = record({}, 5);
  const FittedModel fit = fitted(signals, 0.01, 0.01), from_elsewhere = fitted(signals, 0.3, 0.001);
  ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
  EXPECT_THAT(fit.fit.warnings, Not(Contains(HasSubstr("another maximum"))));
  EXPECT_NEAR(rate(from_elsewhere), rate(fit), 1e-4);
}

}  // namespace
}  // namespace misfit
