#pragma once

// Output error of linear models over short windows: what window_search.cpp solves; not for other files.
//
// Over a window of the record y^(n) = −Σ a_j y^(j) + Σ b_i u_i + c is solved exactly; for given poles the solution is linear in b, c and
// the state at the window's begin, which is projected out. White measurement noise does not bias it, as it does a regression on past values
// (Ljung, System Identification (1999), 7.3).

#include <Eigen/Core>
#include <vector>

namespace misfit {

/// y' = −damping y + … (order 1), or y'' = −stiffness y − damping y' + … (order 2).
struct Poles {
  int order = 1;
  double stiffness = 0.0, damping = 0.0;  ///< [1/s^2], [1/s]

  /// Back to a rest; what is not integrates.
  [[nodiscard]] bool pulled() const { return (order == 1 ? damping : stiffness) != 0.0; }
};

/// A record ready to be solved: y and drivers of mean 0 and sigma 1; drivers known everywhere, y NaN where it is missing.
struct WindowedRecord {
  std::vector<double> t, y;
  double step = 0.0;        ///< usual interval [s]
  Eigen::MatrixXd drivers;  ///< samples × drivers; mean over the interval from the sample to the next
  struct Window {
    std::size_t from = 0, to = 0;
  };
  std::vector<Window> windows;  ///< of samples without a gap
};

/// Sum of squares of y less its prediction, as a quadratic form in (b_1 … b_m, c).
struct SquaresForm {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double yy = 0.0, count = 0.0;  ///< count: samples less initial states

  explicit SquaresForm(Eigen::Index size = 0) : matrix(Eigen::MatrixXd::Zero(size, size)), right(Eigen::VectorXd::Zero(size)) {}
  SquaresForm& operator+=(const SquaresForm& other);

  /// Least squares over the terms named (indices), the others being 0.
  [[nodiscard]] Eigen::VectorXd solve(const std::vector<Eigen::Index>& terms) const;
  /// Mean square of what the coefficients leave over.
  [[nodiscard]] double mean_square(const Eigen::VectorXd& coefficients) const;
};

/// The sums of squares over every second window: those fitted, and those held out (with one window alone both are the same).
struct FittedAndHeldOut {
  Poles poles;
  SquaresForm fitted, held_out;
};
[[nodiscard]] FittedAndHeldOut squares_of(const WindowedRecord& record, const Poles& poles);

/// Over how many samples a window goes: about two swings of y (crossings of its mean), at least 20, at most an eighth of the record.
[[nodiscard]] std::size_t window_length(const std::vector<double>& y);

/// Windows of `length` samples, at most 40 000 samples in all, none over an interval of more than five usual steps.
[[nodiscard]] std::vector<WindowedRecord::Window> windows_of(const std::vector<double>& t, double step, std::size_t length);

}  // namespace misfit
