#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace misfit {

/// `value ± sigma` with sigma to two significant digits and value to the same place: (12.0312, 0.21) → "12.03 ± 0.21". Without a positive
/// finite sigma: five significant digits. NaN → "not available".
[[nodiscard]] std::string format_value(double value, double sigma = 0.0);

/// Rounded to a multiple of `step`, with the digits that this takes and at least five: (101324.9, 1) → "101325".
[[nodiscard]] std::string format_to_step(double value, double step);

/// "26.10 to 29.57": both to the digits of `sigma` (five significant ones without it).
[[nodiscard]] std::string format_interval(double low, double high, double sigma);

/// A p-value for a table: two significant digits, "< 1e-300" where it is not representable.
[[nodiscard]] std::string format_probability(double p);
/// The same for a sentence: "p = 0.023", "p < 1e-300".
[[nodiscard]] std::string p_equals(double p);

/// Pads columns so that they align (UTF-8 aware: counts code points); first row is the header, underlined. Numbers are not parsed: give
/// strings. Columns marked in `right` end at one place, the others begin at one.
[[nodiscard]] std::string align_columns(const std::vector<std::vector<std::string>>& rows, const std::string& indent = "  ",
                                        const std::vector<bool>& right = {});

/// Breaks at blanks to at most `width` code points.
[[nodiscard]] std::string wrap_text(const std::string& text, std::size_t width = 100, const std::string& indent = "");

/// ASCII letters only: "KW" → "kw".
[[nodiscard]] std::string lower_case(std::string_view text);

/// "1 gap", "3 gaps".
[[nodiscard]] std::string counted(std::size_t n, const std::string& one, const std::string& many);

/// "a", "a and b", "a, b and c".
[[nodiscard]] std::string join_words(const std::vector<std::string>& words);

}  // namespace misfit
