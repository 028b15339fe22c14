#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "misfit/diagnose/score.h"
#include "misfit/discover/frequency_scan.h"

namespace misfit {

/// The course of a quantity over the steps of the samples, all experiments one after the other [its unit, or unit s].
struct Course {
  Eigen::VectorXd middle;  ///< half-way between where the step begins, as filtered, and where it is predicted to end
  Eigen::VectorXd moved;   ///< from the one to the other
};

/// Of a quantity; `integrated`: of its integral over time, which is 0 where each experiment begins.
[[nodiscard]] Course course_of(const FilterEstimate& estimate, const ForceSensitivity& force, int quantity, bool integrated);

/// Waves per unit of the way, from `least` to `most` periods over all of it, in steps of half the width of a line: 1/(4 x the way). No
/// shorter waves than those of which a tenth of the steps moves by less than 0.45: in the others they average out. Fewer, the longer ones,
/// where all would be more than some 5 s of work for `series` series. `even_length` as of times. None where the quantity does not move.
[[nodiscard]] FrequencyGrid wave_grid(const Course& course, double least, double most, std::size_t series);

/// |Σ_k λ_k sinc(f moved_k) exp(2πi f middle_k)|²: the score λ of the force over each step, times the mean of the wave over it.
[[nodiscard]] std::vector<double> wave_power(const Eigen::VectorXd& lambda, const Course& course, const FrequencyGrid& grid);

}  // namespace misfit
