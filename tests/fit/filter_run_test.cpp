#include "misfit/fit/filter/filter_run.h"

#include <gtest/gtest.h>

#include <numbers>

#include "misfit/math/decompositions.h"
#include "tests/fit/cart_filter.h"

namespace misfit {
namespace {

using namespace testing_cart;

double dense_loglik(const Dense& dense) {
  const Eigen::VectorXd off = dense.y - dense.y_mean;
  const double log_root = cholesky(dense.y_covariance).value().diagonal().array().log().sum();
  return -0.5 * off.dot(symmetric_solve(dense.y_covariance, off)) - log_root -
         0.5 * static_cast<double>(dense.y.size()) * std::log(2.0 * std::numbers::pi);
}

TEST(FilterRun, LikelihoodOfALinearSystemIsTheDensityOfItsReadings) {
  const Cart cart(25);
  const FilterTrace trace = cart.run();
  EXPECT_EQ(trace.counted, 50U);
  EXPECT_NEAR(trace.loglik, dense_loglik(Dense(cart, trace)), 1e-8 * std::abs(trace.loglik));
}

TEST(FilterRun, MissingReadingsAreLongerPredictions) {
  Cart cart(25);
  for (std::size_t at : {8U, 9U, 10U, 11U, 12U, 13U, 30U}) cart.data.use[at] = SampleRole::none;
  const FilterTrace trace = cart.run();
  EXPECT_EQ(trace.counted, 43U);
  EXPECT_NEAR(trace.loglik, dense_loglik(Dense(cart, trace)), 1e-8 * std::abs(trace.loglik));
  EXPECT_GT(trace.y_variance[12], 2.0 * trace.y_variance[6]) << "three samples without a measurement";
}

TEST(FilterRun, SmootherGivesTheConditionalMeanAndVariance) {
  Cart cart(20);
  for (std::size_t at : {10U, 11U, 12U}) cart.data.use[at] = SampleRole::none;
  const FilterTrace trace = cart.run(nullptr, true);
  const Dense dense(cart, trace);
  const Smoothing smooth = smooth_states(trace, cart.data, cart.noise);
  const Eigen::MatrixXd gain = symmetric_solve(dense.y_covariance, Eigen::MatrixXd(dense.cross.transpose())).transpose();
  const Eigen::VectorXd mean = dense.state_mean + gain * (dense.y - dense.y_mean);
  const Eigen::MatrixXd covariance = dense.states - gain * dense.cross.transpose();
  for (Eigen::Index k = 0; k < 20; ++k) {
    for (Eigen::Index i = 0; i < trace.n; ++i) {
      const Eigen::Index at = k * dense.n + i;
      const double sigma = std::sqrt(covariance(at, at));
      EXPECT_NEAR(smooth.x(k, i), mean[at], 1e-7 * sigma) << k << ' ' << i;
      EXPECT_NEAR(smooth.variance(k, i), sigma * sigma, 1e-7 * sigma * sigma) << k << ' ' << i;
    }
  }
}

TEST(RunLinear, AtTheSameNoiseRepeatsTheRun) {
  const Cart cart(200);
  const FilterTrace trace = cart.run();
  const Innovations innovations = run_linear(cart.model, cart.data, trace, cart.noise);
  EXPECT_NEAR(-minus_loglik(cart.data, innovations), trace.loglik, 1e-8 * std::abs(trace.loglik));
  for (std::size_t i = 0; i < trace.e.size(); ++i) EXPECT_NEAR(innovations.e[i], trace.e[i], 1e-10) << i;
}

/// On a linear system the run about a trace is the run itself, but for how the correlation time enters the step: first order there.
TEST(RunLinear, DerivativesByNoiseAreThoseOfWholeRuns) {
  Cart cart(200);
  const FilterTrace trace = cart.run();
  const SystemSpec& spec = cart.model.model.system->spec();
  const FilterNoise noise = cart.noise;
  const NoiseVector at = pack(noise, spec, noise);
  for (std::size_t i = 0; i < at.value.size(); ++i) {
    constexpr double h = 1e-3;
    std::array<double, 2> linear{}, whole{};
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<double> logs = at.value;
      logs[i] += side == 0 ? -h : h;
      cart.noise = unpack(logs, spec);
      linear[side] = -minus_loglik(cart.data, run_linear(cart.model, cart.data, trace, cart.noise));
      cart.model.model.parameters[static_cast<std::size_t>(cart.model.time_parameter)].value = cart.noise.force_time;
      whole[side] = cart.run().loglik;
      cart.model.model.parameters[static_cast<std::size_t>(cart.model.time_parameter)].value = noise.force_time;
    }
    const double exact = (whole[1] - whole[0]) / (2.0 * h), found = (linear[1] - linear[0]) / (2.0 * h);
    EXPECT_NEAR(found, exact, (at.names[i] == "force_time" ? 0.03 : 1e-5) * std::abs(exact) + 1e-5) << at.names[i];
  }
}

/// Innovations of the run with a parameter moved and every gain as it was.
std::vector<double> with_gains_fixed(const Cart& cart, const FilterTrace& trace, const std::vector<double>& values) {
  Model moved = cart.model.model;
  for (std::size_t i = 0; i < values.size(); ++i) moved.parameters[i].value = values[i];
  Stepper stepper(moved);
  Eigen::VectorXd x = cart.data.start, coloured = Eigen::VectorXd::Zero(4);
  stepper.prepare(x.data(), cart.data.inputs.at(0), 0.0);
  std::vector<double> out;
  for (std::size_t k = 0; k < trace.samples; ++k) {
    const Eigen::VectorXd predicted = x;
    std::array<double, kMaxOutputs + 1> y{};
    stepper.evaluator().predict(predicted.data(), cart.data.inputs.at(k), cart.signals.t[k], y.data());
    for (std::size_t o = 0; o < 2; ++o) {
      const std::size_t at = 2 * k + o;
      const Eigen::Map<const Eigen::VectorXd> H(trace.H.data() + at * 3, 3), K(trace.K.data() + at * 3, 3), Kj(trace.Kj.data() + at * 4, 4);
      const double e = cart.signals.measured[o].values[k] - y[o] - H.dot(x - predicted) - coloured[2 * static_cast<Eigen::Index>(o)];
      out.push_back(e / std::sqrt(trace.S[at]));
      x += K * e;
      coloured += Kj * e;
    }
    if (k + 1 == trace.samples) break;
    const double t0 = cart.signals.t[k], t1 = cart.signals.t[k + 1];
    EXPECT_TRUE(stepper.step(x.data(), {t0, t1, cart.data.inputs.at(k), cart.data.inputs.at(k + 1)}));
    const NoiseStep step = discretise(cart.noise, t1 - t0);
    for (Eigen::Index o = 0; o < 2; ++o) {
      const auto& p = step.coloured[static_cast<std::size_t>(o)].phi;
      const double first = coloured[2 * o], second = coloured[2 * o + 1];
      coloured[2 * o] = p[0] * first + p[1] * second;
      coloured[2 * o + 1] = p[2] * first + p[3] * second;
    }
  }
  return out;
}

TEST(FilterJacobian, IsTheDerivativeOfInnovationsWithGainsFixed) {
  const Cart cart(120);
  FilterJacobian jacobian;
  const FilterTrace trace = cart.run(&jacobian);
  ASSERT_EQ(jacobian.J.cols(), 1);
  std::vector<double> values = cart.model.model.values();
  const auto stiffness = static_cast<std::size_t>(cart.model.model.find_parameter("stiffness"));
  constexpr double h = 1e-3;
  values[stiffness] += h;
  const std::vector<double> plus = with_gains_fixed(cart, trace, values);
  values[stiffness] -= 2.0 * h;
  const std::vector<double> minus = with_gains_fixed(cart, trace, values);
  const double size = jacobian.J.cwiseAbs().maxCoeff();
  for (Eigen::Index r = 0; r < jacobian.J.rows(); ++r) {
    const auto i = static_cast<std::size_t>(r);
    EXPECT_NEAR(jacobian.J(r, 0), -(plus[i] - minus[i]) / (2.0 * h), 1e-6 * size) << r;
    EXPECT_NEAR(jacobian.r[r], -trace.e[i] / std::sqrt(trace.S[i]), 1e-12);
  }
}

TEST(FilterRun, AStateThatLeavesTheNumbersIsToldWithItsSample) {
  Cart cart(50);
  cart.data.start[0] = std::nan("");
  FilterRunner runner(cart.model, false);
  runner.set_parameters(cart.model.model.values());
  FilterTrace trace;
  EXPECT_FALSE(runner.run(cart.data, cart.noise, trace));
  EXPECT_EQ(trace.failed_at, 0U);
}

}  // namespace
}  // namespace misfit
