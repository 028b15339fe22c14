#pragma once

#include <vector>

namespace misfit {

/// Median of the finite values; the mean of the middle two for an even count. NaN if there is none.
[[nodiscard]] double median(std::vector<double> values);

/// The step of digitised values: the smallest difference of two that differ, if all are whole multiples of it apart (to 2 %); 0 if there
/// is none. All values finite.
[[nodiscard]] double resolution_of(std::vector<double> values);

/// Share of the finite samples that equal the one before; 0 of none.
[[nodiscard]] double repeat_share(const std::vector<double>& values);

/// Usual step of a time base: the median difference [s]; 1 for fewer than two samples.
[[nodiscard]] double usual_step(const std::vector<double>& t);

/// Mean and standard deviation about it.
struct MeanAndSigma {
  double mean = 0.0, sigma = 0.0;
  /// The values do not differ but for rounding: sigma is at most 1e-12 of the mean.
  [[nodiscard]] bool constant() const;
};

/// Of the finite ones; 0 of none.
[[nodiscard]] MeanAndSigma mean_and_sigma(const std::vector<double>& values);

/// Of the finite ones, about their mean; 0 of fewer than two.
[[nodiscard]] double standard_deviation(const std::vector<double>& values);

/// Robust standard deviation about the median: 1.4826 × median |x − median(x)|, which is sigma for normal x and unmoved by up to half of
/// the values being wild. Values that are not finite are passed over; NaN if there is none.
[[nodiscard]] double mad_sigma(const std::vector<double>& values);

/// Ten times the median of the finite ones; infinity if there is none. A prediction with a larger sigma says next to nothing: its state is
/// not known yet, at the beginning or behind a gap.
[[nodiscard]] double largest_usual_sigma(std::vector<double> sigma);

/// P(chi² with `dof` > 0 degrees of freedom > x); 1 for x ≤ 0, NaN for NaN. Accurate in the far tail (to about 1e-300).
[[nodiscard]] double chi_square_tail(double x, double dof);
/// Its logarithm, accurate where the probability underflows.
[[nodiscard]] double log_chi_square_tail(double x, double dof);

/// P(F with (dof1, dof2) degrees of freedom > x), both > 0; 1 for x ≤ 0, NaN for NaN.
[[nodiscard]] double f_tail(double x, double dof1, double dof2);

/// The standard normal's quantile: x with P(z < x) = p, 0 < p < 1.
[[nodiscard]] double normal_quantile(double p);

/// Student's t of `dof` > 0 degrees of freedom: x with P(t < x) = p, 0 < p < 1.
[[nodiscard]] double student_quantile(double p, double dof);

/// P(z > x) for a standard normal z.
[[nodiscard]] double normal_tail(double x);

/// p-value of the best of `count` ≥ 1 independent tests whose own p-value is `p`: 1 − (1 − p)^count (Šidák), exact for tiny p.
[[nodiscard]] double sidak(double p, double count);

}  // namespace misfit
