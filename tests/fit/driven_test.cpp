#include "misfit/inference/driven.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_planar;

/// A tilt about a trim of 12 deg whose static moment, damping, force, noise and length are drawn.
class Tilt {
 public:
  Tilt(unsigned seed, bool driven) : random_(seed), driven_(driven) {}

  Signals fly() {
    constexpr double h = 1.0 / 59.94;
    constexpr int substeps = 20;
    const double noise = between(0.02, 0.1) * degree;
    const auto samples = static_cast<int>(between(15.0, 60.0) / h);
    double alpha = driven_ ? kTrim : kTrim + between(1.5, 4.0) * degree, rate = 0.0, force = 0.0;
    std::vector<double> levels;
    for (int i = 0; i < samples; ++i) {
      levels.push_back(alpha + noise * normal_(random_));
      for (int k = 0; k < substeps; ++k) {
        constexpr double d = h / substeps;
        if (driven_) force += -force * d / memory_ + strength_ * std::sqrt(2.0 * d / memory_) * normal_(random_);
        rate += d * (moment(alpha, rate) + force);
        alpha += d * rate;
      }
    }
    return measured(even_times(levels.size(), h), levels);
  }

 private:
  static constexpr double kTrim = 12.0 * degree;

  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }

  /// Damped if driven; else a limit cycle or a slow decay.
  [[nodiscard]] double moment(double alpha, double rate) const {
    const double x = alpha - kTrim;
    const double damping = driven_ || !cycle_ ? damping_ : damping_ * (std::pow(x / width_, 2) - 1.0);
    return -omega_ * omega_ * x * (1.0 + hardening_ * x) - 2.0 * damping * omega_ * rate;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  bool driven_;
  double omega_ = between(4.0, 12.0), hardening_ = between(-1.0, 1.0), width_ = between(1.0, 2.5) * degree;
  bool cycle_ = between(0.0, 1.0) < 0.5;
  double damping_ = driven_ ? between(0.03, 0.2) : cycle_ ? between(0.03, 0.1) : between(0.0005, 0.004);
  double strength_ = omega_ * omega_ * between(2.0, 4.0) * degree, memory_ = between(0.05, 0.3);
};

struct Answer {
  bool bins = false, regression = false;
};

Answer answer_of(const Signals& signals) {
  const Model model = assemble(eq_8(), registry());
  return {sliding_bin(model, signals).driven, equation_error(model, {signals}).fit.driven};
}

class DrivenMotion : public testing::TestWithParam<bool> {};

TEST_P(DrivenMotion, IsTakenForWhatItIsByBinsAndRegression) {
  constexpr unsigned flights = 200;
  constexpr int most_wrong = 2;
  int bins = 0, regression = 0;
  for (unsigned seed = 1; seed <= flights; ++seed) {
    const Answer answer = answer_of(Tilt(seed, GetParam()).fly());
    bins += answer.bins != GetParam() ? 1 : 0;
    regression += answer.regression != GetParam() ? 1 : 0;
  }
  EXPECT_LE(bins, most_wrong);
  EXPECT_LE(regression, most_wrong);
}

INSTANTIATE_TEST_SUITE_P(Both, DrivenMotion, testing::Bool());

TEST(DrivenMotionSaid, IsSaidOfTheBinsAsItIsGiven) {
  const Signals signals = Tilt(1, false).fly();
  SlidingBinOptions options;
  options.driven = true;
  EXPECT_TRUE(sliding_bin(assemble(eq_8(), registry()), signals, options).driven);
}

TEST(DrivenMotionSaid, OutputErrorSaysWhatTheRegressionSays) {
  for (const bool driven : {true, false}) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const std::vector<Signals> signals{Tilt(seed, driven).fly()};
      const FittedModel start = equation_error(assemble(eq_8(), registry()), signals);
      EXPECT_EQ(output_error(start, signals).fit.driven, start.fit.driven) << seed;
    }
  }
}

std::vector<double> waves(std::size_t samples, double size, double period) {
  std::vector<double> out;
  for (std::size_t i = 0; i < samples; ++i) out.push_back(size * std::sin(2.0 * 3.14159265358979 * static_cast<double>(i) / period));
  return out;
}

TEST(DrivenTest, ComparesAveragesOverHalfAPeriod) {
  constexpr std::size_t samples = 400;
  constexpr int half_period = 20;
  const std::vector<double> t = even_times(samples, 0.1);
  const DrivenTest test =
      test_driven({t, waves(samples, 3.0, 100.0), waves(samples, 6.0, 100.0), [&] { return waves(samples, 0.5, 100.0); }, half_period, 5});
  EXPECT_EQ(test.averaged, half_period);
  EXPECT_NEAR(test.share, 0.5, 1e-9);
  EXPECT_NEAR(test.times_noise, 6.0, 1e-9);
  EXPECT_TRUE(test.driven());
  EXPECT_FALSE(test.deterministic());
}

TEST(DrivenTest, WhatAveragesAwayIsNoForce) {
  constexpr std::size_t samples = 400;
  constexpr int half_period = 20;
  const std::vector<double> t = even_times(samples, 0.1);
  const DrivenTest test =
      test_driven({t, waves(samples, 3.0, 4.0), waves(samples, 6.0, 100.0), [&] { return waves(samples, 0.5, 100.0); }, half_period, 5});
  EXPECT_LT(test.share, 1e-9);
  EXPECT_FALSE(test.driven());
  EXPECT_TRUE(test.deterministic());
}

TEST(DrivenTest, NoiseIsAddedOnceMoreToWhatWasMeasured) {
  const Model model = assemble(eq_8(), registry());
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> levels;
  constexpr double sigma = 0.01;
  for (int i = 0; i < 20'000; ++i) levels.push_back(sigma * normal(random));
  const Signals signals = measured(even_times(levels.size(), 0.01), levels);
  const std::vector<double> noisier = with_more_noise(model.system->spec(), signals).measured.front().values;
  double squares = 0.0;
  for (std::size_t i = 0; i < levels.size(); ++i) squares += std::pow(noisier[i] - levels[i], 2);
  EXPECT_NEAR(std::sqrt(squares / 20'000.0), sigma, 0.03 * sigma);
}

/// A residual is missing at least once in every half period: there is no average.
TEST(DrivenTest, OfResidualsWithAGapInEveryHalfPeriodSaysNothing) {
  constexpr std::size_t samples = 400;
  constexpr int half_period = 20;
  const std::vector<double> t = even_times(samples, 0.1);
  std::vector<double> residual = waves(samples, 3.0, 100.0);
  for (std::size_t i = 0; i < samples; i += 15) residual[i] = std::nan("");
  const DrivenTest test =
      test_driven({t, residual, waves(samples, 6.0, 100.0), [&] { return waves(samples, 0.5, 100.0); }, half_period, 5});
  EXPECT_FALSE(test.tested());
  EXPECT_FALSE(test.driven());
  EXPECT_FALSE(test.deterministic());
  EXPECT_NE(in_words(test).find("not tested for a force: nowhere are 20 of them"), std::string::npos) << in_words(test);
}

}  // namespace
}  // namespace misfit
