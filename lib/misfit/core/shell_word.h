#pragma once

#include <string>

namespace misfit {

/// A word of a shell: in quotation marks where it has characters other than letters, digits and ./-_:
[[nodiscard]] std::string shell_word(const std::string& text);

}  // namespace misfit
