#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace misfit {

/// One statistic of a motion as measured, and where simulated motions have it.
struct MotionNumber {
  std::string name;  ///< "5 % quantile", "mean", "lag", "power"
  double at = 0.0;   ///< share of a quantile [-], lag [s], frequency [Hz]; NaN where the statistic has none
  double measured = 0.0;
  double low = 0.0, median = 0.0, high = 0.0;  ///< 2.5 %, 50 % and 97.5 % of the simulated runs
  bool outside = false;                        ///< measured < low or measured > high: by chance in 5 % of the numbers
};

/// The measured motion gives it, and simulated ones: it is not that of too few samples.
[[nodiscard]] inline bool is_known(const MotionNumber& n) {
  return std::isfinite(n.measured) && std::isfinite(n.low) && std::isfinite(n.high);
}

/// Statistics that belong together.
struct MotionGroup {
  std::string name;  ///< "distribution", "amplitude", "autocorrelation", "spectrum"
  std::string unit;  ///< of the numbers, SI
  std::vector<MotionNumber> numbers;
  double p_value = 1.0;  ///< share of motions (the measured one among them) that lie as far from all others: a rank; exact by exchange but
                         ///< for scales and parameters, which come from the measured motion
};

/// A value on the scale of the channel (a mean, a quantile of the motion), and no difference: a temperature in degC.
[[nodiscard]] inline bool is_level(const MotionGroup& group, const MotionNumber& number) {
  return group.name == "distribution" && number.name != "standard deviation";
}

/// One channel or quantity of one experiment.
struct MotionSeries {
  std::string experiment, name, unit;  ///< SI
  std::vector<MotionGroup> groups;
};

/// Statistics of simulated against measured motion.
struct SimulatedMotion {
  std::string method;      ///< whose model and noise were simulated
  std::size_t runs = 0;    ///< per experiment
  std::size_t failed = 0;  ///< of all, left the finite numbers
  std::vector<MotionSeries> series;
  double p_value = 1.0;                ///< of the measured motion as a whole: share of motions as far from the others in any group
  std::vector<std::string> sentences;  ///< which measured statistics the model does not make
  std::vector<std::string> notes;      ///< what to know before believing it
  double seconds = 0.0;
};

/// "p = 0.12"; where no simulated motion lies as far out as the measured one, "p ≤ 0.005": so many simulated motions tell no more.
[[nodiscard]] std::string p_in_words(const SimulatedMotion& motion);

}  // namespace misfit
