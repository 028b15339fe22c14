// The sums of sliding_bin against Eq. 11 of the paper (lib/misfit/README.md, [1]) solved densely, without the model mechanism.
#include "misfit/fit/regression/bin_equations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/math/decompositions.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_planar;
using testing::SizeIs;

constexpr double standard_gravity = 9.80665;

/// A sample as the paper's Eq. 10 has it.
struct Sample {
  double alpha, rate, acceleration, phi;
};

/// The paper's Eqs. 10 and 11 for one bin, as they are printed: dense, with I, q, S, D, V, m, R_cp. Returns mean alpha_T, C_m there,
/// C_m_alphadot.
Eigen::Vector3d eq_11(const std::vector<Sample>& bin, bool gravity) {
  const auto k = table_1();
  const double I = (k.at("m") + k.at("m_a")) * k.at("R_cp") * k.at("R_cp");
  const double moment_scale = k.at("qbar") * k.at("S") * k.at("D");
  const auto n = static_cast<Eigen::Index>(bin.size());
  Eigen::MatrixXd A(n, 3);
  Eigen::VectorXd moment(n);
  double mean = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Sample& s = bin[static_cast<std::size_t>(i)];
    A.row(i) << s.rate, s.alpha, 1.0;
    const double weight = gravity ? k.at("m") * standard_gravity * k.at("R_cp") * std::cos(s.phi) * std::cos(s.alpha) : 0.0;
    moment[i] = (I * s.acceleration - weight) / moment_scale;
    mean += s.alpha / static_cast<double>(n);
  }
  const Eigen::Vector3d c = least_squares(A, moment);
  return {mean, c[1] * mean + c[2], c[0] * 2.0 * k.at("V") / k.at("D")};
}

/// Averages and derivatives written out once more, for even steps.
std::vector<Sample> samples_of(const Signals& signals, Stencils stencils) {
  const auto& f = signals.measured[0].values;
  std::vector<double> a(f.size(), 0.0);
  for (std::size_t i = 1; i + 1 < f.size(); ++i) a[i] = (f[i - 1] + f[i] + f[i + 1]) / 3.0;
  std::vector<Sample> out;
  for (std::size_t i = 3; i + 3 < f.size(); ++i) {
    const double h = (signals.t[i + 2] - signals.t[i - 2]) / 4.0;
    Sample s{a[i], 0.0, 0.0, signals.inputs[0].values[i]};
    if (stencils == Stencils::fourth_order) {
      s.rate = (a[i - 2] - 8 * a[i - 1] + 8 * a[i + 1] - a[i + 2]) / (12 * h);
      s.acceleration = (-a[i - 2] + 16 * a[i - 1] - 30 * a[i] + 16 * a[i + 1] - a[i + 2]) / (12 * h * h);
    } else {
      s.rate = (2 * (a[i + 2] - a[i - 2]) + a[i + 1] - a[i - 1]) / (10 * h);
      s.acceleration = (a[i - 2] - a[i - 1] - a[i + 1] + a[i + 2]) / (3 * h * h);
    }
    out.push_back(s);
  }
  return out;
}

void expect_equals_dense(const Signals& signals, const SlidingBinOptions& options, bool gravity) {
  std::vector<std::string> effects = {"static_moment", "pitch_damping"};
  if (gravity) effects.emplace_back("gravity");
  const Fit fit = sliding_bin(assemble(eq_8(effects), registry()), signals, options);
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  ASSERT_THAT(fit.curves, SizeIs(2));
  std::vector<Sample> samples = samples_of(signals, options.stencils);
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.alpha < b.alpha; });
  std::size_t bins = 0;
  for (double k = std::floor(samples.front().alpha / options.step);; k += 1.0) {
    const double low = k * options.step, high = low + options.width;
    std::vector<Sample> bin;
    for (const auto& s : samples) {
      if (s.alpha >= low && s.alpha < high) bin.push_back(s);
    }
    if (bin.size() >= options.minimum_samples) {
      ASSERT_LT(bins, fit.curves[0].x.size());
      const Eigen::Vector3d expected = eq_11(bin, gravity);
      EXPECT_EQ(fit.curves[0].count[bins], static_cast<double>(bin.size()));
      EXPECT_NEAR(fit.curves[0].x[bins], expected[0], 1e-12);
      EXPECT_NEAR(fit.curves[0].value[bins], expected[1], 1e-9 * std::abs(expected[1])) << fit.curves[0].x[bins] / degree << " deg";
      EXPECT_NEAR(fit.curves[1].value[bins], expected[2], 1e-9 * std::abs(expected[2])) << fit.curves[1].x[bins] / degree << " deg";
      ++bins;
    }
    if (high > samples.back().alpha) break;
  }
  EXPECT_EQ(bins, fit.curves[0].x.size());
  EXPECT_GT(bins, 50U);
  EXPECT_NEAR(fit.parameters.at("C_m_alphadot_all_data").value, eq_11(samples, gravity)[2], 1e-9);
}

TEST(SlidingBin, EqualsDenseLeastSquaresOfEq11) {
  SlidingBinOptions options;
  for (Stencils stencils : {Stencils::fourth_order, Stencils::second_order_four_point}) {
    options.stencils = stencils;
    expect_equals_dense(validation_signals(), options, false);
  }
}

TEST(SlidingBin, EqualsDenseLeastSquaresWithGravityOverAnyClockAngleAndOtherBins) {
  Signals signals = validation_signals();
  for (std::size_t i = 0; i < signals.samples(); ++i) signals.inputs[0].values[i] = 0.7 * signals.t[i];
  SlidingBinOptions options;
  options.width = 0.73 * degree;
  options.step = 0.11 * degree;
  options.minimum_samples = 11;
  expect_equals_dense(signals, options, true);
}

TEST(SlidingBin, TakesTheGravityTermOffAtItsWorkedSize) {
  // m g R_cp/I = 0.206 x 9.80665 x 3.15/(0.5 x 3.15²) = 6.3635352/4.96125 = 1.2826475 rad/s²; with phi = 60 deg and alpha_T = 10 deg:
  // 1.2826475 x 0.5 x 0.98480775 = 0.63158 rad/s². Static gain moment_scale/I = 2276.1948/4.96125 = 458.79462; damping gain at 0.3 rad/s:
  // x 1.5816/70.2 x 0.3.
  const Model model = assemble(eq_8({"static_moment", "pitch_damping", "gravity"}), registry());
  Signals signals = measured(even_times(11, 0.1), {});
  for (double t : signals.t) signals.measured[0].values.push_back(10.0 * degree + 0.3 * (t - 0.5));
  signals.inputs[0].values.assign(11, 60.0 * degree);
  std::string why;
  const auto form = bin_form(model, signals, why);
  ASSERT_TRUE(form) << why;
  const auto equations = bin_equations(*form, signals, stencil_states(*form, signals, Stencils::fourth_order, false));
  ASSERT_THAT(equations, SizeIs(7));
  const BinEquation& middle = equations[3];
  EXPECT_EQ(middle.sample, 5U);
  EXPECT_NEAR(middle.x, 10.0 * degree, 1e-12);
  EXPECT_NEAR(middle.y, -0.63158, 1e-5);
  EXPECT_NEAR(middle.known, 0.63158, 1e-5);
  EXPECT_NEAR(middle.static_gain, 458.79462, 1e-3);
  EXPECT_NEAR(middle.damping_gain, 458.79462 * 1.5816 / 70.2 * 0.3, 1e-4);
}

TEST(SlidingBin, GainsHoldBelowZeroWhereCurvesHaveASymmetry) {
  const Model model = assemble(eq_8(), registry());
  const Signals signals = measured(even_times(7, 0.1), std::vector<double>(7, -8.0 * degree));
  std::string why;
  const auto form = bin_form(model, signals, why);
  ASSERT_TRUE(form) << why;
  for (const auto& e : bin_equations(*form, signals, stencil_states(*form, signals, Stencils::fourth_order, false)))
    EXPECT_NEAR(e.static_gain, 458.79462, 1e-3);
}

}  // namespace
}  // namespace misfit
