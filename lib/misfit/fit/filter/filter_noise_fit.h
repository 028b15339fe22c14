#pragma once

#include "misfit/fit/filter/filter_run.h"

namespace misfit {

/// One set of experiments with the runs about which the noise is fitted.
struct LinearisedRuns {
  const FilterModel* model = nullptr;
  const std::vector<FilterData>* data = nullptr;
  const std::vector<FilterTrace>* traces = nullptr;
};

inline constexpr int kRefinements = 2;  ///< iterations up to which `information` may be left from the step before

struct NoiseFit {
  FilterNoise noise;
  double minus_log_density = 0.0;  ///< −(log-likelihood + log prior of the noise)
  Eigen::MatrixXd information;     ///< Fisher and the prior's, over the logarithms of pack()
  std::vector<double> logs;        ///< at the maximum
  std::vector<bool> at_bound;      ///< not determined from below or above: left out of `information` (zero row)
  bool converged = false;
};

/// Maximum of likelihood times prior of the noise with the runs' trajectories fixed: Fisher scoring with derivatives of innovations and
/// variances by differences of the whole linear filter (step 1e-4 in the logarithm), Levenberg damping. `reference` sets bounds and prior
/// (pack()). The answer does not depend on `threads`.
struct NoiseSearch {
  const FilterNoise& reference;
  int threads = 0;
  int max_iterations = 12;
};
[[nodiscard]] NoiseFit fit_noise(const LinearisedRuns& runs, const FilterNoise& start, const NoiseSearch& search);

/// The information of fit_noise at any logarithms (pack()), counted measurements only; parameters are fixed.
[[nodiscard]] Eigen::MatrixXd noise_information(const LinearisedRuns& runs, const std::vector<double>& logs, const FilterNoise& reference,
                                                int threads);

/// Pins, in an information whose last rows are those of `fit`'s logarithms, what is at its bound or so unknown that the data do not even
/// know the logarithm to one unit (the shape of something that is not there). Returned: which logarithms are known.
std::vector<bool> pin_unknown(const NoiseFit& fit, Eigen::MatrixXd& information);
/// Of a variance from such an information: is it that of a pin, which says nothing of how well the logarithm is known?
[[nodiscard]] bool pinned(double variance);

}  // namespace misfit
