#pragma once

#include <string>

namespace misfit::page {

/// zlib's format (RFC 1950) in base64: about 0.6 bytes for each of a text of numbers. RunError: there is not enough memory.
[[nodiscard]] std::string packed(const std::string& text);

}  // namespace misfit::page
