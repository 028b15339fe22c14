#pragma once

#include <string>
#include <string_view>

// The only place that writes texts into TOML.

namespace misfit {

/// A string in quotation marks, on one line; quotation marks, backslashes, line breaks and other control characters are escaped. A text
/// that is UTF-8 reads back to itself, others to valid_utf8() of utf8.h.
[[nodiscard]] std::string toml_string(std::string_view text);

/// A key: bare where TOML allows it, else in quotation marks.
[[nodiscard]] std::string toml_key(std::string_view name);

/// What may stand behind '#': one line without control characters, which become blanks.
[[nodiscard]] std::string toml_comment(std::string_view text);

}  // namespace misfit
