#pragma once

// References
//   [BT] M. B. Priestley, Spectral Analysis and Time Series (1981), 6.2: lag-window estimates, Parzen's window.
//   [MC] G. A. Barnard, discussion of M. S. Bartlett, J. R. Statist. Soc. B 25 (1963): Monte-Carlo tests by rank.

#include <string>
#include <vector>

#include "misfit/data/motion.h"

namespace misfit {

/// One channel or quantity over time.
struct MotionPath {
  std::string name, unit;      ///< SI
  std::vector<double> values;  ///< one per sample; NaN = missing
  bool spread_only = false;    ///< only its distribution means something (a rate that is unbounded where an angle is undefined)
};

/// What is looked at, chosen from the measured path and then the same for every simulated one.
struct MotionScales {
  double step = 0.0;                ///< usual sample interval [s]
  std::size_t period = 0;           ///< four times the lag at which the autocorrelation first crosses 0 [samples]
  std::vector<std::size_t> lags;    ///< [samples], up to three periods
  std::vector<double> frequencies;  ///< [Hz], up to ten times the main one or 0.45 of the sample rate
  bool spread_only = false;
};
/// `step` in seconds. A path that never crosses 0 within a sixth of the record is taken to have that as a quarter of its period.
[[nodiscard]] MotionScales scales_of(const MotionPath& measured, double step);

/// Numbers of one path, group by group in a fixed order; their names and places come from compare_motion().
///   distribution: mean, standard deviation, quantiles (linear between order statistics)
///   amplitude: half the range within consecutive windows of one period, mean and 10 % and 90 % quantiles over windows at least half full
///   autocorrelation: Σ x_i x_{i+k}/pairs over Σ x_i²/n, mean removed, pairs with both samples
///   spectrum: two-sided density in dB re 1 unit²/Hz, 10 log10 of h (r_0 + 2 Σ w_k r_k cos 2πfkh), r the autocovariance, w Parzen's window
///   over three periods [BT]
/// Not finite where there are too few samples.
using MotionNumbers = std::vector<std::vector<double>>;
[[nodiscard]] MotionNumbers motion_numbers(const MotionPath& path, const MotionScales& scales);

/// A motion's distance from the others in each group, Σ ((number − mean)/sd)² with mean and standard deviation of all other motions,
/// simulated or measured: group × motion, the measured one first.
using MotionDistances = std::vector<std::vector<double>>;

/// The measured path against simulated ones: bands, and p-values by rank [MC]: the share of motions at least as far from the others as the
/// measured one. With n runs p is at least 1/(n + 1). The parameters are fixed at their estimates: the band does not hold their
/// uncertainty. Numbers that the measured path does not give are in no distance, a group without any is left out. The distances of its
/// groups are added to `distances`. The name of the experiment is left to the caller.
[[nodiscard]] MotionSeries compare_motion(const MotionPath& measured, const MotionScales& scales,
                                          const std::vector<MotionNumbers>& simulated, MotionDistances& distances);

/// One p-value for all groups, however they depend on each other: by rank of each motion's largest distance, distances as logarithms over
/// their mean and standard deviation in the group.
[[nodiscard]] double overall_p_value(const MotionDistances& distances);

/// What lies outside, in sentences: by groups only if the motion as a whole departs (SimulatedMotion::p_value ≤ 0.01), since of many groups
/// one departs by chance.
void conclude_motion(SimulatedMotion& motion);

}  // namespace misfit
