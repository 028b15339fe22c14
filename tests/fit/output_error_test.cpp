#include "misfit/fit/shooting/output_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/inference/curves.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using testing_planar::degree;

// The static curve of the validation simulation (made by other code), 8 to 15.5 deg in steps of half a degree.
constexpr double first_angle = 8.0, angle_step = 0.5;
const std::vector<double> true_C_m = {0.0165,        0.0155092131,  0.0141598802,  0.0124806073,  0.0105,        0.0082445338,
                                      0.0057321627,  0.0029787102,  0.0,           -0.0031904733, -0.0065885310, -0.0101923231,
                                      -0.0140000000, -0.0180060780, -0.0221905388, -0.0265297302};

double value_at(const CurveEstimate& curve, double x) {
  const auto next = std::lower_bound(curve.x.begin(), curve.x.end(), x);
  if (next == curve.x.begin() || next == curve.x.end()) return std::nan("");
  const auto i = static_cast<std::size_t>(next - curve.x.begin());
  const double f = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  return curve.value[i - 1] + f * (curve.value[i] - curve.value[i - 1]);
}

/// RMS error of C_m where the curve exists within 8 … 15.5 deg.
double rms_error(const Fit& fit) {
  double squares = 0.0, count = 0.0;
  for (const auto& curve : fit.curves) {
    if (curve.name != "C_m") continue;
    for (std::size_t i = 0; i < true_C_m.size(); ++i) {
      const double e = value_at(curve, (first_angle + angle_step * static_cast<double>(i)) * degree) - true_C_m[i];
      if (std::isfinite(e)) squares += e * e, count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : std::nan("");
}

Model model_for(const std::vector<Signals>& experiments, int intervals) {
  ModelRequest request = testing_planar::eq_8();
  request.curves.clear();
  choose_all_knots(request, testing_planar::registry(), experiments, intervals);
  return assemble(request, testing_planar::registry());
}

FittedModel fitted(const std::vector<Signals>& experiments, int intervals = 16) {
  return output_error(equation_error(model_for(experiments, intervals), experiments), experiments);
}

Signals with_noise(unsigned seed, double sigma_deg) {
  Signals signals = testing_planar::validation_signals("alpha_T_true");
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_deg * degree);
  for (double& v : signals.measured.front().values) v += noise(random);
  return signals;
}

struct Oscillation {
  double amplitude, frequency;
};

/// Half of peak to peak (means of the extremes of each cycle) and frequency from upward crossings of the mean, over the last `seconds`.
Oscillation oscillation(const std::vector<double>& t, const std::vector<double>& x, double seconds) {
  const auto begin = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), t.back() - seconds) - t.begin());
  double mean = 0.0;
  for (std::size_t i = begin; i < x.size(); ++i) mean += x[i] / static_cast<double>(x.size() - begin);
  std::vector<double> crossings, highs, lows;
  double high = -1e9, low = 1e9;
  for (std::size_t i = begin + 1; i < x.size(); ++i) {
    high = std::max(high, x[i]);
    low = std::min(low, x[i]);
    if (x[i - 1] >= mean || x[i] < mean) continue;
    crossings.push_back(t[i - 1] + (t[i] - t[i - 1]) * (mean - x[i - 1]) / (x[i] - x[i - 1]));
    highs.push_back(high);
    lows.push_back(low);
    high = -1e9;
    low = 1e9;
  }
  double peak = 0.0, trough = 0.0;
  const auto cycles = static_cast<double>(crossings.size() - 1);
  for (std::size_t k = 1; k < crossings.size(); ++k) peak += highs[k] / cycles, trough += lows[k] / cycles;
  return {(peak - trough) / 2.0, cycles / (crossings.back() - crossings.front())};
}

TEST(OutputErrorOnValidation, ReturnsTheCurvesTheMotionWasMadeWith) {
  const std::vector<Signals> experiments{testing_planar::validation_signals()};
  const Fit fit = fitted(experiments).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  constexpr double noise_put_in = 0.1;  // deg
  EXPECT_NEAR(fit.rms.at("alpha_T").value / degree, noise_put_in, 0.03 * noise_put_in);
  const double error = rms_error(fit);
  EXPECT_LE(error, 1.5e-4);
  SlidingBinOptions options;
  options.stencils = Stencils::fourth_order;
  const Fit fourth = sliding_bin(assemble(testing_planar::eq_8(), testing_planar::registry()), experiments.front(), options);
  options.stencils = Stencils::second_order_four_point;
  const Fit second = sliding_bin(assemble(testing_planar::eq_8(), testing_planar::registry()), experiments.front(), options);
  EXPECT_GE(rms_error(fourth), 5.0 * error);
  std::printf("C_m error over 8-15.5 deg: output_error %.2e, sliding_bin %.2e (fourth-order stencils), %.2e (second-order four-point)\n",
              error, rms_error(fourth), rms_error(second));
  ASSERT_TRUE(fit.trim.has_value());
  EXPECT_NEAR(fit.trim->value / degree, 12.0, 3.0 * fit.trim->sigma / degree);
}

TEST(OutputErrorOnValidation, TheSimulatedFitKeepsTheLimitCycle) {
  const std::vector<Signals> experiments{testing_planar::validation_signals()};
  const Fit fit = fitted(experiments).fit;
  const auto truth = testing_planar::validation_signals("alpha_T_true").measured.front().values;
  const Oscillation simulated = oscillation(experiments.front().t, fit.predictions.front().predicted, 30.0);
  const Oscillation expected = oscillation(experiments.front().t, truth, 30.0);
  EXPECT_NEAR(simulated.amplitude / expected.amplitude, 1.0, 0.01);
  EXPECT_NEAR(simulated.frequency / expected.frequency, 1.0, 0.01);
}

TEST(OutputErrorOnValidation, ConvergesFromItsOwnStartForFiftyNoiseSeeds) {
  int within = 0;
  double squares = 0.0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const std::vector<Signals> experiments{with_noise(seed, 0.1)};
    const Fit fit = fitted(experiments, 10).fit;
    ASSERT_EQ(fit.status, FitStatus::converged) << "seed " << seed << ": " << fit.message;
    EXPECT_NEAR(fit.rms.at("alpha_T").value / degree, 0.1, 0.005) << "seed " << seed;
    const double error = rms_error(fit);
    EXPECT_LE(error, 4e-4) << "seed " << seed;
    squares += error * error;
    if (std::abs(fit.trim->value / degree - 12.0) < 1.96 * fit.trim->sigma / degree) ++within;
  }
  std::printf("50 seeds: rms over seeds of the C_m error %.2e; trim inside its 95 %% interval %d of 50\n", std::sqrt(squares / 50.0),
              within);
  EXPECT_GE(within, 42);  // 95 % nominal: 42 or fewer of 50 has probability 0.4 %
}

TEST(OutputErrorOnValidation, ConvergesFromFiftyRandomStarts) {
  const std::vector<Signals> experiments{testing_planar::validation_signals()};
  const Model model = model_for(experiments, 8);
  const double optimum = fitted(experiments, 8).fit.rms.at("alpha_T").value;
  std::string failed;
  int converged = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    FittedModel start{{}, model, {}, {}};
    for (auto& p : start.model.parameters) {
      if (p.curve < 0) continue;
      const double size =
          model.curves[static_cast<std::size_t>(p.curve)].name == "C_m" ? 0.03 : 0.1;  // the largest true values over the visited angles
      p.value = std::uniform_real_distribution<double>(-size, size)(random);
    }
    OutputErrorStart options;
    options.from_regression = false;
    const Fit fit = output_error(start, experiments, options).fit;
    const bool there = fit.status == FitStatus::converged && std::abs(fit.rms.at("alpha_T").value / optimum - 1.0) < 1e-3;
    converged += there ? 1 : 0;
    if (!there) failed += "\n  start " + std::to_string(seed) + ": " + to_string(fit.status) + ", " + fit.message;
  }
  std::printf("random starts: %d of 50 reach the optimum\n", converged);
  EXPECT_EQ(converged, 50) << failed;
}

/// With a tenth of the roughness, and ten times: the curve that the first fit foretells, and the one that a refit gives.
TEST(OutputErrorOnValidation, ForetellsTheCurveOfAnotherRoughness) {
  const std::vector<Signals> experiments{with_noise(1, 0.1)};
  const FittedModel first = fitted(experiments);
  const auto path = std::find_if(first.fit.roughness.begin(), first.fit.roughness.end(), [](const auto& p) { return p.curve == "C_m"; });
  ASSERT_NE(path, first.fit.roughness.end());
  EXPECT_EQ(path->unit, "rad^3");
  const auto used =
      static_cast<std::size_t>(std::find(path->roughness.begin(), path->roughness.end(), path->used) - path->roughness.begin());
  for (const std::size_t other : {used - 3, used + 3}) {
    Model model = first.model;
    for (Curve& curve : model.curves) {
      const auto own =
          std::find_if(first.fit.roughness.begin(), first.fit.roughness.end(), [&](const auto& p) { return p.curve == curve.name; });
      ASSERT_NE(own, first.fit.roughness.end());
      curve.roughness = curve.name == "C_m" ? path->roughness[other] : own->used;
    }
    const FittedModel refitted = output_error(equation_error(model, experiments), experiments);
    const CurveEstimate &before = first.fit.curves.front(), &after = refitted.fit.curves.front();
    ASSERT_EQ(after.name, "C_m");
    const CurvesByRoughness& foretold = path->curves.front();
    double error = 0.0, change = 0.0;
    for (std::size_t i = 0; i < foretold.x.size(); ++i) {
      if (foretold.x[i] < first_angle * degree || foretold.x[i] > 15.5 * degree) continue;
      const double truth = value_at(after, foretold.x[i] + 1e-9);
      error += std::pow(foretold.values[other][i] - truth, 2);
      change += std::pow(value_at(before, foretold.x[i] + 1e-9) - truth, 2);
    }
    std::printf("C_m with %.3g times the roughness: changes by %.3g, foretold to %.3g\n", path->roughness[other] / path->used,
                std::sqrt(change), std::sqrt(error));
    EXPECT_GT(change, 0.0);
    EXPECT_LT(std::sqrt(error), 0.2 * std::sqrt(change));
  }
}

TEST(OutputError, EveryParameterFixedIsAnAnswerInWords) {
  const std::vector<Signals> experiments{testing_planar::validation_signals()};
  Model model = model_for(experiments, 6);
  for (auto& p : model.parameters) p.free = false;
  const FittedModel regression = equation_error(model, experiments);
  EXPECT_EQ(regression.fit.status, FitStatus::declined);
  EXPECT_NE(regression.fit.message.find("fixed"), std::string::npos);
}

TEST(OutputError, SamplesMissingAtRandomWidenButDoNotBiasTheTrim) {
  Signals signals = testing_planar::validation_signals();
  std::mt19937_64 random(3);
  for (double& v : signals.measured.front().values) {
    if (std::uniform_real_distribution<double>(0.0, 1.0)(random) < 0.4) v = std::nan("");
  }
  const Fit fit = fitted({signals}, 10).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_NEAR(fit.trim->value / degree, 12.0, 3.0 * fit.trim->sigma / degree);
}

TEST(OutputError, HeldOutSamplesAreNotFittedButPredicted) {
  Signals signals = testing_planar::validation_signals();
  signals.validation_from = 60.0;
  Signals spoiled = signals;
  for (std::size_t i = 0; i < spoiled.samples(); ++i) {
    if (spoiled.held_out(i)) spoiled.measured.front().values[i] += 1.0 * degree;
  }
  const Fit clean = fitted({signals}, 8).fit;
  const Fit other = fitted({spoiled}, 8).fit;
  ASSERT_EQ(clean.status, FitStatus::converged) << clean.message;
  EXPECT_LT(clean.validation_rms.at("alpha_T").value / degree, 0.13);
  EXPECT_NEAR(other.validation_rms.at("alpha_T").value / degree, 1.0, 0.1);
  EXPECT_NEAR(other.rms.at("alpha_T").value, clean.rms.at("alpha_T").value, 0.01 * clean.rms.at("alpha_T").value);
}

TEST(OutputError, TwoExperimentsShareTheirParameters) {
  Signals a = with_noise(7, 0.1), b = with_noise(8, 0.1);
  a.name = "a";
  b.name = "b";
  const FittedModel both = fitted({a, b}, 8), one = fitted({a}, 8);
  ASSERT_EQ(both.fit.status, FitStatus::converged) << both.fit.message;
  ASSERT_EQ(both.initial_states.size(), 2U);
  ASSERT_EQ(both.fit.predictions.size(), 2U);
  EXPECT_LT(both.fit.trim->sigma, one.fit.trim->sigma);
  EXPECT_NEAR(both.fit.trim->value / degree, 12.0, 3.0 * both.fit.trim->sigma / degree);
}

/// A canopy that swings through the axis: its curves are odd or even, so that both sides determine the positive one.
TEST(Knots, OfMotionThroughZeroAreThoseOfItsSize) {
  std::vector<double> t, alpha;
  for (int i = 0; i < 1200; ++i) {
    t.push_back(i / 59.94);
    alpha.push_back(0.25 * std::sin(4.0 * t.back()) + 1e-3 * std::sin(311.0 * t.back()));
  }
  const std::vector<Signals> swing{testing_planar::measured(t, alpha)};
  ModelRequest request = testing_planar::eq_8();
  request.curves.clear();
  choose_all_knots(request, testing_planar::registry(), swing, 8);
  const std::vector<double>& knots = request.curves.at("C_m").knots;
  EXPECT_GT(knots.front(), 0.0);
  EXPECT_NEAR(knots.back(), 0.25, 0.005);
  const Fit fit = equation_error(assemble(request, testing_planar::registry()), swing).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  double counted = 0.0;
  for (const auto& curve : fit.curves) {
    if (curve.name == "C_m") counted = std::accumulate(curve.count.begin(), curve.count.end(), 0.0);
  }
  EXPECT_GT(counted, 1100.0) << "both halves of the swing count";
}

}  // namespace
}  // namespace misfit
