#pragma once

#include <functional>
#include <string>
#include <vector>

#include "misfit/core/toml_outline.h"

namespace misfit {

/// A TOML text as a tree that can be completed and written again: entries in the order of the text, new ones after them. Comments and
/// layout are not kept.
class TomlDocument {
 public:
  /// InputError as toml_outline().
  explicit TomlDocument(const std::string& text);

  [[nodiscard]] bool has(const TomlPath& path) const { return find(path) != nullptr; }
  [[nodiscard]] bool is_table(const TomlPath& path) const;
  [[nodiscard]] bool is_array(const TomlPath& path) const;
  /// Keys of a table, numbers of an array; none of anything else.
  [[nodiscard]] std::vector<std::string> keys(const TomlPath& path) const;
  /// `value` as TOML instead of what is there; the tables that lead to it are made where they are missing.
  void set(const TomlPath& path, const std::string& value);
  /// Puts a table at the top first.
  void put_first(const std::string& key);

  [[nodiscard]] std::string value(const TomlPath& path) const;  ///< as TOML on one line; empty if there is none

  /// Tables at the top, and tables in an array there, under headers; everything below on one line each, with `comment` of its path and
  /// value behind it.
  [[nodiscard]] std::string text(const std::function<std::string(const TomlPath& path, const std::string& value)>& comment) const;

 private:
  struct Entry {
    std::string key;
    TomlNode::Kind kind = TomlNode::Kind::table;
    std::string value = {};  ///< as TOML, of what is no table and no array
    std::vector<Entry> entries = {};

    [[nodiscard]] std::string text() const;  ///< on one line
  };
  [[nodiscard]] const Entry* find(const TomlPath& path) const;

  Entry root_;
};

/// Numbers so that they read back to themselves; lists of them and of texts.
[[nodiscard]] std::string toml_number(double value);
[[nodiscard]] std::string toml_list(const std::vector<std::string>& values);  ///< of values that are TOML
[[nodiscard]] std::string toml_texts(const std::vector<std::string>& texts);  ///< a list of strings

/// A section as its header stands in the file: "[system]", of "experiment[1]" "[[experiment]] (number 2)".
[[nodiscard]] std::string section_in_words(const std::string& path);

}  // namespace misfit
