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
  Y_.assign(size, 0.0);
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

/// One stage on rows of ∂/∂(x0, slots), L = [A | B], B as entries if sparse:  K = A X + [0 | B];  sum += h w K;  next = D + h a K (rows of
/// the next stage's state).
void Stepper::advance_rows(double h, std::size_t stage, int width, bool sparse, const double* X, double* next, const double* D) {
  const double to_sum = h * stage_weight[stage];
  const double to_next = stage + 1 < stage_at.size() ? h * stage_at[stage + 1] : 0.0;
  const int whole = padded(width);
  for (int i = 0; i < n_; ++i) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * kRowStride;
    double* __restrict L = L_.data() + at;  // A first; then this row becomes K
    std::array<double, kMaxStates> a;
    for (int j = 0; j < n_; ++j) a[static_cast<std::size_t>(j)] = L[j];
    for (int j = 0; j < n_; ++j) L[j] = 0.0;
    if (sparse) {
      for (int c = n_; c < whole; ++c) L[c] = 0.0;
    }
    int j = 0;
    for (; j + 2 < n_; j += 2) {
      const double a0 = a[static_cast<std::size_t>(j)], a1 = a[static_cast<std::size_t>(j) + 1];
      const double* __restrict x0 = X + static_cast<std::ptrdiff_t>(j) * kRowStride;
      const double* __restrict x1 = x0 + kRowStride;
      for (int c = 0; c < whole; ++c) L[c] += a0 * x0[c] + a1 * x1[c];
    }
    // The last one or two states together with what becomes of K.
    const bool two = j + 1 < n_;
    const double a0 = a[static_cast<std::size_t>(j)], a1 = two ? a[static_cast<std::size_t>(j) + 1] : 0.0;
    const double* __restrict x0 = X + static_cast<std::ptrdiff_t>(j) * kRowStride;
    const double* __restrict x1 = two ? x0 + kRowStride : x0;
    double* __restrict sum = sum_.data() + at;
    double* __restrict out = next + at;
    const double* __restrict d = D + at;
    for (int c = 0; c < whole; ++c) {
      const double k = L[c] + (a0 * x0[c] + a1 * x1[c]);
      sum[c] += to_sum * k;
      out[c] = d[c] + to_next * k;
    }
  }
  if (!sparse) return;
  for (const Evaluator::Entry& entry : evaluator_.slot_entries()) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(entry.row) * kRowStride + n_ + entry.slot;
    sum_[static_cast<std::size_t>(at)] += to_sum * entry.value;
    next[at] += to_next * entry.value;
  }
}

void Stepper::substep_linear(double* x, const Interval& interval, double from, double to, Slots& slots, double* D) {
  const double h = (to - from) * (interval.t1 - interval.t0);
  std::array<double, kMaxStates> stage, sum, dx{};
  std::array<double, kMaxInputs> u{};
  for (int i = 0; i < n_; ++i) sum[static_cast<std::size_t>(i)] = stage[static_cast<std::size_t>(i)] = x[i];
  const auto row = [](double* rows, int i) { return rows + static_cast<std::ptrdiff_t>(i) * kRowStride; };
  for (int i = 0; i < n_; ++i) std::copy_n(row(D, i), n_ + slots.count(), row(sum_.data(), i));
  double* X = D;
  double* next = X_.data();
  for (std::size_t s = 0; s < stage_at.size(); ++s) {
    const double fraction = from + stage_at[s] * (to - from);
    inputs_at(interval, fraction, u.data());
    if (s > 0) {
      for (int i = 0; i < n_; ++i) stage[static_cast<std::size_t>(i)] = x[i] + h * stage_at[s] * dx[static_cast<std::size_t>(i)];
    }
    const int before = n_ + slots.count();
    const double t = interval.t0 + fraction * (interval.t1 - interval.t0);
    const bool sparse = evaluator_.linearise_rates_sparsely(stage.data(), u.data(), t, slots, dx.data(), L_.data());
    if (!sparse) evaluator_.linearise_rates(stage.data(), u.data(), t, slots, dx.data(), L_.data());
    const int width = n_ + slots.count();
    if (width > before) {  // columns met for the first time: nothing of them has moved the state yet
      for (double* rows : {D, X, sum_.data()}) {
        for (int i = 0; i < n_; ++i) std::fill(row(rows, i) + before, row(rows, i) + width, 0.0);
      }
    }
    advance_rows(h, s, width, sparse, X, next, D);
    X = next;
    next = X == X_.data() ? Y_.data() : X_.data();
    for (int i = 0; i < n_; ++i) sum[static_cast<std::size_t>(i)] += h * stage_weight[s] * dx[static_cast<std::size_t>(i)];
  }
  std::copy_n(sum.begin(), n_, x);
  for (int i = 0; i < n_; ++i) std::copy_n(row(sum_.data(), i), n_ + slots.count(), row(D, i));
}

bool Stepper::step_linear(double* x, const Interval& interval, Slots& slots, double* D) {
  slots.clear();
  for (int i = 0; i < n_; ++i) {
    double* row = D + static_cast<std::ptrdiff_t>(i) * kRowStride;
    std::fill_n(row, n_, 0.0);
    row[i] = 1.0;
  }
  const int parts = substeps(interval.t1 - interval.t0);
  for (int part = 0; part < parts; ++part) {
    substep_linear(x, interval, static_cast<double>(part) / parts, static_cast<double>(part + 1) / parts, slots, D);
  }
  return std::all_of(x, x + n_, [](double value) { return std::isfinite(value); });
}

}  // namespace misfit
