#pragma once

#include <string>

namespace misfit::report {

/// A text for a page or a drawing: no line ends between a value, its ±, its sigma and their unit ("12.0 ± 0.1 deg", "-84 %", "p = 0.1"),
/// and minus signs of numbers are U+2212. Hyphens of words, dates, ranges and options stay; so does all that is copied as it is (commands,
/// files).
[[nodiscard]] std::string unbroken(const std::string& text);

}  // namespace misfit::report
