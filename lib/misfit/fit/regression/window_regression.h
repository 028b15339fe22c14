#pragma once

// References
//   [P]  the paper (lib/misfit/README.md, [1]), Eqs. 9-11.
//   [MK] E. A. Morelli, V. Klein, J. Guidance 20 (1997): sigmas of a regression with coloured residuals.

#include <cstddef>
#include <vector>

namespace misfit {

/// One sample of y = g_s (slope · x + intercept) + g_d · damping: the equation of motion with what is known moved to the left.
struct BinEquation {
  double x = 0.0;             ///< level [unit of the level]
  double static_gain = 0.0;   ///< g_s: acceleration per unit of the static curve
  double damping_gain = 0.0;  ///< g_d: acceleration per unit of the damping curve, at this sample's rate
  double y = 0.0;             ///< acceleration less its known part
  double known = 0.0;         ///< the part taken off: y + known is the measured acceleration
  double t = 0.0;             ///< [s]
  std::size_t sample = 0;     ///< index in time
};

/// Least squares over one bin: [P]'s Eq. 11, with the static curve's line given by its value at the mean level.
struct BinSolution {
  double level = 0.0;  ///< mean x of the bin
  double count = 0.0;  ///< samples
  double slope = 0.0, value = 0.0, damping = 0.0;
  double slope_sigma = 0.0, value_sigma = 0.0, damping_sigma = 0.0;
  double residual_variance = 0.0;  ///< rss/(count − 3)
  bool determined = false;         ///< false: level or rate do not vary enough in the bin; then only level and count hold
};

struct BinLayout {
  double width = 0.0, step = 0.0;  ///< [unit of the level]
  std::size_t minimum_samples = 30;
};

struct SlidBins {
  static constexpr std::size_t most = 100000;  ///< positions of the bin over the levels
  std::vector<BinSolution> bins;               ///< determined ones with enough samples, in rising order of level
  std::size_t too_few = 0, undetermined = 0;   ///< left out
  bool too_many = false;                       ///< the levels span more than `most` steps: nothing was done
};

/// Equations sorted by level, ready for any number of passes.
class BinRegression {
 public:
  explicit BinRegression(std::vector<BinEquation> equations);

  [[nodiscard]] const std::vector<BinEquation>& equations() const { return equations_; }

  /// All bins [k·step, k·step + width) that reach from the lowest to the highest level. Samples enter and leave running sums (long double,
  /// about a common centre, moved to each bin's mean before solving), so all bins together cost O(samples · lags). `rho`: autocorrelation
  /// of the residuals by lag in samples (rho[0] = 1; empty: white). Covariance N⁻¹ (Σ_ij ρ_|i−j| z_i z_jᵀ) N⁻¹ σ², over pairs of samples
  /// that are both in the bin [MK]; ρ is common to all bins, σ² the bin's own.
  [[nodiscard]] SlidBins slide(const BinLayout& layout, const std::vector<double>& rho) const;
  /// The same on all equations at once.
  [[nodiscard]] BinSolution all(const std::vector<double>& rho) const;
  /// y minus what the bin nearest in level gives, in time: `samples` values, NaN where no equation or no bin within `reach` of the level
  /// is.
  [[nodiscard]] std::vector<double> residuals(const std::vector<BinSolution>& bins, double reach, std::size_t samples) const;

 private:
  std::vector<BinEquation> equations_;
  std::vector<std::ptrdiff_t> place_;  ///< of each sample in `equations_`; −1: not there
  double step_ = 0.0;                  ///< usual step in time [s]
  friend class RunningSums;
};

}  // namespace misfit
