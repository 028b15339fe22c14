#include "misfit/core/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "misfit/core/shown.h"
#include "misfit/core/toml_text.h"

namespace misfit {

using Kind = TomlNode::Kind;

namespace {

/// The entry of that name; nullptr if there is none.
template <class Entry>
Entry* entry_of(Entry& table, const std::string& name) {
  for (auto& e : table.entries) {
    if (e.key == name) return &e;
  }
  return nullptr;
}

}  // namespace

std::string TomlDocument::Entry::text() const {
  if (kind != Kind::table && kind != Kind::array) return value;
  std::vector<std::string> parts;
  for (const Entry& e : entries) parts.push_back((kind == Kind::table ? toml_key(e.key) + " = " : "") + e.text());
  if (kind == Kind::array) return toml_list(parts);
  return parts.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

TomlDocument::TomlDocument(const std::string& text) {
  for (const TomlNode& node : toml_outline(text)) {
    Entry* parent = &root_;
    for (std::size_t i = 0; i + 1 < node.path.size(); ++i) parent = entry_of(*parent, node.path[i]);
    parent->entries.push_back({node.path.back(), node.kind, node.kind == Kind::text ? toml_string(node.value) : node.value});
  }
}

const TomlDocument::Entry* TomlDocument::find(const TomlPath& path) const {
  const Entry* at = &root_;
  for (const std::string& key : path) {
    at = entry_of(*at, key);
    if (at == nullptr) return nullptr;
  }
  return at;
}

bool TomlDocument::is_table(const TomlPath& path) const {
  const Entry* found = find(path);
  return found != nullptr && found->kind == Kind::table;
}

bool TomlDocument::is_array(const TomlPath& path) const {
  const Entry* found = find(path);
  return found != nullptr && found->kind == Kind::array;
}

std::string TomlDocument::value(const TomlPath& path) const {
  const Entry* found = find(path);
  return found == nullptr ? "" : found->text();
}

std::vector<std::string> TomlDocument::keys(const TomlPath& path) const {
  std::vector<std::string> out;
  const Entry* found = find(path);
  if (found == nullptr) return out;
  for (const Entry& e : found->entries) out.push_back(e.key);
  return out;
}

void TomlDocument::set(const TomlPath& path, const std::string& value) {
  Entry* at = &root_;
  for (const std::string& key : path) {
    if (at->kind != Kind::table && at->kind != Kind::array) *at = {at->key, Kind::table};
    Entry* next = entry_of(*at, key);
    if (next == nullptr) next = &at->entries.emplace_back(Entry{key});
    at = next;
  }
  *at = {path.back(), Kind::other, value};
}

void TomlDocument::put_first(const std::string& key) {
  if (entry_of(root_, key) == nullptr) root_.entries.push_back({key});
  const auto found = std::find_if(root_.entries.begin(), root_.entries.end(), [&](const Entry& e) { return e.key == key; });
  std::rotate(root_.entries.begin(), found, found + 1);
}

std::string TomlDocument::text(const std::function<std::string(const TomlPath& path, const std::string& value)>& comment) const {
  std::string out;
  const auto add_table = [&](const Entry& table, TomlPath path, const std::string& header) {
    out += "\n" + header + "\n";
    path.emplace_back();
    for (const Entry& e : table.entries) {
      path.back() = e.key;
      const std::string value = e.text(), behind = comment(path, value);
      out += toml_key(e.key) + " = " + value + (behind.empty() ? "" : "  # " + toml_comment(behind)) + "\n";
    }
  };
  for (const Entry& e : root_.entries) {
    if (e.kind == Kind::table) add_table(e, {e.key}, "[" + toml_key(e.key) + "]");
    if (e.kind != Kind::array) continue;
    for (const Entry& element : e.entries) add_table(element, {e.key, element.key}, "[[" + toml_key(e.key) + "]]");
  }
  return out;
}

std::string toml_number(double value) { return fmt::format("{}", value); }

std::string toml_list(const std::vector<std::string>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

std::string toml_texts(const std::vector<std::string>& texts) {
  std::vector<std::string> values;
  for (const std::string& text : texts) values.push_back(toml_string(text));
  return toml_list(values);
}

std::string section_in_words(const std::string& path) {
  const std::size_t open = path.rfind('[');
  if (open == std::string::npos || path.back() != ']') return "[" + shown(path) + "]";
  const int place = std::atoi(path.c_str() + open + 1) + 1;
  return "[[" + shown(path.substr(0, open)) + "]]" + (place > 1 ? fmt::format(" (number {})", place) : "");
}

}  // namespace misfit
