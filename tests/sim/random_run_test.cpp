// Realisations of models with random own states.
#include "misfit/sim/random_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/cases.h"

namespace misfit {
namespace {

using namespace testing_models;

Signals clock(std::size_t samples, double step) {
  Signals s;
  for (std::size_t i = 0; i < samples; ++i) s.t.push_back(static_cast<double>(i) * step);
  return s;
}

/// The spherical parachute with gusts and jitter: hanging in the wind as a pendulum would be, without static moment.
Model random_model(double sigma, double jitter) {
  ModelRequest r = spherical();
  r.effects = {effect("gust"), effect("apex_jitter")};
  r.curves.clear();
  Model m = assemble(r, registry());
  set(m, "gust_sigma", sigma);
  set(m, "jitter", jitter);
  set(m, "jitter_damping", 0.2);
  return m;
}

RowMatrix pixels(const Model& m, const Signals& signals, unsigned seed) {
  Stepper stepper(m);
  std::mt19937_64 random(seed);
  const std::vector<double> x0(static_cast<std::size_t>(m.states()), 0.0);
  Segment out;
  run_randomly({stepper, signals, input_table(signals, m)}, x0.data(), random, out);
  EXPECT_TRUE(out.finite);
  return out.y;
}

TEST(RandomRun, JitterHasTheVarianceAndTheFrequencyItSays) {
  // Motion off: what is left in the pixels is 1.5 px of jitter at 9 Hz, damping ratio 0.2, in both axes.
  const Signals signals = clock(20000, 1.0 / 59.94);
  const RowMatrix y = pixels(random_model(0.0, 1.5), signals, 3);
  for (Eigen::Index o = 0; o < 2; ++o) {
    const Eigen::ArrayXd e = y.col(o).array() - y.col(o).mean();
    const Eigen::Index n = e.size();
    const double variance = e.square().mean();
    EXPECT_NEAR(std::sqrt(variance), 1.5, 0.05);
    // Autocorrelation of the resonator: exp(-zeta w t) (cos w_d t + zeta/sqrt(1 - zeta²) sin w_d t).
    const double w = 2.0 * 3.14159265358979 * 9.0, zeta = 0.2, w_d = w * std::sqrt(1.0 - zeta * zeta);
    for (Eigen::Index lag : {1, 2, 4, 7}) {
      const double t = static_cast<double>(lag) / 59.94;
      const double expected = std::exp(-zeta * w * t) * (std::cos(w_d * t) + zeta / std::sqrt(1.0 - zeta * zeta) * std::sin(w_d * t));
      const double measured = (e.head(n - lag) * e.tail(n - lag)).mean() / variance;
      EXPECT_NEAR(measured, expected, 0.04) << "lag " << lag;
    }
  }
}

TEST(RandomRun, GustsMoveTheAxisAsWhiteNoiseThroughTwoIntegrationsWould) {
  // Long against tau the moment is white with density 2 sigma² tau: var of the rate after T is 2 sigma² tau (T - tau (3 - 4 e + e²)/2)/I²,
  // e = exp(-T/tau), exactly, for small tilts and gusts that start at 0.
  constexpr double sigma = 2.0, tau = 0.1, T = 0.6, I = 0.5 * 3.15 * 3.15;
  const Model m = random_model(sigma, 0.0);
  const Signals signals = clock(37, T / 36.0);
  const double e = std::exp(-T / tau);
  const double expected = 2.0 * sigma * sigma * tau * (T - tau * (3.0 - 4.0 * e + e * e) / 2.0) / (I * I);
  double sum = 0.0;
  constexpr int runs = 1500;
  for (int run = 0; run < runs; ++run) {
    Stepper stepper(m);
    std::mt19937_64 random(static_cast<unsigned>(100 + run));
    const std::vector<double> x0(static_cast<std::size_t>(m.states()), 0.0);
    Segment out;
    run_randomly({stepper, signals, input_table(signals, m)}, x0.data(), random, out);
    ASSERT_TRUE(out.finite);
    sum += out.end[2] * out.end[2] + out.end[3] * out.end[3];
  }
  const double sampling = std::sqrt(2.0 / (2.0 * runs));  // relative, one sigma, two axes
  EXPECT_NEAR(sum / (2.0 * runs) / expected, 1.0, 3.5 * sampling);
}

TEST(RandomRun, OneSeedGivesOneRealisation) {
  const Signals signals = clock(60, 1.0 / 59.94);
  const Model m = random_model(1.0, 1.0);
  const RowMatrix a = pixels(m, signals, 7), b = pixels(m, signals, 7), c = pixels(m, signals, 8);
  EXPECT_EQ((a - b).norm(), 0.0);
  EXPECT_GT((a - c).norm(), 1.0);
}

TEST(RandomRun, KnowsWhetherAnythingIsRandom) {
  const Model quiet = assemble(spherical(), registry());
  Evaluator a(quiet);
  const std::vector<double> x(16, 0.0);
  EXPECT_FALSE(has_random_states(a, x.data(), nullptr, 0.0));
  const Model loud = random_model(10.0, 1.0);
  Evaluator b(loud);
  EXPECT_TRUE(has_random_states(b, x.data(), nullptr, 0.0));
}

TEST(RandomRun, WithoutNoiseItIsTheTrajectory) {
  Model m = assemble(parachute(true, {effect("lag")}), registry());
  set_parachute_curves(m);
  set(m, "lag_stiffness", 50.0);
  Signals signals = clock(120, 1.0 / 59.94);
  signals.inputs = {{"phi", "rad", std::vector<double>(120, 0.3), 0.0}, {"phi_rate", "rad/s", std::vector<double>(120, 0.0), 0.0}};
  for (std::size_t i = 0; i < 120; ++i) signals.inputs[1].values[i] = std::sin(0.1 * static_cast<double>(i));
  const InputTable inputs = input_table(signals, m);
  const std::vector<double> x0 = {0.3, 0.1, 0.25};
  Stepper stepper(m);
  Segment exact, out;
  run_segment({stepper, signals, inputs}, {0, 120, x0.data()}, exact);
  std::mt19937_64 random(1);
  run_randomly({stepper, signals, inputs}, x0.data(), random, out);
  EXPECT_LT((out.y - exact.y).cwiseAbs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace misfit
