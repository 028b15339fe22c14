#include "misfit/core/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit::config {
namespace {

std::string defaults_text(const KeyGroup& group) {
  std::string text;
  for (const Key& key : group.keys) {
    if (!key.fallback.empty()) text += key.name + " = " + key.fallback + "\n";
  }
  return text;
}

/// With its unit, an angle in degrees: "30 deg" for 0.5236 rad. 0 needs none.
std::string limit_text(double limit, const Key& key) {
  if (limit == 0.0 || key.unit.empty() || key.unit.starts_with("of ")) return fmt::format("{:.10g}", limit);
  const std::string shown_unit = display_unit(key.unit);
  return fmt::format("{:.10g} {}", shown_unit == key.unit ? limit : convert(limit, key.unit, shown_unit), shown_unit);
}

/// "above 0 and at most 30 deg", "1 to 100", "at least 0"; empty if everything is allowed.
std::string limits_text(const Key& key) {
  const bool bounded = std::isfinite(key.most);
  if (!std::isfinite(key.least)) return bounded ? "at most " + limit_text(key.most, key) : "";
  const std::string least = limit_text(key.least, key);
  if (!bounded) return (key.above ? "above " : "at least ") + least;
  return key.above ? "above " + least + " and at most " + limit_text(key.most, key) : least + " to " + limit_text(key.most, key);
}

std::string choices_text(const std::vector<std::string>& choices) {
  std::string out;
  for (std::size_t i = 0; i < choices.size(); ++i) out += (i == 0 ? "\"" : i + 1 == choices.size() ? " or \"" : ", \"") + choices[i] + "\"";
  return out;
}

std::string plain_type(const Key& key) {
  if (!key.form.empty()) return key.form;
  switch (key.type) {
    case KeyType::choice:
      return choices_text(key.choices);
    case KeyType::flag:
      return "true or false";
    case KeyType::integer:
      return "whole number";
    case KeyType::number:
      return "number";
    case KeyType::number_with_sigma:
      return "number or { value, sigma }";
    case KeyType::numbers:
      return "list of numbers";
    case KeyType::texts:
      return key.choices.empty() ? "list of texts" : "list of " + choices_text(key.choices);
    case KeyType::file:
      return "file";
    case KeyType::table:
      return "table";
    default:
      return "text";
  }
}

std::string default_text(const Key& key) {
  if (!key.fallback.empty()) return "default " + key.fallback;
  return (key.otherwise.starts_with("required") ? "" : "default: ") + key.otherwise;
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

bool fits(const TomlPath& path, const KeyGroup& group) {
  std::vector<std::string> pattern = parts_of(group.path);
  if (group.dotted && path.size() == pattern.size() + 1) pattern.emplace_back("NAME");
  return std::equal(path.begin(), path.end(), pattern.begin(), pattern.end(),
                    [](const std::string& key, const std::string& wanted) { return wanted == "NAME" || key == wanted; });
}

/// The tables of a document that a group describes.
std::vector<TomlPath> tables_of(const KeyGroup& group, const TomlDocument& document) {
  std::vector<TomlPath> found{{}};
  std::vector<std::string> pattern = parts_of(group.path);
  if (group.several && document.is_array({group.path})) pattern.emplace_back("NAME");
  for (const std::string& part : pattern) {
    std::vector<TomlPath> below;
    for (const TomlPath& path : found) {
      for (const std::string& key : document.keys(path)) {
        if (part != "NAME" && part != key) continue;
        below.push_back(path);
        below.back().push_back(key);
      }
    }
    found = std::move(below);
  }
  std::erase_if(found, [&](const TomlPath& path) { return !document.is_table(path); });
  return found;
}

/// "[curves] NAME = { … }", "[[experiment]]".
std::string heading(const KeyGroup& group) {
  if (group.several) return "[[" + group.path + "]]";
  const std::vector<std::string> parts = parts_of(group.path);
  std::string out = "[" + parts.front() + "]", end;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    out += (i == 1 ? " " : "{ ") + parts[i] + " = ";
    end += " }";
  }
  return end.empty() ? out : out + "{ …" + end;
}

}  // namespace

const Key& KeyGroup::key(std::string_view name) const {
  const auto named = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == name && !k.any; });
  if (named != keys.end()) return *named;
  const auto any = std::find_if(keys.begin(), keys.end(), [](const Key& k) { return k.any; });
  if (any == keys.end()) throw std::logic_error("[" + path + "] has no description of the key " + std::string(name));
  return *any;
}

std::vector<std::string> KeyGroup::names() const {
  std::vector<std::string> out;
  for (const Key& key : keys) {
    if (!key.any) out.push_back(key.name);
  }
  return out;
}

std::vector<std::string> sections_of(std::span<const KeyGroup> groups) {
  std::vector<std::string> out;
  for (const KeyGroup& group : groups) {
    const std::string name = group.path.substr(0, group.path.find('.'));
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

const KeyGroup& group_of(std::span<const KeyGroup> groups, std::string_view path, std::string_view variant) {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const KeyGroup& g) { return g.path == path && g.variant == variant; });
  if (found == groups.end()) throw std::logic_error("there is no description of [" + std::string(path) + "]");
  return *found;
}

const Key* find_key(std::span<const KeyGroup> groups, const TomlPath& path) {
  const Key* any = nullptr;
  TomlPath table(path.begin(), path.end() - 1);
  const bool several = std::any_of(groups.begin(), groups.end(), [&](const KeyGroup& g) { return g.several && g.path == path.front(); });
  if (several && table.size() > 1 && table[1].find_first_not_of("0123456789") == std::string::npos) table.erase(table.begin() + 1);
  for (const KeyGroup& group : groups) {
    if (!fits(table, group)) continue;
    for (const Key& key : group.keys) {
      if (key.name == path.back() && !key.any) return &key;
      if (key.any && any == nullptr) any = &key;
    }
  }
  return any;
}

namespace {

void fill_default(const TomlPath& table, const Key& key, TomlDocument& document) {
  const auto in_table = [&](const std::string& name) {
    TomlPath path = table;
    path.push_back(name);
    return path;
  };
  const auto there = [&](const std::string& name) { return document.has(in_table(name)); };
  const bool needless = !key.needs.empty() && std::none_of(key.needs.begin(), key.needs.end(), there);
  const bool said = key.fallback.empty() || key.fallback == "\"\"";
  if (!said && !needless && !key.any && !there(key.name)) document.set(in_table(key.name), key.fallback);
}

}  // namespace

void fill_defaults(std::span<const KeyGroup> groups, TomlDocument& document) {
  for (const KeyGroup& group : groups) {
    for (const TomlPath& table : tables_of(group, document)) {
      for (const Key& key : group.keys) fill_default(table, key, document);
    }
  }
}

std::string type_text(const Key& key) {
  std::string out = plain_type(key);
  if (!key.unit.empty()) out += " [" + (key.unit.starts_with("of ") ? "unit " + key.unit : key.unit) + "]";
  const std::string limits = limits_text(key);
  return limits.empty() ? out : out + ", " + limits;
}

DescribedSection::DescribedSection(const Section& section, const KeyGroup& group)
    : Section(section), group_(&group), defaults_(Section::parse(defaults_text(group), "defaults of " + group.path)) {}

/// `from` is called with the table that has the key: the file's, or that of the defaults.
template <class Read>
auto DescribedSection::read(std::string_view key, const Read& from) const {
  const Key& description = group_->key(key);
  const auto given = from(static_cast<const Section&>(*this), description);
  return given || description.fallback.empty() ? given : from(defaults_, description);
}

void DescribedSection::check_limits(const Key& key, double value) const {
  if (value > key.most || value < key.least || (key.above && value == key.least)) fail(key.name, "must be " + limits_text(key));
}

std::optional<Number> DescribedSection::number(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& k) {
    auto number = section.number(key, k.unit, k.type == KeyType::number_with_sigma);
    if (number) check_limits(k, number->value);
    return number;
  });
}

std::optional<double> DescribedSection::value(std::string_view key) const { return value(key, group_->key(key).unit); }

std::optional<double> DescribedSection::value(std::string_view key, std::string_view unit) const {
  return read(key, [&](const Section& section, const Key& k) -> std::optional<double> {
    auto number = section.number(key, unit);
    if (!number) return std::nullopt;
    check_limits(k, number->value);
    return number->value;
  });
}

std::optional<std::vector<double>> DescribedSection::numbers(std::string_view key) const { return numbers(key, group_->key(key).unit); }

std::optional<std::vector<double>> DescribedSection::numbers(std::string_view key, std::string_view unit) const {
  return read(key, [&](const Section& section, const Key& /*k*/) { return section.numbers(key, unit); });
}

std::optional<std::vector<Number>> DescribedSection::quantities(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& /*k*/) { return section.quantities(key); });
}

std::optional<bool> DescribedSection::flag(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& /*k*/) { return section.flag(key); });
}

std::optional<long> DescribedSection::integer(std::string_view key) const {
  constexpr double most = 9.2e18;
  return read(key, [&](const Section& section, const Key& k) {
    return section.integer(key, std::lround(std::max(k.least, -most)),
                           k.most < most ? std::lround(k.most) : std::numeric_limits<long>::max());
  });
}

std::optional<std::string> DescribedSection::text(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& /*k*/) { return section.text(key); });
}

std::optional<std::string> DescribedSection::choice(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& k) { return section.choice(key, k.choices); });
}

std::optional<std::vector<std::string>> DescribedSection::texts(std::string_view key) const {
  auto names = read(key, [&](const Section& section, const Key& /*k*/) { return section.texts(key); });
  if (!names) return names;
  const std::vector<std::string>& valid = group_->key(key).choices;
  for (auto it = names->begin(); it != names->end(); ++it) {
    if (!valid.empty() && std::find(valid.begin(), valid.end(), *it) == valid.end())
      fail(key, "unknown name '" + shown(*it) + "'" + suggest(*it, valid));
    if (std::find(names->begin(), it, *it) != it) fail(key, "'" + shown(*it) + "' is given twice");
  }
  return names;
}

std::optional<Section> DescribedSection::table(std::string_view key) const {
  return read(key, [&](const Section& section, const Key& /*k*/) { return section.table(key); });
}

void DescribedSection::refuse_unknown() const {
  const std::vector<std::string> known = group_->names();
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) fail_unknown(key, known);
  }
}

void DescribedSection::finish() const {
  for (const Key& key : group_->keys) {
    if (!key.formerly.empty() && has(key.formerly)) fail(key.formerly, "this key is called " + key.name + " now");
  }
  Section::finish(group_->names());
  for (const Key& key : group_->keys) {
    const bool alone = !key.needs.empty() && std::none_of(key.needs.begin(), key.needs.end(), [&](const auto& n) { return has(n); });
    if (alone && has(key.name)) fail(key.name, "has no meaning without " + key.needs.front());
  }
}

std::string key_reference(std::span<const KeyGroup> groups, std::size_t width) {
  std::string out;
  for (const KeyGroup& group : groups) {
    out += heading(group) + "\n" + wrap_text(group.meaning, width, "  ") + "\n";
    std::size_t column = 0;
    for (const Key& key : group.keys) column = std::max(column, key.name.size());
    const std::string indent(column + 4, ' ');
    for (const Key& key : group.keys) {
      const std::string lines = wrap_text(type_text(key) + "; " + default_text(key), width, indent);
      out += "  " + key.name + lines.substr(2 + key.name.size()) + "\n" + wrap_text(key.meaning, width, indent) + "\n";
    }
    out += "\n";
  }
  return out;
}

}  // namespace misfit::config
