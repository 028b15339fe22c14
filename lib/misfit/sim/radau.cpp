#include "misfit/sim/radau.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

// Coefficients a_ij of Radau IIA, order 5 [HW, table IV.5.6].
constexpr double root6 = 2.449489742783178;
constexpr std::array<std::array<double, 3>, 3> a = {
    {{(88.0 - 7.0 * root6) / 360.0, (296.0 - 169.0 * root6) / 1800.0, (-2.0 + 3.0 * root6) / 225.0},
     {(296.0 + 169.0 * root6) / 1800.0, (88.0 + 7.0 * root6) / 360.0, (-2.0 - 3.0 * root6) / 225.0},
     {(16.0 - root6) / 36.0, (16.0 + root6) / 36.0, 1.0 / 9.0}}};

constexpr std::size_t stride = kRowStride;

}  // namespace

RadauStep::RadauStep(Evaluator& evaluator)
    : evaluator_(&evaluator), n_(evaluator.states()), N_(3 * n_), L_(N_ * stride, 0.0), rows_(N_ * stride, 0.0) {
  constexpr double of_the_scale = 1e-6;  // below this share of its typical size a state need not be right to its own digits
  const auto& specs = evaluator.model().state_specs;
  for (std::size_t stage = 0; stage < 3; ++stage) {
    for (std::size_t i = 0; i < n_; ++i) scale_[stage * n_ + i] = of_the_scale * (i < specs.size() ? specs[i].scale : 1.0);
  }
}

/// f and its derivatives at a stage, into f_ and L_.
void RadauStep::linearise_stage(std::size_t stage, const RadauInputs& at, Slots& slots) {
  evaluator_->linearise_rates({Y_.data() + stage * n_, at.u[stage], at.t[stage]}, slots, f_.data() + stage * n_,
                              L_.data() + stage * n_ * stride);
}

/// I − h a ⊗ A, every stage with its own A.
void RadauStep::fill_matrix(double h) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t r = 0; r < n_; ++r) {
        const double* A = L_.data() + (j * n_ + r) * stride;
        double* row = lu_.data() + (i * n_ + r) * N_ + j * n_;
        for (std::size_t c = 0; c < n_; ++c) row[c] = (i == j && r == c ? 1.0 : 0.0) - h * a[i][j] * A[c];
      }
    }
  }
}

/// Gaussian elimination with partial pivoting, rows exchanged by their numbers. False if a pivot is 0 or not finite.
bool RadauStep::factorise() {
  for (std::size_t r = 0; r < N_; ++r) row_[r] = r;
  for (std::size_t k = 0; k < N_; ++k) {
    std::size_t best = k;
    for (std::size_t r = k + 1; r < N_; ++r) {
      if (std::abs(lu_[row_[r] * N_ + k]) > std::abs(lu_[row_[best] * N_ + k])) best = r;
    }
    std::swap(row_[k], row_[best]);
    const double* pivot = lu_.data() + row_[k] * N_;
    if (!(std::abs(pivot[k]) > 0.0) || !std::isfinite(pivot[k])) return false;
    for (std::size_t r = k + 1; r < N_; ++r) {
      double* row = lu_.data() + row_[r] * N_;
      if (row[k] == 0.0) continue;
      const double factor = row[k] / pivot[k];
      row[k] = factor;
      for (std::size_t c = k + 1; c < N_; ++c) row[c] -= factor * pivot[c];
    }
  }
  return true;
}

/// Solves for `width` right-hand sides at once, the columns of `rows`; solution k then stands in row row_[k].
void RadauStep::solve(int width, int row_length, double* rows) const {
  const auto at = [&](std::size_t k) { return rows + row_[k] * row_length; };
  const auto subtract = [&](double factor, const double* from, double* to) {
    if (factor == 0.0) return;
    for (int c = 0; c < width; ++c) to[c] -= factor * from[c];
  };
  for (std::size_t k = 0; k < N_; ++k) {
    for (std::size_t r = k + 1; r < N_; ++r) subtract(lu_[row_[r] * N_ + k], at(k), at(r));
  }
  for (std::size_t k = N_; k-- > 0;) {
    double* row = at(k);
    for (int c = 0; c < width; ++c) row[c] /= lu_[row_[k] * N_ + k];
    for (std::size_t r = 0; r < k; ++r) subtract(lu_[row_[r] * N_ + k], row, at(r));
  }
}

bool RadauStep::solve_stages(const double* x, double h, const RadauInputs& at) {
  constexpr int most_iterations = 20;
  constexpr double converged = 1e-9;  // of the step just taken; the error left is of the order of its square
  for (std::size_t stage = 0; stage < 3; ++stage) std::copy_n(x, n_, Y_.data() + stage * n_);
  std::array<double, kMost> step{};
  for (int k = 0; k < most_iterations; ++k) {
    own_.clear();
    for (std::size_t stage = 0; stage < 3; ++stage) linearise_stage(stage, at, own_);
    for (std::size_t stage = 0; stage < 3; ++stage) {
      for (std::size_t i = 0; i < n_; ++i) {
        double& residual = step[stage * n_ + i];
        residual = x[i] - Y_[stage * n_ + i];
        for (std::size_t j = 0; j < 3; ++j) residual += h * a[stage][j] * f_[j * n_ + i];
      }
    }
    fill_matrix(h);
    if (!factorise()) return false;
    solve(1, 1, step.data());
    double largest = 0.0;
    for (std::size_t i = 0; i < N_; ++i) {
      const double change = step[row_[i]];
      Y_[i] += change;
      largest = std::max(largest, std::abs(change) / (std::abs(Y_[i]) + scale_[i]));
      if (!std::isfinite(Y_[i])) return false;
    }
    if (largest < converged) return true;
  }
  return false;
}

bool RadauStep::step(double* x, double h, const RadauInputs& at) {
  if (!solve_stages(x, h, at)) return false;
  std::copy_n(Y_.data() + 2 * n_, n_, x);
  return true;
}

/// Right-hand sides ∂x + h Σ a_ij B_j, solved; the last stage's solution is D.
void RadauStep::take_derivatives(double h, int width, double* D) {
  for (std::size_t stage = 0; stage < 3; ++stage) {
    for (std::size_t i = 0; i < n_; ++i) {
      double* row = rows_.data() + (stage * n_ + i) * stride;
      std::copy_n(D + i * stride, width, row);
      for (std::size_t j = 0; j < 3; ++j) {
        const double weight = h * a[stage][j];
        const double* B = L_.data() + (j * n_ + i) * stride;
        for (int c = evaluator_->states(); c < width; ++c) row[c] += weight * B[c];
      }
    }
  }
  solve(width, kRowStride, rows_.data());
  for (std::size_t i = 0; i < n_; ++i) std::copy_n(rows_.data() + row_[2 * n_ + i] * stride, width, D + i * stride);
}

bool RadauStep::step_linear(double* x, double h, const RadauInputs& at, const SlotRows& by) {
  const auto& [slots, D] = by;
  if (!solve_stages(x, h, at)) return false;
  const int n = evaluator_->states(), before = n + slots.count();
  const int all = n + evaluator_->columns();
  for (std::size_t r = 0; r < N_; ++r) std::fill_n(L_.data() + r * stride, all, 0.0);
  for (std::size_t stage = 0; stage < 3; ++stage) linearise_stage(stage, at, slots);
  const int width = n + slots.count();
  for (std::size_t i = 0; i < n_; ++i) std::fill(D + i * stride + before, D + i * stride + width, 0.0);
  fill_matrix(h);
  if (!factorise()) return false;
  take_derivatives(h, width, D);
  std::copy_n(Y_.data() + 2 * n_, n_, x);
  return true;
}

}  // namespace misfit
