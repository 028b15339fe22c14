#include "misfit/fit/regression/sliding_bin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "misfit/core/error.h"
#include "tests/fit/planar_model.h"
#include "tests/paths.h"

namespace misfit {
namespace {

using namespace testing_planar;
using testing::HasSubstr;

/// The moment curves the validation motion was made with.
double true_C_m(double alpha_deg) {
  static const Table curve = read_csv(paths::source() / "configs/validation/figure5.csv");
  static const auto x = curve.values("alpha_T", "deg"), y = curve.values("C_m", "-");
  const auto next = std::max<std::ptrdiff_t>(std::upper_bound(x.begin(), x.end(), alpha_deg) - x.begin(), 1);
  const auto i = static_cast<std::size_t>(next);
  return y[i - 1] + (y[i] - y[i - 1]) * (alpha_deg - x[i - 1]) / (x[i] - x[i - 1]);
}

struct Errors {
  double C_m = 0.0, damping_middle = 0.0,
         damping_outside = 0.0;  ///< rms over 8 … 15.5 deg; mean damping within 11.75 … 12.25 deg and at 9.5 … 10 or 14 … 14.5
};
Errors errors_of(const Fit& fit) {
  Errors out;
  double n = 0.0, middle = 0.0, outside = 0.0;
  for (std::size_t i = 0; i < fit.curves[0].x.size(); ++i) {
    const double alpha = fit.curves[0].x[i] / degree, damping = fit.curves[1].value[i];
    if (alpha < 8.0 || alpha > 15.5) continue;
    out.C_m += std::pow(fit.curves[0].value[i] - true_C_m(alpha), 2);
    n += 1.0;
    if (std::abs(alpha - 12.0) < 0.25) out.damping_middle += damping, middle += 1.0;
    if (std::abs(alpha - 9.75) < 0.25 || std::abs(alpha - 14.25) < 0.25) out.damping_outside += damping, outside += 1.0;
  }
  return {std::sqrt(out.C_m / n), out.damping_middle / middle, out.damping_outside / outside};
}

class Validation : public testing::TestWithParam<Stencils> {
 protected:
  static Fit fit(const std::string& column) {
    SlidingBinOptions options;
    options.stencils = GetParam();
    return sliding_bin(assemble(eq_8(), registry()), validation_signals(column), options);
  }
};

TEST_P(Validation, ReturnsTheCurvesTheMotionWasMadeWith) {
  const Fit fit = Validation::fit("alpha_T");
  const Errors e = errors_of(fit);
  const bool fourth = GetParam() == Stencils::fourth_order;
  std::printf(
      "%s: C_m rms error %.3g over 8 to 15.5 deg; C_m_alphadot %.3f near 12 deg (true 0.1), %.3f near 9.75 and 14.25 deg (true -0.1); trim "
      "%.3f deg\n",
      fourth ? "fourth order" : "second order", e.C_m, e.damping_middle, e.damping_outside, fit.trim->value / degree);
  EXPECT_LT(e.C_m, fourth ? 1.4e-3 : 5e-4);                   // measured 6.8e-4 and 2.6e-4; C_m itself is up to 0.03 there
  EXPECT_NEAR(e.damping_middle, fourth ? 0.09 : 0.06, 0.02);  // bin and average flatten the step from −0.1 to 0.1: the paper's Fig. 7b
  EXPECT_NEAR(e.damping_outside, -0.09, 0.03);
  EXPECT_NEAR(fit.trim->value / degree, 12.0, 0.1);
}

TEST_P(Validation, WithoutNoiseOnlyTheBinsAndStencilsErr) {
  const Errors e = errors_of(Validation::fit("alpha_T_true"));
  EXPECT_LT(e.C_m, GetParam() == Stencils::fourth_order ? 2e-4 : 4e-4);  // measured 1.0e-4 and 2.5e-4
}

TEST_P(Validation, IsDeterministicMotionWhoseBinsHold) {
  for (const char* column : {"alpha_T", "alpha_T_true"}) {
    const Fit fit = Validation::fit(column);
    EXPECT_FALSE(fit.driven) << fit.facts.at("whiteness");
    EXPECT_TRUE(fit.curves[1].informative);
    EXPECT_THAT(fit.facts.at("telescoped_sum"), HasSubstr("within 2 sigma of 0"));
    EXPECT_NEAR(fit.parameters.at("C_m_alphadot_all_data").value, 0.0, 0.01);
    EXPECT_THAT(fit.warnings, testing::Contains(HasSubstr("0 by construction")));
    EXPECT_TRUE(fit.predictions.empty());
  }
}

TEST_P(Validation, SigmasAreTheScatterOverDrawsOfNoise) {
  const Model model = assemble(eq_8(), registry());
  SlidingBinOptions options;
  options.stencils = GetParam();
  options.step = options.width;  // bins side by side from 9, 10.5, 12 and 13.5 deg: each is found by its mean level
  constexpr std::size_t bins = 4;
  constexpr int draws = 60;
  std::vector<double> value, squares, sigma, damping, damping_squares, damping_sigma;
  for (unsigned seed = 1; seed <= draws; ++seed) {
    Signals signals = validation_signals("alpha_T_true");
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> noise(0.0, 0.1 * degree);
    for (double& x : signals.measured[0].values) x += noise(generator);
    const Fit fit = sliding_bin(model, signals, options);
    for (auto* sums : {&value, &squares, &sigma, &damping, &damping_squares, &damping_sigma}) sums->resize(bins);
    for (std::size_t j = 0; j < bins; ++j) {
      std::size_t i = 0;
      while (fit.curves[0].x[i] < (9.0 + 1.5 * static_cast<double>(j)) * degree) ++i;
      value[j] += fit.curves[0].value[i] / draws;
      squares[j] += std::pow(fit.curves[0].value[i], 2) / draws;
      sigma[j] += fit.curves[0].sigma[i] / draws;
      damping[j] += fit.curves[1].value[i] / draws;
      damping_squares[j] += std::pow(fit.curves[1].value[i], 2) / draws;
      damping_sigma[j] += fit.curves[1].sigma[i] / draws;
    }
  }
  for (std::size_t j = 0; j < bins; ++j) {  // a scatter of 60 draws is known to 9 %
    EXPECT_NEAR(std::sqrt(squares[j] - value[j] * value[j]) / sigma[j], 1.0, 0.3) << j;
    EXPECT_NEAR(std::sqrt(damping_squares[j] - damping[j] * damping[j]) / damping_sigma[j], 1.0, 0.3) << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Validation, testing::Values(Stencils::fourth_order, Stencils::second_order_four_point),
                         [](const auto& tested) { return tested.param == Stencils::fourth_order ? "FourthOrder" : "SecondOrder"; });

/// alpha'' = −ω² (alpha − 12 deg) + 2 ζ ω alpha' + random acceleration with memory (Ornstein–Uhlenbeck, 0.1 s), at 59.94 Hz.
Signals driven_motion(double zeta, unsigned seed) {
  constexpr double omega = 10.0, strength = 5.0, memory = 0.1, h = 1.0 / 59.94;
  constexpr int substeps = 20, samples = 4800;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  double alpha = 12.0 * degree, rate = 0.0, force = 0.0;
  std::vector<double> levels;
  for (int i = 0; i < samples; ++i) {
    levels.push_back(alpha + 0.05 * degree * normal(generator));
    for (int k = 0; k < substeps; ++k) {
      constexpr double d = h / substeps;
      force += -force * d / memory + strength * std::sqrt(2.0 * d / memory) * normal(generator);
      rate += d * (-omega * omega * (alpha - 12.0 * degree) - 2.0 * zeta * omega * rate + force);
      alpha += d * rate;
    }
  }
  return measured(even_times(samples, h), levels);
}

TEST(SlidingBin, OnDrivenMotionSaysThatItsDampingIsNotInformative) {
  SlidingBinOptions options;
  options.width = 4.0 * degree;
  options.step = 1.0 * degree;
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), driven_motion(0.1, 1), options);
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_TRUE(fit.driven) << fit.facts.at("whiteness");
  EXPECT_TRUE(fit.curves[0].informative);
  EXPECT_FALSE(fit.curves[1].informative);
  EXPECT_THAT(fit.curves[1].why, HasSubstr("telescopes"));
  EXPECT_THAT(fit.facts.at("telescoped_sum"), HasSubstr("within 2 sigma of 0"));
  // True damping: −2 ζ ω in units of the damping gain, 458.79 x 1.5816/70.2 = 10.337 1/s: −0.19. All data say 0.
  EXPECT_NEAR(fit.parameters.at("C_m_alphadot_all_data").value, 0.0, 0.02);
}

TEST(SlidingBin, LeavesOutMissingSamplesGapsAndUnevenTime) {
  Signals signals = validation_signals();
  auto& values = signals.measured[0].values;
  const std::size_t whole = signals.samples() - 6;  // three lost at either end
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  values[1000] = nan_value;                                                    // 7 accelerations
  for (std::size_t i = 2000; i < 2020; ++i) values[i] = nan_value;             // 26
  for (std::size_t i = 3000; i < signals.samples(); ++i) signals.t[i] += 0.5;  // a gap: 6
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), signals);
  ASSERT_EQ(fit.status, FitStatus::converged);
  EXPECT_THAT(fit.facts.at("bins"), HasSubstr("over " + std::to_string(whole - 7 - 26 - 6) + " usable samples"));
  EXPECT_LT(errors_of(fit).C_m, 1e-3);
}

TEST(SlidingBin, DoesNotTouchHeldOutOrExcludedSamples) {
  Signals signals = validation_signals();
  signals.exclude = 100;
  signals.validation_from = signals.t[3000];
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), signals);
  for (std::size_t i = 3000; i < signals.samples(); ++i) signals.measured[0].values[i] = 1e3;
  const Fit spoiled = sliding_bin(assemble(eq_8(), registry()), signals);
  EXPECT_THAT(fit.facts.at("bins"), HasSubstr("over " + std::to_string(3000 - 3 - 100) + " usable samples"));
  EXPECT_EQ(fit.curves[0].value, spoiled.curves[0].value);
  EXPECT_EQ(fit.curves[1].value, spoiled.curves[1].value);
}

TEST(SlidingBin, WithoutTheAverageUsesTheChannelAsItIs) {
  const Signals signals = validation_signals();
  Signals averaged = signals;
  averaged.measured[0].values = average_of_three(signals.t, signals.measured[0].values);
  SlidingBinOptions given;
  given.three_point_average = false;
  const Model model = assemble(eq_8(), registry());
  EXPECT_EQ(sliding_bin(model, averaged, given).curves[0].value, sliding_bin(model, signals).curves[0].value);
  EXPECT_NE(sliding_bin(model, signals, given).curves[0].value, sliding_bin(model, signals).curves[0].value);
}

TEST(SlidingBin, TellsBothReadingsOfTheStencils) {
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), validation_signals());
  EXPECT_THAT(fit.facts.at("stencils"), testing::AllOf(HasSubstr("second-order four-point stencils; with the fourth-order ones"),
                                                       HasSubstr("C_m by at most"), HasSubstr("trim")));
}

TEST(SlidingBin, OfAConstantSignalDeclinesInWords) {
  const auto t = even_times(1000, 1.0 / 59.94);
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), measured(t, std::vector<double>(t.size(), 0.2)));
  EXPECT_EQ(fit.status, FitStatus::declined);
  EXPECT_THAT(fit.message, HasSubstr("alpha_T does not move"));
  EXPECT_TRUE(fit.curves.empty());
}

TEST(SlidingBin, OfTooFewOrTooThinlySpreadSamplesDeclinesInWords) {
  const Model model = assemble(eq_8(), registry());
  const auto few = even_times(30, 0.01);
  EXPECT_THAT(sliding_bin(model, measured(few, few)).message, HasSubstr("only 24 samples of alpha_T"));
  const auto many = even_times(200, 0.01);
  std::vector<double> ramp;
  for (double t : many) ramp.push_back(t + 0.01 * std::sin(30.0 * t));
  EXPECT_THAT(sliding_bin(model, measured(many, ramp)).message, HasSubstr("no bin holds 30 samples"));
  ramp[100] = 1e6;
  EXPECT_THAT(sliding_bin(model, measured(many, ramp)).message, HasSubstr("outlier in the data"));
  EXPECT_EQ(sliding_bin(model, measured({}, {})).status, FitStatus::declined);
}

TEST(SlidingBin, OfAModelWithoutItsCurvesDeclinesInWords) {
  const Signals signals = validation_signals();
  EXPECT_THAT(sliding_bin(assemble(eq_8({"static_moment"}), registry()), signals).message, HasSubstr("no coefficient C_m_alphadot"));
  EXPECT_THAT(sliding_bin(assemble(eq_8({"pitch_damping"}), registry()), signals).message, HasSubstr("no curve C_m"));
  Signals nothing = signals;
  nothing.measured.clear();
  EXPECT_THAT(sliding_bin(assemble(eq_8(), registry()), nothing).message, HasSubstr("not one equation of motion"));
}

TEST(SlidingBin, RefusesBinsThatMakeNoSense) {
  const Model model = assemble(eq_8(), registry());
  const Signals signals = validation_signals();
  SlidingBinOptions options;
  options.width = -1.0;
  EXPECT_THROW(static_cast<void>(sliding_bin(model, signals, options)), InputError);
  options = {};
  options.step = 0.0;
  EXPECT_THROW(static_cast<void>(sliding_bin(model, signals, options)), InputError);
  options = {};
  options.minimum_samples = 3;
  EXPECT_THROW(static_cast<void>(sliding_bin(model, signals, options)), InputError);
}

TEST(SlidingBin, TakesTheDampingAsANumberAsWell) {
  ModelRequest request = eq_8();
  request.curves.erase("C_m_alphadot");
  request.parameters["C_m_alphadot"].value = -0.5;  // its present value is of no account
  const Model model = assemble(request, registry());
  const Fit number = sliding_bin(model, validation_signals()), curve = sliding_bin(assemble(eq_8(), registry()), validation_signals());
  EXPECT_THAT(number.curves[1].value, testing::Pointwise(testing::DoubleNear(1e-10), curve.curves[1].value));
}

/// 40 rad/s about 12 deg, a little noise.
Signals fast_swing(std::size_t samples) {
  const auto t = even_times(samples, 0.001);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> level;
  for (const double at : t) level.push_back((12.0 + 4.0 * std::sin(40.0 * at) + 0.001 * normal(random)) * degree);
  return measured(t, level);
}

TEST(SlidingBin, TheTelescopedSumOfARecordBelowASecondHasTheScatterOfItsPeriods) {
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), fast_swing(900));
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_THAT(fit.facts.at("telescoped_sum"), HasSubstr("within 2 sigma of 0"));
}

TEST(SlidingBin, TheTelescopedSumOfLessThanTwoPeriodsIsNotDistinguishedFromZero) {
  SlidingBinOptions options;
  options.minimum_samples = 6;
  const Fit fit = sliding_bin(assemble(eq_8(), registry()), fast_swing(150), options);
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_THAT(fit.facts.at("telescoped_sum"), HasSubstr("not to be distinguished from 0"));
}

}  // namespace
}  // namespace misfit
