#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace misfit {

/// Frequencies first + f step, f = 0 … count − 1 [Hz].
struct FrequencyGrid {
  double first = 0.0, step = 0.0;
  std::size_t count = 0;
  double wanted = 0.0;  ///< the highest that was asked for: above the last one where the scan is cut short [Hz]
  /// Length of one recording of even density whose lines are as narrow as those of all experiments together, √(12 var t) [s].
  double even_length = 0.0;
  [[nodiscard]] double at(std::size_t f) const { return first + static_cast<double>(f) * step; }
};

/// Sampling times of each experiment [s], rising; series hold the experiments one behind the other.
using SampleTimes = std::vector<std::vector<double>>;

/// Frequencies from `from` to `to`, no lower than half a period in the longest experiment, no higher than 0.45 of its sampling rate, in
/// steps of half the width of a line in all of them: 1/(4T), T from the first sample of any to the last of any, at most 64 times the
/// longest. A line has one phase in all, and parts of one recording with a gap between them show it as narrow fringes. Fewer where samples
/// that are not evenly spaced make more than some 10 s of work for `series` series: then only the lower ones.
[[nodiscard]] FrequencyGrid frequency_grid(const SampleTimes& times, double from, double to, std::size_t series);

/// |Σ_k λ_k exp(2πi f t_k)|² at the frequencies of the grid: by fast transforms over each experiment that is evenly sampled, be it with
/// gaps, and sample by sample over the others. Times off the even ones by less than a hundredth of a radian at the highest frequency (those
/// printed with few digits) count as even.
[[nodiscard]] std::vector<double> periodogram(const Eigen::VectorXd& lambda, const SampleTimes& times, const FrequencyGrid& grid);

/// Adds to `power` each line over its background, the running median over 1/20 of the band: lines stand out of it.
void add_over_background(const std::vector<double>& line, std::vector<double>& power);

/// Where the strongest lines are, at most so many, the strongest first: local maxima, since a line is several steps of the grid wide.
[[nodiscard]] std::vector<std::size_t> strongest_lines(const std::vector<double>& power, std::size_t most);

}  // namespace misfit
