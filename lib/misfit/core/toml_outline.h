#pragma once

#include <string>
#include <vector>

namespace misfit {

using TomlPath = std::vector<std::string>;  ///< keys from the top, numbers for elements of arrays

/// A value of a TOML text, and where it stands in it. Places are bytes, ends exclusive.
struct TomlNode {
  enum class Kind { text, table, array, other };
  TomlPath path;
  Kind kind = Kind::other;
  std::string value;                       ///< text: what it says; other: as written
  std::size_t key_begin = 0, key_end = 0;  ///< the last part of its key; both 0 for an element of an array
  std::size_t begin = 0, end = 0;          ///< a table made by a header: that header; by a dotted key: that part of the key
  bool inline_table = false;               ///< { … }
};

/// All values of a valid TOML text, parents before what they hold. InputError naming line and column of `text` if it is none.
[[nodiscard]] std::vector<TomlNode> toml_outline(const std::string& text);

/// One value as TOML writes it, on one line.
[[nodiscard]] bool is_toml_value(const std::string& text);

}  // namespace misfit
