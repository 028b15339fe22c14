#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace misfit {

[[nodiscard]] bool is_utf8(std::string_view text);

/// Every byte that is no UTF-8 becomes U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// For a terminal, a comment or a title: UTF-8, one line, control characters as blanks; of more than `most` bytes the first ones and "…".
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = std::string_view::npos);

}  // namespace misfit
