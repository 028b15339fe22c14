#include "misfit/uncertainty/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"

namespace misfit {
namespace {

/// A channel of first-order noise about a level.
Signals noise_about(double level, double phi, unsigned seed, std::size_t samples) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "record";
  Signal channel{"y", "-", {}, 0.0};
  double v = normal(random);
  for (std::size_t i = 0; i < samples; ++i) {
    s.t.push_back(0.1 * static_cast<double>(i));
    channel.values.push_back(level + v);
    v = phi * v + std::sqrt(1.0 - phi * phi) * normal(random);
  }
  s.measured.push_back(std::move(channel));
  return s;
}

/// The mean of all counted samples as a fit that predicts it.
Fit mean_of(const std::vector<Signals>& experiments) {
  double sum = 0.0, count = 0.0;
  for (const auto& e : experiments) {
    for (std::size_t i = e.exclude; i < e.samples(); ++i) {
      const double v = e.measured.front().values[i];
      if (std::isfinite(v) && !e.held_out(i)) sum += v, count += 1.0;
    }
  }
  Fit fit;
  fit.method = "mean";
  fit.status = FitStatus::converged;
  fit.parameters["mean"] = {sum / count, 1.0 / std::sqrt(count), "-"};
  fit.names = {"mean"};
  for (const auto& e : experiments)
    fit.predictions.push_back({e.name, "y", "-", e.t, e.measured.front().values, std::vector<double>(e.samples(), sum / count), {}, {}});
  return fit;
}

Bootstrap bootstrap_of_mean(const std::vector<Signals>& experiments, Resampled what, const BootstrapOptions& options) {
  const Fit fit = mean_of(experiments);
  const BlockBootstrap bootstrap(
      fit, experiments, what, [](const std::vector<Signals>& s) { return std::optional(mean_of(s)); }, options);
  return block_bootstrap(bootstrap, options.threads);
}

TEST(BlockBootstrap, ScatterOfAMeanIsTheAnalyticOneOfDependentNoise) {
  constexpr std::size_t samples = 3000;
  for (const double phi : {0.0, 0.6}) {
    const double truth = std::sqrt((1.0 + phi) / (1.0 - phi) / static_cast<double>(samples));
    for (const Resampled what : {Resampled::residuals, Resampled::rows}) {
      double ratio = 0.0;
      constexpr unsigned seeds = 10;
      for (unsigned seed = 1; seed <= seeds; ++seed) {
        BootstrapOptions options;
        options.runs = 300;
        const Bootstrap b = bootstrap_of_mean({noise_about(2.0, phi, seed, samples)}, what, options);
        ratio += b.numbers.front().sigma / truth / seeds;
        EXPECT_NEAR(b.numbers.front().mean, b.numbers.front().value, 3.0 * b.numbers.front().sigma / std::sqrt(300.0) + 1e-3 + truth);
      }
      EXPECT_NEAR(ratio, 1.0, 0.1) << "phi " << phi << (what == Resampled::rows ? ", rows" : ", residuals");
    }
  }
}

TEST(BlockBootstrap, SampleBySampleItMissesTheDependence) {
  constexpr std::size_t samples = 3000;
  BootstrapOptions options;
  options.runs = 300;
  options.block = 1;
  const Bootstrap b = bootstrap_of_mean({noise_about(0.0, 0.6, 1, samples)}, Resampled::residuals, options);
  EXPECT_NEAR(b.numbers.front().sigma * std::sqrt(static_cast<double>(samples)), 1.0, 0.2);  // 2 with the dependence
}

TEST(BlockBootstrap, TheAnswerDoesNotDependOnTheThreads) {
  const std::vector<Signals> data{noise_about(0.0, 0.5, 3, 400), noise_about(0.0, 0.5, 4, 300)};
  BootstrapOptions one, two;
  one.runs = two.runs = 40;
  one.threads = 1;
  two.threads = 2;
  const Bootstrap a = bootstrap_of_mean(data, Resampled::residuals, one), b = bootstrap_of_mean(data, Resampled::residuals, two);
  EXPECT_EQ(a.numbers.front().sigma, b.numbers.front().sigma);
  EXPECT_EQ(a.numbers.front().lower, b.numbers.front().lower);
  two.seed = 2;
  EXPECT_NE(a.numbers.front().sigma, bootstrap_of_mean(data, Resampled::residuals, two).numbers.front().sigma);
}

TEST(BlockBootstrap, RunsThatFailAreCountedAndTooManyAreAnError) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 3, 200)};
  const Fit fit = mean_of(data);
  BootstrapOptions options;
  options.runs = 30;
  const auto sometimes = [](double share) {
    return [share](const std::vector<Signals>& s) -> std::optional<Fit> {
      const Fit mean = mean_of(s);
      const double digits = std::abs(mean.parameters.at("mean").value) * 1e6;
      return digits - std::floor(digits) < share ? std::nullopt : std::optional(mean);
    };
  };
  const Bootstrap some = block_bootstrap(BlockBootstrap(fit, data, Resampled::residuals, sometimes(0.2), options), 1);
  EXPECT_GT(some.failed, 0U);
  EXPECT_EQ(some.numbers.front().runs + some.failed, some.runs);
  EXPECT_THROW(static_cast<void>(block_bootstrap(BlockBootstrap(fit, data, Resampled::residuals, sometimes(0.9), options), 1)), RunError);
}

TEST(Resampler, MissingStaysMissingAndHeldOutStaysAsItIs) {
  Signals s = noise_about(5.0, 0.3, 7, 500);
  for (std::size_t i = 40; i < 60; ++i) s.measured.front().values[i] = std::nan("");
  s.validation_from = s.t[400];
  const std::vector<Signals> data{s};
  const Fit fit = mean_of(data);
  const Resampler resampler(Resampled::residuals, fit, data);
  std::mt19937_64 random(1);
  const Signals drawn = resampler.draw(random).front();
  int changed = 0;
  for (std::size_t i = 0; i < s.samples(); ++i) {
    const double before = s.measured.front().values[i], now = drawn.measured.front().values[i];
    EXPECT_EQ(std::isnan(before), std::isnan(now)) << i;
    if (i < 400) {
      changed += before != now ? 1 : 0;
    } else {
      EXPECT_EQ(before, now) << i;
    }
  }
  EXPECT_GT(changed, 300);
}

TEST(Resampler, BlocksOfRowsKeepTheirTimesAndBringTheirNeighbours) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 600)};
  const Resampler resampler(Resampled::rows, Fit{}, data, 50);
  std::mt19937_64 random(1);
  std::size_t counted = 0;
  for (const Signals& block : resampler.draw(random)) {
    EXPECT_LE(block.exclude, Resampler::kReach);
    for (std::size_t i = 0; i < block.samples(); ++i) {
      const auto at = static_cast<std::size_t>(std::lround(block.t[i] / 0.1));
      EXPECT_EQ(block.measured.front().values[i], data.front().measured.front().values[at]);
      counted += i >= block.exclude && !block.held_out(i) ? 1 : 0;
    }
  }
  EXPECT_EQ(counted, 600U);
}

TEST(Resampler, WrongInputIsSaidInWords) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 100)}, few{noise_about(0.0, 0.0, 7, 10)};
  const Fit fit = mean_of(data);
  EXPECT_THROW(Resampler(Resampled::residuals, fit, data, -1), InputError);
  EXPECT_THROW(Resampler(Resampled::residuals, mean_of(few), few), RunError);
  EXPECT_THROW(Resampler(Resampled::residuals, Fit{}, data), RunError);
  BootstrapOptions options;
  options.runs = 1;
  EXPECT_THROW(BlockBootstrap(fit, data, Resampled::residuals, {}, options), InputError);
}

}  // namespace
}  // namespace misfit
