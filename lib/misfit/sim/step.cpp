#include "misfit/sim/step.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace misfit {
namespace {

// Classical Runge–Kutta: where each stage stands, and its weight.
constexpr std::array<double, 4> stage_at = {0.0, 0.5, 0.5, 1.0};
constexpr std::array<double, 4> stage_weight = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};

}  // namespace

Stepper::Stepper(const Model& model) : evaluator_(model), n_(model.states()), nu_(model.inputs()) {
  for (const auto& input : model.system->spec().inputs) zero_order_.push_back(input.hold == Hold::zero_order);
  const auto size = static_cast<std::size_t>(n_) * kRowStride;
  L_.assign(size, 0.0);
  X_.assign(size, 0.0);
  K_.assign(size, 0.0);
  sum_.assign(size, 0.0);
}

void Stepper::prepare(const double* x, const double* u, double t) { fastest_rate_ = evaluator_.fastest_rate(x, u, t); }

int Stepper::substeps(double h) const {
  constexpr double largest_product = 0.5;  // rate × step: above, explicit Runge–Kutta loses accuracy, then stability (DESIGN 4)
  constexpr double most = 1000.0;
  const double wanted = std::ceil(fastest_rate_ * std::abs(h) / largest_product);
  return static_cast<int>(std::clamp(std::isfinite(wanted) ? wanted : 1.0, 1.0, most));
}

void Stepper::inputs_at(const Interval& interval, double fraction, double* u) const {
  for (int i = 0; i < nu_; ++i) {
    const bool held = zero_order_[static_cast<std::size_t>(i)];
    u[i] = held ? interval.u0[i] : interval.u0[i] + fraction * (interval.u1[i] - interval.u0[i]);
  }
}

bool Stepper::step(double* x, const Interval& interval) {
  const int parts = substeps(interval.t1 - interval.t0);
  const double h = (interval.t1 - interval.t0) / parts;
  std::array<double, kMaxStates> stage, sum, dx{};
  std::array<double, kMaxInputs> u{};
  for (int part = 0; part < parts; ++part) {
    std::copy_n(x, n_, sum.begin());
    std::copy_n(x, n_, stage.begin());
    for (std::size_t s = 0; s < 4; ++s) {
      if (s > 0) {
        for (int i = 0; i < n_; ++i) stage[static_cast<std::size_t>(i)] = x[i] + h * stage_at[s] * dx[static_cast<std::size_t>(i)];
      }
      const double fraction = (part + stage_at[s]) / parts;
      inputs_at(interval, fraction, u.data());
      evaluator_.rates(stage.data(), u.data(), interval.t0 + fraction * (interval.t1 - interval.t0), dx.data());
      for (int i = 0; i < n_; ++i) sum[static_cast<std::size_t>(i)] += h * stage_weight[s] * dx[static_cast<std::size_t>(i)];
    }
    std::copy_n(sum.begin(), n_, x);
  }
  return std::all_of(x, x + n_, [](double value) { return std::isfinite(value); });
}

/// K = A X + [0 | B], where L = [A | B]. Columns 0 … states−1 of X are ∂/∂x0, the rest ∂/∂(slot).
void Stepper::stage_rows(const double* L, const double* X, int width, double* K) const {
  for (int i = 0; i < n_; ++i) {
    const double* a = L + static_cast<std::ptrdiff_t>(i) * kRowStride;
    double* row = K + static_cast<std::ptrdiff_t>(i) * kRowStride;
    std::fill_n(row, n_, 0.0);
    std::copy(a + n_, a + width, row + n_);
    for (int j = 0; j < n_; ++j) {
      if (a[j] == 0.0) continue;
      const double weight = a[j];
      const double* from = X + static_cast<std::ptrdiff_t>(j) * kRowStride;
      for (int c = 0; c < width; ++c) row[c] += weight * from[c];
    }
  }
}

void Stepper::substep_linear(double* x, const Interval& interval, double from, double to, Slots& slots, double* D, bool first) {
  const double h = (to - from) * (interval.t1 - interval.t0);
  std::array<double, kMaxStates> stage, sum, dx{};
  std::array<double, kMaxInputs> u{};
  std::copy_n(x, n_, sum.begin());
  std::copy_n(x, n_, stage.begin());
  const auto row = [](double* rows, int i) { return rows + static_cast<std::ptrdiff_t>(i) * kRowStride; };
  const int full = n_ + evaluator_.columns();
  for (int i = 0; i < n_; ++i) std::copy_n(row(D, i), full, row(sum_.data(), i));
  for (std::size_t s = 0; s < 4; ++s) {
    const double fraction = from + stage_at[s] * (to - from);
    inputs_at(interval, fraction, u.data());
    if (s > 0) {
      for (int i = 0; i < n_; ++i) stage[static_cast<std::size_t>(i)] = x[i] + h * stage_at[s] * dx[static_cast<std::size_t>(i)];
      const int width = n_ + slots.count();
      for (int i = 0; i < n_; ++i) {
        const double* k = row(K_.data(), i);
        const double* d = row(D, i);
        double* out = row(X_.data(), i);
        for (int c = 0; c < width; ++c) out[c] = d[c] + h * stage_at[s] * k[c];
      }
    }
    const int before = slots.count();
    evaluator_.linearise_rates(stage.data(), u.data(), interval.t0 + fraction * (interval.t1 - interval.t0), slots, dx.data(), L_.data());
    const int width = n_ + slots.count();
    double* X = s == 0 ? D : X_.data();
    if (s > 0) {  // columns met for the first time: nothing of them has moved the state yet
      for (int i = 0; i < n_; ++i) std::fill(row(X, i) + n_ + before, row(X, i) + width, 0.0);
    }
    if (s == 0 && first) {
      for (int i = 0; i < n_; ++i) std::copy_n(row(L_.data(), i), width, row(K_.data(), i));
    } else {
      stage_rows(L_.data(), X, width, K_.data());
    }
    for (int i = 0; i < n_; ++i) {
      sum[static_cast<std::size_t>(i)] += h * stage_weight[s] * dx[static_cast<std::size_t>(i)];
      const double* k = row(K_.data(), i);
      double* out = row(sum_.data(), i);
      for (int c = 0; c < width; ++c) out[c] += h * stage_weight[s] * k[c];
    }
  }
  std::copy_n(sum.begin(), n_, x);
  for (int i = 0; i < n_; ++i) std::copy_n(row(sum_.data(), i), n_ + slots.count(), row(D, i));
}

bool Stepper::step_linear(double* x, const Interval& interval, Slots& slots, double* D) {
  slots.clear();
  const int full = n_ + evaluator_.columns();
  for (int i = 0; i < n_; ++i) {
    double* row = D + static_cast<std::ptrdiff_t>(i) * kRowStride;
    std::fill_n(row, full, 0.0);
    row[i] = 1.0;
  }
  const int parts = substeps(interval.t1 - interval.t0);
  for (int part = 0; part < parts; ++part) {
    substep_linear(x, interval, static_cast<double>(part) / parts, static_cast<double>(part + 1) / parts, slots, D, part == 0);
  }
  return std::all_of(x, x + n_, [](double value) { return std::isfinite(value); });
}

}  // namespace misfit
