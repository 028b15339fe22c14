#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace misfit {

/// Bytes of the character at the front of a text that is not empty (Unicode, table 3-7); 0 if it is no UTF-8.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

[[nodiscard]] bool is_utf8(std::string_view text);

/// Every byte that is no UTF-8 becomes U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

}  // namespace misfit
