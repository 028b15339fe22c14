#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "misfit/core/config.h"
#include "misfit/core/text.h"

namespace misfit::config {
namespace {

void append(const toml::table& table, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out);

void append(const toml::node& node, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out) {
  if (const toml::table* table = node.as_table()) {
    append(*table, path, without, out);
  } else if (const toml::array* array = node.as_array()) {
    out << '[';
    for (const toml::node& element : *array) {
      append(element, path, without, out);
      out << ',';
    }
    out << ']';
  } else {
    node.visit([&](const auto& value) {
      if constexpr (toml::is_floating_point<decltype(value)>) {
        out << std::hexfloat << value.get() << std::defaultfloat;
      } else if constexpr (toml::is_value<decltype(value)>) {
        out << toml::json_formatter(value);
      }
    });
  }
}

void append(const toml::table& table, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out) {
  std::vector<std::pair<toml::source_position, std::string>> keys;
  for (const auto& [key, node] : table) keys.emplace_back(key.source().begin, std::string(key.str()));
  std::sort(keys.begin(), keys.end());
  out << '{';
  for (const auto& [position, key] : keys) {
    const std::string there = path.empty() ? key : path + "." + key;
    if (std::find(without.begin(), without.end(), there) != without.end()) continue;
    out << toml::json_formatter(toml::value<std::string>(key)) << ':';
    append(*table.get(key), there, without, out);
    out << ',';
  }
  out << '}';
}

}  // namespace

std::string content_of(const std::string& text, const std::vector<std::string>& without) {
  std::ostringstream out;
  append(toml::parse(text), "", without, out);
  return out.str();
}

}  // namespace misfit::config
