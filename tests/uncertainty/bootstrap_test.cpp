#include "misfit/uncertainty/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

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

Bootstrap bootstrap_of_mean(const std::vector<Signals>& experiments, Resampled what, const BootstrapOptions& options, int threads = 0) {
  const Fit fit = mean_of(experiments);
  return block_bootstrap(BlockBootstrap(fit, experiments, what, mean_of, options), threads);
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

/// The same with `apart` − 1 rows between two measurements in which nothing is measured.
Signals measured_at_every(std::size_t apart, const Signals& dense) {
  Signals out = dense;
  out.t.clear();
  auto& values = out.measured.front().values;
  values.clear();
  for (std::size_t i = 0; i < dense.samples() * apart; ++i) {
    out.t.push_back(0.1 * static_cast<double>(i) / static_cast<double>(apart));
    values.push_back(i % apart == 0 ? dense.measured.front().values[i / apart] : std::nan(""));
  }
  return out;
}

TEST(BlockBootstrap, RowsWithoutAMeasurementAreInNoBlocksLength) {
  constexpr std::size_t samples = 1500;
  for (const Resampled what : {Resampled::residuals, Resampled::rows}) {
    double ratio = 0.0;
    constexpr unsigned seeds = 6;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      BootstrapOptions options;
      options.runs = 200;
      const Signals dense = noise_about(2.0, 0.8, seed, samples), sparse = measured_at_every(4, dense);
      const Bootstrap of_dense = bootstrap_of_mean({dense}, what, options), of_sparse = bootstrap_of_mean({sparse}, what, options);
      EXPECT_EQ(of_sparse.block, of_dense.block);
      ratio += of_sparse.numbers.front().sigma / of_dense.numbers.front().sigma / seeds;
    }
    EXPECT_NEAR(ratio, 1.0, 0.06) << (what == Resampled::rows ? "rows" : "residuals");
  }
}

TEST(BlockBootstrap, SampleBySampleItMissesTheDependence) {
  constexpr std::size_t samples = 3000;
  BootstrapOptions options;
  options.runs = 300;
  options.block.samples = 1;
  const Bootstrap b = bootstrap_of_mean({noise_about(0.0, 0.6, 1, samples)}, Resampled::residuals, options);
  EXPECT_NEAR(b.numbers.front().sigma * std::sqrt(static_cast<double>(samples)), 1.0, 0.2);  // 2 with the dependence
}

TEST(BlockBootstrap, TheAnswerDoesNotDependOnTheThreads) {
  const std::vector<Signals> data{noise_about(0.0, 0.5, 3, 400), noise_about(0.0, 0.5, 4, 300)};
  BootstrapOptions options;
  options.runs = 40;
  const Bootstrap a = bootstrap_of_mean(data, Resampled::residuals, options, 1),
                  b = bootstrap_of_mean(data, Resampled::residuals, options, 2);
  EXPECT_EQ(a.numbers.front().sigma, b.numbers.front().sigma);
  EXPECT_EQ(a.numbers.front().lower, b.numbers.front().lower);
  options.seed = 2;
  EXPECT_NE(a.numbers.front().sigma, bootstrap_of_mean(data, Resampled::residuals, options).numbers.front().sigma);
}

TEST(BlockBootstrap, RunsThatFailAreCountedAndTooManyAreAnError) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 3, 200)};
  const Fit fit = mean_of(data);
  BootstrapOptions options;
  options.runs = 30;
  // By the digits of the replica's mean one run in ten throws and `share` do not converge.
  const auto sometimes = [](double share) {
    return [share](const std::vector<Signals>& s) {
      Fit mean = mean_of(s);
      const double digits = std::abs(mean.parameters.at("mean").value) * 1e6, place = digits - std::floor(digits);
      if (place > 0.9) throw RunError("no state can be read");
      if (place < share) mean.status = FitStatus::not_converged;
      mean.message = "as asked for";
      return mean;
    };
  };
  const Bootstrap some = block_bootstrap(BlockBootstrap(fit, data, Resampled::residuals, sometimes(0.2), options), 1);
  EXPECT_GT(some.failures.at("no state can be read"), 0U);
  EXPECT_GT(some.failures.at("not_converged: as asked for"), 0U);
  EXPECT_EQ(some.failures.size(), 2U);
  EXPECT_EQ(some.failures.at("no state can be read") + some.failures.at("not_converged: as asked for"), some.failed);
  EXPECT_EQ(some.numbers.front().runs + some.failed, some.runs);
  const BlockBootstrap hopeless(fit, data, Resampled::residuals, sometimes(0.8), options);
  expect_parts(message_of<RunError>([&] { static_cast<void>(block_bootstrap(hopeless, 1)); }), {"of 30 runs gave no fit", "as asked for"});
}

TEST(BlockBootstrap, OnDiskItGoesOnWhereItStoppedToTheSameBits) {
  const std::vector<Signals> data{noise_about(0.0, 0.5, 3, 400)};
  const Fit fit = mean_of(data);
  BootstrapOptions options;
  options.runs = 40;
  const TemporaryFolder folder;
  std::atomic<int> fits{0};
  std::atomic<bool> stop{false};
  const auto counted = [&](const std::vector<Signals>& s) {
    if (++fits == 15) stop = true;
    return mean_of(s);
  };
  const BlockBootstrap bootstrap(fit, data, Resampled::residuals, counted, options);
  const auto run = [&](std::size_t k) { return bootstrap.run(k); };
  const StoredJobs jobs{folder.path() / "jobs", "digest", options.runs, 1};
  EXPECT_FALSE(stored_runs(run, jobs, {}, &stop));
  const auto results = stored_runs(run, jobs);
  ASSERT_TRUE(results);
  EXPECT_EQ(fits, 40) << "what is on disk is not done again";
  const Bootstrap stored = bootstrap.summary(*results), whole = bootstrap_of_mean(data, Resampled::residuals, options);
  EXPECT_EQ(stored.numbers.front().sigma, whole.numbers.front().sigma);
  EXPECT_EQ(stored.numbers.front().lower, whole.numbers.front().lower);
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

/// Correlation of a channel's values with the next measured ones.
double correlation_of_next(const std::vector<double>& values) {
  double before = std::nan(""), products = 0.0, squares = 0.0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    if (std::isfinite(before)) products += before * v;
    squares += v * v;
    before = v;
  }
  return products / squares;
}

TEST(Resampler, ChannelsOfDifferentRatesKeepTheMemoryOfEach) {
  Signals s = noise_about(0.0, 0.3, 7, 4000);
  s.measured.push_back(measured_at_every(4, noise_about(0.0, 0.8, 8, 1000)).measured.front());
  s.measured[1].name = "slow";
  const std::vector<Signals> data{s};
  Fit fit;
  for (const Signal& channel : s.measured)
    fit.predictions.push_back({s.name, channel.name, "-", s.t, channel.values, std::vector<double>(4000, 0.0), {}, {}});
  const Resampler resampler(Resampled::residuals, fit, data);
  std::mt19937_64 random(1);
  const Signals drawn = resampler.draw(random).front();
  EXPECT_GE(resampler.block(), 5 * 4 * 5) << "five times the memory of the slow channel, in samples of both";
  for (std::size_t o = 0; o < 2; ++o) {
    const auto& before = s.measured[o].values;
    EXPECT_NEAR(correlation_of_next(drawn.measured[o].values), correlation_of_next(before), 0.1) << s.measured[o].name;
    for (std::size_t i = 0; i < s.samples(); ++i) EXPECT_EQ(std::isnan(drawn.measured[o].values[i]), std::isnan(before[i])) << i;
  }
}

/// Samples of blocks that are fitted: those that count, and those that a fit would take though they are held out in the whole.
struct Taken {
  std::size_t counted = 0, held_out = 0, shortest = 1'000'000;
};

Taken taken(const std::vector<Signals>& blocks, const std::vector<Signals>& data) {
  Taken out;
  for (const Signals& block : blocks) {
    std::size_t fitted = 0;
    for (std::size_t i = block.exclude; i < block.samples(); ++i) {
      if (block.held_out(i)) continue;
      ++fitted;
      const auto at = static_cast<std::size_t>(std::lround(block.t[i] / 0.1));
      out.held_out += data.front().held_out(at) ? 1 : 0;
      out.counted += std::isfinite(block.measured.front().values[i]) ? 1 : 0;
    }
    out.shortest = std::min(out.shortest, fitted);
  }
  return out;
}

TEST(Resampler, BlocksOfRowsKeepTheirTimesAndBringTheirNeighbours) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 600)};
  const Resampler resampler(Resampled::rows, Fit{}, data, {50, {}});
  std::mt19937_64 random(1);
  for (const Signals& block : resampler.draw(random)) {
    EXPECT_LE(block.exclude, Resampler::kReach);
    for (std::size_t i = 0; i < block.samples(); ++i) {
      const auto at = static_cast<std::size_t>(std::lround(block.t[i] / 0.1));
      EXPECT_EQ(block.measured.front().values[i], data.front().measured.front().values[at]);
    }
  }
}

TEST(Resampler, AnInputThatTheModelDoesNotNeedHasNoValuesInABlock) {
  Signals s = noise_about(0.0, 0.0, 7, 600);
  s.inputs = {{"drive", "N", std::vector<double>(600, 2.0), 0.0}, {"V", "m/s", {}, 0.0}};
  const std::vector<Signals> data{s};
  std::mt19937_64 random(1);
  for (const Signals& block : Resampler(Resampled::rows, Fit{}, data, {50, {}}).draw(random)) {
    EXPECT_EQ(block.inputs[0].values, std::vector<double>(block.samples(), 2.0));
    EXPECT_TRUE(block.inputs[1].values.empty());
  }
}

TEST(Resampler, BlocksOfRowsAreAsManySamplesAsCount) {
  Signals holes = noise_about(0.0, 0.0, 7, 600);
  for (std::size_t i = 100; i < 190; ++i) holes.measured.front().values[i] = std::nan("");
  holes.exclude = 7;
  for (const auto& [data, counted] : {std::pair{std::vector<Signals>{noise_about(0.0, 0.0, 7, 601)}, std::size_t{601}},
                                      std::pair{std::vector<Signals>{holes}, std::size_t{503}}}) {
    for (const int length : {47, 62}) {
      const Resampler resampler(Resampled::rows, Fit{}, data, {length, {}});
      std::mt19937_64 random(1);
      for (int draw = 0; draw < 20; ++draw) EXPECT_EQ(taken(resampler.draw(random), data).counted, counted) << length;
    }
  }
  const std::vector<Signals> whole{noise_about(0.0, 0.0, 7, 601)};
  std::mt19937_64 random(1);
  EXPECT_GE(taken(Resampler(Resampled::rows, Fit{}, whole, {50, {}}).draw(random), whole).shortest, 25U) << "no crumb at the end";
}

TEST(Resampler, BlocksOfRowsHaveNoHeldOutSampleInside) {
  Signals s = noise_about(0.0, 0.0, 7, 600);
  s.validation_from = s.t[300];
  s.validation_to = s.t[320];
  const std::vector<Signals> data{s};
  const Resampler resampler(Resampled::rows, Fit{}, data, {60, {}});
  std::mt19937_64 random(1);
  for (int draw = 0; draw < 50; ++draw) {
    const Taken drawn = taken(resampler.draw(random), data);
    EXPECT_EQ(drawn.held_out, 0U);
    EXPECT_EQ(drawn.counted, 580U);
  }
}

TEST(Resampler, BlocksOfRowsAreAsLongAsTheEquationsRemember) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 4000)};
  const auto block_for = [&](double phi) {
    return Resampler(Resampled::rows, Fit{}, data, {0, {{noise_about(0.0, phi, 5, 4000).measured.front().values}}}).block();
  };
  const int white = block_for(0.0), coloured = block_for(0.9);
  EXPECT_GE(coloured, white + 50) << "0.9 falls below chance after some 20 samples, five times that are asked for";
  EXPECT_EQ(white, Resampler(Resampled::rows, Fit{}, data).block()) << "at least n^(1/3) and 50";
}

TEST(Resampler, ABlockThatIsCutIsSaid) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 400)};
  const Resampler kept(Resampled::rows, Fit{}, data, {50, {}}), cut(Resampled::rows, Fit{}, data, {120, {}});
  EXPECT_EQ(kept.note(), "");
  EXPECT_EQ(cut.block(), 50);
  expect_parts(cut.note(), {"asks for blocks of 120 samples", "cut to 50", "an eighth of the 400"});
  BootstrapOptions options;
  options.runs = 10;
  options.block.samples = 120;
  EXPECT_EQ(bootstrap_of_mean(data, Resampled::rows, options).notes, std::vector<std::string>{cut.note()});
}

TEST(Resampler, WrongInputIsSaidInWords) {
  const std::vector<Signals> data{noise_about(0.0, 0.0, 7, 100)}, few{noise_about(0.0, 0.0, 7, 10)};
  const Fit fit = mean_of(data);
  EXPECT_THROW(Resampler(Resampled::residuals, fit, data, {-1, {}}), InputError);
  EXPECT_THROW(Resampler(Resampled::residuals, mean_of(few), few), RunError);
  EXPECT_THROW(Resampler(Resampled::residuals, Fit{}, data), RunError);
  BootstrapOptions options;
  options.runs = 1;
  EXPECT_THROW(BlockBootstrap(fit, data, Resampled::residuals, {}, options), InputError);
}

}  // namespace
}  // namespace misfit
