#pragma once

#include <vector>

#include "misfit/fit/regression/linear_windows.h"
#include "misfit/math/statistics.h"

namespace misfit {

/// What may drive an output.
struct GuessDriver {
  std::vector<double> values;  ///< as long as t; NaN: missing
  bool smooth = false;         ///< measured: straight between samples; else held until the next
  bool output = false;         ///< another output: taken only if it explains much
  bool named = false;          ///< by the user: in the model unless it is constant
};

/// A model found: which terms (drivers, then the constant), their coefficients, and the mean square it leaves in the windows held out.
struct Found {
  std::vector<Eigen::Index> terms;
  Poles poles;
  double mean_square = 0.0, undriven = 0.0;  ///< undriven: of the best model of its kind without drivers
};

/// Fits of one target (an output, or its measured rate) over poles on a grid.
class WindowSearch {
 public:
  /// `lengthened`: windows so many times as long as two swings, at most a quarter of the record.
  WindowSearch(const std::vector<double>& t, const std::vector<double>& y, std::vector<GuessDriver> drivers, int lengthened = 1);

  [[nodiscard]] bool possible() const { return record_.windows.size() > 1 && !target_.constant(); }
  /// The best model of that order; `pulled`: with a pull back to rest.
  [[nodiscard]] Found best(int order, bool pulled) const;
  [[nodiscard]] double excess(double mean_square) const { return std::max(mean_square - noise_, least_excess * noise_) + 1e-12; }
  /// Whether what drives the model explains the motion, rather than the initial states of its windows: with it the held-out error is
  /// clearly lower (guess_linear()).
  [[nodiscard]] bool needs_drivers(const Found& found) const;
  /// The same with the inputs that `longer`, over longer windows, has in its model of that kind; not beside another output that drives it.
  [[nodiscard]] Found with_inputs_of(const WindowSearch& longer, Found found) const;
  [[nodiscard]] std::size_t windows() const { return record_.windows.size(); }
  [[nodiscard]] int lengthened() const { return lengthened_; }
  /// Coefficients in the units given: of the drivers, then the constant.
  [[nodiscard]] std::vector<double> coefficients(const Found& found) const;

 private:
  using Fits = std::vector<FittedAndHeldOut>;
  [[nodiscard]] Fits on_grid(int order, bool pulled) const;
  [[nodiscard]] Found best_of(const Fits& fits, const std::vector<Eigen::Index>& terms) const;
  [[nodiscard]] bool is_output(Eigen::Index term) const;
  [[nodiscard]] bool any_output(const std::vector<Eigen::Index>& terms) const;
  [[nodiscard]] double most_with(Eigen::Index term, const std::vector<Eigen::Index>& others) const;
  void add_drivers(const Fits& fits, bool outputs, Found& found) const;
  void drop_drivers(const Fits& fits, Found& found) const;
  void refine(Found& found) const;

  static constexpr double least_excess = 0.3, clearly = 0.8;
  std::vector<GuessDriver> drivers_;
  WindowedRecord record_;
  MeanAndSigma target_;
  int lengthened_ = 1;
  std::size_t length_ = 0;  ///< of a window, in samples
  std::vector<MeanAndSigma> spreads_;
  double noise_ = 0.0;
};

}  // namespace misfit
