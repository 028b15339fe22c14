// What is known of the measurement noise: held, or where its estimation starts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/methods.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/fit/decay.h"
#include "tests/fit/first_order.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_decay;

Fit fitted(bool filter, std::size_t samples, std::optional<KnownNoise> known) {
  const auto registry = registry_with(decay_text);
  Model model = assemble(request_of("text"), *registry);
  if (known) model.known_noise = {*known};
  const std::vector<Signals> experiments{decay(samples, 5)};
  const TrajectoryStart start = trajectory_start(model, experiments);
  OutputErrorStart options;
  options.from_regression = start.regressed;
  FilterOptions one;
  one.threads = 1;
  return filter ? filter_error(start.from, experiments, one).fit : output_error(start.from, experiments, options).fit;
}

class KnownNoiseOfAnOutput : public testing::TestWithParam<bool> {};

TEST_P(KnownNoiseOfAnOutput, IsHeldAndScalesTheStandardErrors) {
  constexpr std::size_t samples = 600;
  const Fit estimated = fitted(GetParam(), samples, {}), held = fitted(GetParam(), samples, KnownNoise{3.0 * noise, true});
  ASSERT_EQ(held.status, FitStatus::converged) << held.message;
  EXPECT_DOUBLE_EQ(held.noise.at("y").value, 3.0 * noise);
  EXPECT_DOUBLE_EQ(held.noise.at("y").sigma, 0.0);
  EXPECT_NEAR(estimated.noise.at("y").value, noise, 0.1 * noise);
  EXPECT_NEAR(held.parameters.at("a").value, estimated.parameters.at("a").value, 0.5 * estimated.parameters.at("a").sigma);
  EXPECT_NEAR(held.parameters.at("a").sigma / estimated.parameters.at("a").sigma, 3.0, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Methods, KnownNoiseOfAnOutput, testing::Bool());

TEST(KnownNoise, AsAStartChangesNothing) {
  constexpr std::size_t samples = 600;
  const Fit estimated = fitted(false, samples, {}), begun = fitted(false, samples, KnownNoise{2.0 * noise, false});
  EXPECT_NEAR(begun.noise.at("y").value, estimated.noise.at("y").value, 1e-6 * noise);
  EXPECT_NEAR(begun.parameters.at("a").value, estimated.parameters.at("a").value, 1e-3 * estimated.parameters.at("a").sigma);
}

TEST(KnownNoise, OfAnotherSizeThanTheResidualsIsSaid) {
  const auto of_size = [](double sigma) { return fitted(false, 600, KnownNoise{sigma, true}).warnings; };
  const auto said = [](const std::vector<std::string>& warnings) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const std::string& w) { return w.find("that the study fixes") != std::string::npos; });
  };
  EXPECT_TRUE(said(of_size(3.0 * noise)));
  EXPECT_FALSE(said(of_size(noise)));
}

TEST(KnownNoise, GivesSigmasWhereTooFewSamplesShowIt) {
  constexpr std::size_t samples = 3;
  EXPECT_EQ(fitted(false, samples, {}).parameters.at("a").sigma, 0.0);
  EXPECT_GT(fitted(false, samples, KnownNoise{noise, true}).parameters.at("a").sigma, 0.0);
}

TEST(KnownNoise, AnEstimateAtItsBoundIsSaid) {
  const auto said = [](const Fit& fit) {
    return std::any_of(fit.warnings.begin(), fit.warnings.end(), [](const std::string& w) {
      return w.starts_with("the white noise of y is at its lower bound ") && w.find("no estimate") != std::string::npos;
    });
  };
  constexpr double far_above = 500.0;  // the search goes down to a hundredth of where it starts
  EXPECT_TRUE(said(fitted(true, 600, KnownNoise{far_above * noise, false})));
  EXPECT_FALSE(said(fitted(true, 600, {})));
  EXPECT_FALSE(said(fitted(true, 600, KnownNoise{noise, true}))) << "held, not estimated";
}

bool says(const Fit& fit, const std::string& words) {
  return std::any_of(fit.warnings.begin(), fit.warnings.end(), [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

Fit filtered(const Signals& record) {
  const auto registry = registry_with(decay_text);
  const Model model = assemble(request_of("text"), *registry);
  FilterOptions one;
  one.threads = 1;
  return filter_error(trajectory_start(model, {record}).from, {record}, one).fit;
}

TEST(ColouredNoise, WhereItIsNotThereItsBoundsSayNothing) {
  int at_bounds = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Fit fit = filtered(decay(600, seed));
    EXPECT_FALSE(says(fit, "of the coloured noise of y is at its ")) << seed;
    const auto fact = fit.facts.find("coloured noise of y");
    if (fact != fit.facts.end() && fact->second.find("hardly more likely than white noise alone (drop ") == 0) ++at_bounds;
  }
  EXPECT_GT(at_bounds, 0) << "white noise is most like coloured noise of some shape";
}

/// A hum in the measurement: a line is the coloured noise of no damping.
TEST(ColouredNoise, WhereItIsThereItsBoundIsSaid) {
  Signals record = decay(600, 7);
  const double step = record.t[1] - record.t[0];
  for (std::size_t i = 0; i < record.samples(); ++i) record.measured[0].values[i] += noise * std::cos(0.9 * static_cast<double>(i));
  const Fit fit = filtered(record);
  EXPECT_TRUE(says(fit, "the damping of the coloured noise of y is at its lower bound 0.01: "));
  constexpr double turn = 2.0 * std::numbers::pi;
  EXPECT_NEAR(fit.noise.at("y_coloured_frequency").value, 0.9 / turn / step, 0.01 / step);
}

TEST(KnownForceTime, IsHeld) {
  const auto registry = registry_with(decay_text);
  Model model = assemble(request_of("text"), *registry);
  const std::vector<Signals> experiments{decay(600, 5)};
  const double step = experiments.front().t[1];
  FilterOptions one;
  one.threads = 1;
  for (const auto& [given, held] : {std::pair{0.2, 0.2}, std::pair{0.0, 0.3 * step}}) {
    model.force_time = given;
    const Fit fit = filter_error(trajectory_start(model, experiments).from, experiments, one).fit;
    ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
    EXPECT_NEAR(fit.force.at("correlation_time").value, held, 1e-9);
    EXPECT_EQ(fit.force.at("correlation_time").sigma, 0.0);
  }
}

/// A tilt of which every method makes something: [noise], [force] of its study are set in the model.
Fit tilt_fitted(const EstimatorInfo& method, const std::optional<KnownNoise>& noise_of_tilt, const std::optional<double>& force_time) {
  constexpr std::size_t samples = 600;
  Model model = assemble(testing_planar::eq_8(), testing_planar::registry());
  if (noise_of_tilt) model.known_noise = {*noise_of_tilt};
  model.force_time = force_time;
  Signals record = testing_planar::validation_signals();
  record.t.resize(samples);
  for (auto* channels : {&record.measured, &record.inputs})
    for (Signal& channel : *channels) channel.values.resize(samples);
  return estimator(method.name).run({model, {record}, {}, {}, 1, {}}).at.fitted.fit;
}

class KnownInEveryMethod : public testing::TestWithParam<const EstimatorInfo*> {
 protected:
  [[nodiscard]] Fit fitted_with(const std::optional<KnownNoise>& noise_of_tilt, const std::optional<double>& force_time) const {
    return tilt_fitted(*GetParam(), noise_of_tilt, force_time);
  }
  static void expect_same_curves(const Fit& a, const Fit& b) {
    ASSERT_EQ(a.curves.size(), b.curves.size());
    ASSERT_FALSE(a.curves.empty());
    for (std::size_t c = 0; c < a.curves.size(); ++c) {
      EXPECT_EQ(a.curves[c].value, b.curves[c].value) << a.curves[c].name;
      EXPECT_EQ(a.curves[c].sigma, b.curves[c].sigma) << a.curves[c].name;
    }
  }
};

TEST_P(KnownInEveryMethod, NoiseIsHeldWhereOutputsAreWeighedByItAndChangesNothingElsewhere) {
  constexpr KnownNoise held{0.2 * testing_planar::degree, true};  // 0.1 deg is in the record
  const Fit with = fitted_with(held, {});
  if (!GetParam()->has_likelihood) return expect_same_curves(with, fitted_with({}, {}));
  ASSERT_EQ(with.status, FitStatus::converged) << with.message;
  EXPECT_DOUBLE_EQ(with.noise.at("alpha_T").value, held.sigma);
  EXPECT_EQ(with.noise.at("alpha_T").sigma, 0.0);
}

TEST_P(KnownInEveryMethod, AWhiteForceIsThatOfTheMethodThatHasOne) {
  const Fit white = fitted_with({}, 0.0);
  if (GetParam()->deterministic) return expect_same_curves(white, fitted_with({}, {}));
  EXPECT_NEAR(white.force.at("correlation_time").value, 0.3 * testing_planar::validation_signals().t[1], 1e-9);  // of a sample
  EXPECT_EQ(white.force.at("correlation_time").sigma, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Methods, KnownInEveryMethod, testing::ValuesIn(estimators::all),
                         [](const auto& of) { return std::string(of.param->name); });

/// Most readings repeat the one before: a random force that follows the stairs has densities without bound where the noise may vanish.
TEST(KnownNoise, OfReadingsInWholeStepsIsNoLessThanTheirRounding) {
  constexpr double step = 0.05;
  Signals rounded = decay(600, 5);
  for (std::size_t i = 0; i < rounded.t.size(); ++i)
    rounded.measured[0].values[i] = step * std::round(std::exp(-truth * rounded.t[i]) / step);
  const auto registry = registry_with(decay_text);
  FilterOptions one;
  one.threads = 1;
  const Fit fit = filter_error(trajectory_start(assemble(request_of("text"), *registry), {rounded}).from, {rounded}, one).fit;
  EXPECT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_GT(fit.noise.at("y").value, 0.999 * step / std::sqrt(12.0));
  EXPECT_NEAR(fit.parameters.at("a").value, truth, 3.0 * fit.parameters.at("a").sigma);
  EXPECT_LT(fit.parameters.at("a").sigma, 0.05);
  ASSERT_TRUE(fit.facts.contains("white noise of y"));
  EXPECT_NE(fit.facts.at("white noise of y").find("whole steps of 0.05 V"), std::string::npos) << fit.facts.at("white noise of y");
}

/// Output of x' = u − x, read with white noise beside waves: a resonance of 0.35 Hz, exactly sampled as an AR(2) process.
Signals under_waves(double sigma) {
  constexpr double step = 0.1, zeta = 0.08, omega = 2.0 * std::numbers::pi * 0.35;
  constexpr std::size_t samples = 3000;
  const double damped = omega * std::sqrt(1.0 - zeta * zeta), decay = std::exp(-zeta * omega * step);
  const double first = 2.0 * decay * std::cos(damped * step), second = -decay * decay;
  // Variance of y_k = first y_(k-1) + second y_(k-2) + e_k over that of e (Box, Jenkins, Time Series Analysis, 3.2.4).
  const double growth = (1.0 - second) / ((1.0 + second) * ((1.0 - second) * (1.0 - second) - first * first));
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  Signals out;
  out.name = "ship";
  out.measured = {{"y", "V", {}, 0.0}};
  out.inputs = {{"u", "V", {}, 0.0}};
  double x = 0.0, wave = 0.0, before = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double u = (i / 60) % 2 == 0 ? 0.2 : -0.2;
    out.t.push_back(step * static_cast<double>(i));
    out.inputs[0].values.push_back(u);
    out.measured[0].values.push_back(x + wave + testing_first_order::noise * normal(random));
    x = u + (x - u) * std::exp(-step);
    const double next = first * wave + second * before + sigma / std::sqrt(growth) * normal(random);
    before = std::exchange(wave, next);
  }
  return out;
}

/// Without it the random force is taken for what makes the waves, and the system for faster than it is.
TEST(KnownNoise, WavesInAnOutputAreFoundAboutTheFrequencyThatIsGiven) {
  const auto registry = registry_with(testing_first_order::one_output);
  const std::vector<Signals> experiments{under_waves(0.1)};
  const auto fit_at = [&](double frequency) {
    Model model = assemble(request_of("text"), *registry);
    model.known_noise = {KnownNoise{0.0, false, frequency}};
    FilterOptions one;
    one.threads = 1;
    return filter_error(trajectory_start(model, experiments).from, experiments, one).fit;
  };
  const Fit unaware = fit_at(0.0), aware = fit_at(0.3);
  ASSERT_EQ(aware.status, FitStatus::converged) << aware.message;
  EXPECT_GT(aware.loglik.value(), unaware.loglik.value() + 20.0);
  const auto near = [](const Estimate& e, double truth) { return std::abs(e.value - truth) < 4.0 * e.sigma; };
  EXPECT_TRUE(near(aware.noise.at("y_coloured_frequency"), 0.35)) << aware.noise.at("y_coloured_frequency").value;
  EXPECT_NEAR(aware.noise.at("y_coloured").value, 0.1, 0.02);
  EXPECT_TRUE(near(aware.parameters.at("a"), 1.0)) << aware.parameters.at("a").value;
  EXPECT_TRUE(near(aware.parameters.at("b"), 1.0)) << aware.parameters.at("b").value;
  EXPECT_LT(aware.parameters.at("a").sigma, 0.1);
}

}  // namespace
}  // namespace misfit
