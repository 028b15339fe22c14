#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace misfit {

/// even[i]: is the step from sample i to i + 1 within `tolerance` of the median step? Length t.size() − 1 (0 for no samples).
[[nodiscard]] std::vector<bool> even_steps(const std::vector<double>& t, double tolerance);

/// Weights w of Σ w_k f(t[i − 2 + k]) ≈ f'(t[i]): derivative at the middle of the polynomial through five points; (1, −8, 0, 8, −1)/12h for
/// even ones.
[[nodiscard]] std::array<double, 5> derivative_weights(const std::vector<double>& t, std::size_t i);

/// Three-point averages; NaN at the ends, where one of the three is NaN, and across uneven steps.
[[nodiscard]] std::vector<double> three_point_average(const std::vector<double>& f, const std::vector<bool>& even);

/// Derivatives by derivative_weights(); NaN where one of the five is NaN, and across uneven steps.
[[nodiscard]] std::vector<double> five_point_derivative(const std::vector<double>& f, const std::vector<double>& t,
                                                        const std::vector<bool>& even);

}  // namespace misfit
