#pragma once

// A linear system for the filter: the cart on a spring with a random force, measurements of place and speed. Everything about it can be
// written down as one Gaussian density.

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_run.h"
#include "tests/model/requests.h"

namespace misfit::testing_cart {

using namespace testing_models;

inline FilterNoise usual() { return {3.0, 0.2, {{0.02, 0.03, 4.0, 0.2}, {0.05, 0.04, 6.0, 0.3}}}; }

/// A record with its model; not to be copied: the data point to the signals.
struct Cart {
  FilterModel model;
  Signals signals;
  FilterData data;
  FilterNoise noise = usual();

  explicit Cart(std::size_t samples, unsigned seed = 5, const std::vector<EffectRequest>& effects = {}) {
    Model bare = assemble(cart(effects), registry());
    bare.parameters[static_cast<std::size_t>(bare.find_parameter("stiffness"))].free = true;
    model = with_random_force(bare);
    model.model.parameters[static_cast<std::size_t>(model.time_parameter)].value = noise.force_time;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    signals.name = "cart";
    signals.inputs = {{"drive", "N", {}}};
    signals.measured = {{"position_reading", "-", {}}, {"speed_reading", "m/s", {}}};
    constexpr double h = 0.02;
    for (std::size_t k = 0; k < samples; ++k) {
      const double t = h * static_cast<double>(k);
      signals.t.push_back(t);
      signals.inputs[0].values.push_back(std::sin(t));
      signals.measured[0].values.push_back(0.3 * std::cos(3.0 * t) + 0.05 * normal(random));
      signals.measured[1].values.push_back(-0.9 * std::sin(3.0 * t) + 0.08 * normal(random));
    }
    data.signals = &signals;
    data.inputs = input_table(signals, model.model);
    data.use.assign(2 * samples, SampleRole::counted);
    data.start = Eigen::VectorXd::Zero(model.model.states());
    data.start.head(2) << 0.3, 0.0;
    data.covariance = Eigen::MatrixXd::Zero(model.model.states(), model.model.states());
    data.covariance.topLeftCorner(2, 2) << 0.04, 0.03, 0.03, 0.25;
  }
  Cart(const Cart&) = delete;
  Cart& operator=(const Cart&) = delete;

  [[nodiscard]] FilterTrace run(FilterJacobian* jacobian = nullptr, bool keep_P = false) const {
    FilterRunner runner(model, jacobian != nullptr);
    runner.set_parameters(model.model.values());
    FilterTrace trace;
    EXPECT_TRUE(runner.run(data, noise, trace, {jacobian, keep_P}));
    return trace;
  }
};

/// All states [model | coloured noise] of all samples and all measurements as one Gaussian: means and covariances, with the filter's own Φ.
struct Dense {
  Eigen::VectorXd state_mean, y, y_mean;
  Eigen::MatrixXd states, y_covariance, cross;  ///< state × state, measurement × measurement, state × measurement
  Eigen::Index n = 0;                           ///< states of one sample, coloured noise included

  Dense(const Cart& cart, const FilterTrace& trace) {
    const Eigen::Index m = trace.n, N = static_cast<Eigen::Index>(trace.samples);
    n = m + 4;
    state_mean.resize(N * n);
    states = Eigen::MatrixXd::Zero(N * n, N * n);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
    P.topLeftCorner(m, m) = cart.data.covariance;
    for (int f : cart.model.force_states) P(f, f) = std::pow(cart.noise.force, 2);
    for (Eigen::Index o = 0; o < 2; ++o)
      P(m + 2 * o, m + 2 * o) = P(m + 2 * o + 1, m + 2 * o + 1) = std::pow(cart.noise.channels[static_cast<std::size_t>(o)].coloured, 2);
    Stepper stepper(cart.model.model);
    Eigen::VectorXd x = cart.data.start;
    stepper.prepare(x.data(), cart.data.inputs.at(0), 0.0);
    for (Eigen::Index k = 0; k < N; ++k) {
      const auto sample = static_cast<std::size_t>(k);
      state_mean.segment(k * n, n).setZero();
      state_mean.segment(k * n, m) = x;
      states.block(k * n, k * n, n, n) = P;
      if (k + 1 == N) break;
      const NoiseStep step = discretise(cart.noise, cart.signals.t[sample + 1] - cart.signals.t[sample]);
      const Eigen::MatrixXd A = transition(cart, trace, step, sample);
      for (Eigen::Index j = 0; j <= k; ++j) {
        states.block((k + 1) * n, j * n, n, n) = A * states.block(k * n, j * n, n, n);
        states.block(j * n, (k + 1) * n, n, n) = states.block((k + 1) * n, j * n, n, n).transpose();
      }
      P = A * P * A.transpose() + noise_of(cart, trace, step, sample);
      EXPECT_TRUE(stepper.step(
          x.data(), {cart.signals.t[sample], cart.signals.t[sample + 1], cart.data.inputs.at(sample), cart.data.inputs.at(sample + 1)}));
    }
    read(cart, N, m);
  }

 private:
  [[nodiscard]] Eigen::MatrixXd transition(const Cart&, const FilterTrace& trace, const NoiseStep& step, std::size_t k) const {
    const Eigen::Index m = trace.n;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    A.topLeftCorner(m, m) = phi(trace, k);
    for (Eigen::Index o = 0; o < 2; ++o) {
      const auto& p = step.coloured[static_cast<std::size_t>(o)].phi;
      A.block(m + 2 * o, m + 2 * o, 2, 2) << p[0], p[1], p[2], p[3];
    }
    return A;
  }
  static Eigen::MatrixXd phi(const FilterTrace& trace, std::size_t k) {
    const auto m = static_cast<std::size_t>(trace.n);
    return Eigen::Map<const RowMatrix>(trace.Phi.data() + k * m * m, trace.n, trace.n);
  }
  [[nodiscard]] Eigen::MatrixXd noise_of(const Cart& cart, const FilterTrace& trace, const NoiseStep& step, std::size_t k) const {
    const Eigen::Index m = trace.n;
    const Eigen::MatrixXd F = phi(trace, k);
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n, n);
    for (int f : cart.model.force_states) {
      for (Eigen::Index i = 0; i < m; ++i) {
        for (Eigen::Index j = 0; j < m; ++j) {
          const auto ki = static_cast<std::size_t>(cart.model.kind[static_cast<std::size_t>(i)]);
          const auto kj = static_cast<std::size_t>(cart.model.kind[static_cast<std::size_t>(j)]);
          Q(i, j) += step.m[ki][kj] * (i == f ? 1.0 : F(i, f)) * (j == f ? 1.0 : F(j, f));
        }
      }
    }
    for (Eigen::Index o = 0; o < 2; ++o) {
      const auto& q = step.coloured[static_cast<std::size_t>(o)].q;
      Q.block(m + 2 * o, m + 2 * o, 2, 2) << q[0], q[1], q[1], q[2];
    }
    return Q;
  }
  void read(const Cart& cart, Eigen::Index N, Eigen::Index m) {
    std::vector<Eigen::VectorXd> rows;
    std::vector<double> values, white;
    for (Eigen::Index k = 0; k < N; ++k) {
      for (Eigen::Index o = 0; o < 2; ++o) {
        const auto channel = static_cast<std::size_t>(o), sample = static_cast<std::size_t>(k);
        if (cart.data.use[2 * sample + channel] == SampleRole::none) continue;
        Eigen::VectorXd row = Eigen::VectorXd::Zero(N * n);
        row[k * n + o] = 1.0;
        row[k * n + m + 2 * o] = 1.0;
        rows.push_back(row);
        values.push_back(cart.signals.measured[channel].values[sample]);
        white.push_back(std::pow(cart.noise.channels[channel].white, 2));
      }
    }
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd H(count, N * n);
    for (Eigen::Index i = 0; i < count; ++i) H.row(i) = rows[static_cast<std::size_t>(i)].transpose();
    y = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
    y_mean = H * state_mean;
    cross = states * H.transpose();
    y_covariance = H * cross;
    y_covariance.diagonal() += Eigen::Map<const Eigen::VectorXd>(white.data(), count);
  }
};

}  // namespace misfit::testing_cart
