#pragma once

#include <cstddef>
#include <string_view>

namespace misfit {

inline constexpr std::size_t longest_name_compared = 100;  ///< bytes: a longer text is no misspelt name

/// Levenshtein distance in bytes, two neighbours that changed places counting once (optimal string alignment), capital letters as small
/// ones. A text that is too long to be compared is as far as the longer one is
/// long.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace misfit
