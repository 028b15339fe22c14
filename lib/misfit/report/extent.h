#pragma once

#include <array>
#include <vector>

namespace misfit::report {

/// Least and largest of those that are finite; {inf, −inf}: none is.
[[nodiscard]] std::array<double, 2> extent_of(const std::vector<double>& values);

/// How many digits all numbers of the range have in common at most, before those that tell them apart: 5 of 12345.6 to 12345.9, 0 of 0
/// to 1.
[[nodiscard]] int digits_before_span(const std::array<double, 2>& range);

}  // namespace misfit::report
