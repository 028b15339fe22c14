#pragma once

#include <string>

#include "misfit/core/file_name.h"
#include "misfit/core/units.h"

namespace misfit::report {

/// The name of a quantity, a port or a parameter as part of a figure's name, or any text as a column's key: everything but letters, digits,
/// '-' becomes '_'. A name that a user is free to choose goes through file_name_for(): these texts may become equal.
[[nodiscard]] inline std::string as_key(const std::string& text) {
  constexpr std::size_t longest = 80;
  if (text.size() > longest) return file_name_for(text);
  std::string key;
  for (const char c : text) key += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ? c : '_';
  return key;
}

}  // namespace misfit::report
