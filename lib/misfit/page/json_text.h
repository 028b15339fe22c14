#pragma once

#include <string>
#include <vector>

#include "misfit/report/figure.h"
#include "misfit/show/blocks.h"

namespace misfit::page {

// JSON as text: results go to the page by these functions alone. null stands for what is not finite.

/// In quotes, escaped; bytes that are no UTF-8 as U+FFFD.
[[nodiscard]] std::string json_string(const std::string& text);
/// Text for readers, typeset as in the report (report/symbols.h): "plain", or [["α", 0], ["T", -1]] (−1: below the line, 1: above it).
[[nodiscard]] std::string json_words(const std::string& text);
[[nodiscard]] std::string json_number(double value);
/// To `digits` significant digits, and as many more as the values have in common (1.7e9 s and what follows).
[[nodiscard]] std::string json_numbers(const std::vector<double>& values, int digits = 6);
/// Values along an axis, such as times: to a 1e-9th of what they span, however far they are from zero (UNIX seconds).
[[nodiscard]] std::string json_places(const std::vector<double>& x);
/// [a,b,…] of texts that are JSON.
[[nodiscard]] std::string json_list(const std::vector<std::string>& items);

/// A figure with all its numbers. Values of x that several series share stand once, in "xs"; a series names its place there.
[[nodiscard]] std::string json_of(const report::Figure& figure);
[[nodiscard]] std::string json_of(const Blocks& blocks);

}  // namespace misfit::page
