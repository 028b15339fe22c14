#pragma once

// The text of a study as study_edit.h changes it: not for other files than study_edit.cpp and study_files.cpp.

#include <map>
#include <string>
#include <vector>

#include "misfit/core/toml_outline.h"

namespace misfit {

/// A TOML text with what stands where.
class StudyText {
 public:
  explicit StudyText(const std::string& text) : text_(text), nodes_(toml_outline(text)) {}

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<TomlNode>& nodes() const { return nodes_; }
  [[nodiscard]] const TomlNode* find(const TomlPath& path) const;
  [[nodiscard]] std::vector<const TomlNode*> entries(const TomlNode& table) const;
  /// Is it a table that stands under a header, [NAME] or [[NAME]]?
  [[nodiscard]] bool has_header(const TomlNode& node) const;
  /// … and under one of its own, not only because [NAME.MORE] is there?
  [[nodiscard]] bool has_own_header(const TomlNode& node) const;
  /// The inline table that a value stands in; nullptr if it is in none.
  [[nodiscard]] const TomlNode* outermost_inline(const TomlNode& node) const;
  /// Where its last value ends, tables under headers of their own aside.
  [[nodiscard]] std::size_t end_of(const TomlNode& node) const;
  /// Where the next header begins after `at`, or the end of the text.
  [[nodiscard]] std::size_t next_header(std::size_t at) const;

  [[nodiscard]] std::size_t line_begin(std::size_t at) const;
  [[nodiscard]] std::size_t line_end(std::size_t at) const;  ///< before its "\n" or "\r\n"
  [[nodiscard]] std::string newline() const { return text_.find("\r\n") == std::string::npos ? "\n" : "\r\n"; }

 private:
  const std::string& text_;
  std::vector<TomlNode> nodes_;
};

/// What a text says: every value by its path, but those under `without`, whose place goes by the name of `as` where that is given.
[[nodiscard]] std::map<TomlPath, std::string> values_of(const StudyText& study, const TomlPath& without, const TomlPath& as = {});

}  // namespace misfit
