#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace misfit {

inline constexpr std::size_t longest_quote = 50;     ///< characters of a user's text in a message
inline constexpr std::size_t longest_message = 300;  ///< characters of an error message

enum class Escapes {
  plain,  ///< "\x1b"
  json,   ///< "\u001b"
};

/// The text as a terminal may get it: control characters but newline and tab, and bytes that are no UTF-8, as escapes.
[[nodiscard]] std::string printable(std::string_view text, Escapes escapes = Escapes::plain);

/// A user's text for a message: one line, printable, of at most `most` characters with "…" in place of the rest.
[[nodiscard]] std::string shown(std::string_view text, std::size_t most = longest_quote);

/// A message of at most `most` characters: where it is longer, its middle is replaced by "…", so that its place and its end stay.
[[nodiscard]] std::string shortened(std::string_view message, std::size_t most = longest_message);

/// "a, b, c", or, where that is long, those nearest to `name` "and 37 more".
[[nodiscard]] std::string some_names(std::string_view name, const std::vector<std::string>& valid);

/// Bytes at the end of `text` that begin a character of UTF-8 without ending it: 0 to 3.
[[nodiscard]] std::size_t unfinished_bytes(std::string_view text);

}  // namespace misfit
