#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "misfit/core/config.h"
#include "misfit/core/toml_document.h"

namespace misfit::config {

enum class KeyType { text, choice, flag, integer, number, number_with_sigma, numbers, texts, file, table, other };

/// One key of a file: the only place of its name, type, unit, default and limits. Its reader (DescribedSection), its reference
/// (key_reference) and resolved.toml take them from here.
struct Key {
  std::string name;  ///< in capitals where `any`
  KeyType type = KeyType::text;
  std::string unit = {};                                    ///< of numbers: SI, or in words ("of the state"); empty: none
  std::string fallback = {};                                ///< the default as TOML; empty: `otherwise` holds
  std::string otherwise = {};                               ///< what holds where the key is absent, in words ("required", "none")
  double least = -std::numeric_limits<double>::infinity();  ///< of numbers [unit]
  double most = std::numeric_limits<double>::infinity();
  bool above = false;                     ///< `least` itself is not allowed
  std::vector<std::string> choices = {};  ///< of a choice, or of the elements of a list of texts
  std::string form = {};                  ///< how it is written, where the type does not say it
  std::vector<std::string> needs = {};    ///< it has a meaning only beside one of these keys
  bool any = false;                       ///< stands for any name: of a state, a parameter, a curve
  std::string formerly = {};              ///< what it was called before: refused, naming the new one
  std::string meaning;
};

/// One table of the file: "uncertainty", "curves.NAME" for every table in [curves].
struct KeyGroup {
  std::string path;
  std::string meaning;
  std::vector<Key> keys;
  bool several = false;      ///< [[experiment]]
  std::string variant = {};  ///< tells tables of one path apart: "formula"
  bool dotted = false;       ///< the last NAME may have a point, A.B, which without quotation marks is a table in a table

  /// The key of that name, else the one for any name; std::logic_error if there is none: a reader asks only for what stands here.
  [[nodiscard]] const Key& key(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> names() const;  ///< but for those that stand for any name
};

/// The group of that path; std::logic_error if there is none.
[[nodiscard]] const KeyGroup& group_of(std::span<const KeyGroup> groups, std::string_view path, std::string_view variant = "");

/// Tables at the top of the file, in order.
[[nodiscard]] std::vector<std::string> sections_of(std::span<const KeyGroup> groups);

/// What describes the entry at this path of a file: one of its name, else the one for any name; nullptr if nothing does. Numbers of the
/// elements of an array of tables count as no part of the path.
[[nodiscard]] const Key* find_key(std::span<const KeyGroup> groups, const TomlPath& path);

/// Sets every default that can be written as TOML in the tables that are there.
void fill_defaults(std::span<const KeyGroup> groups, TomlDocument& document);

/// "whole number, 1 to 100"; "number [m] above 0".
[[nodiscard]] std::string type_text(const Key& key);

/// A table read by its description: what is absent has its default, nullopt where there is none. InputError as Section, and for numbers
/// outside their limits.
class DescribedSection : public Section {
 public:
  DescribedSection(const Section& section, const KeyGroup& group);

  [[nodiscard]] const KeyGroup& description() const { return *group_; }
  [[nodiscard]] std::optional<Number> number(std::string_view key) const;
  [[nodiscard]] std::optional<double> value(std::string_view key) const;                         ///< of a number [SI]
  [[nodiscard]] std::optional<double> value(std::string_view key, std::string_view unit) const;  ///< unit in words in the description
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key) const;
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::string_view unit) const;
  [[nodiscard]] std::optional<std::vector<Number>> quantities(std::string_view key) const;
  [[nodiscard]] std::optional<bool> flag(std::string_view key) const;
  [[nodiscard]] std::optional<long> integer(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> choice(std::string_view key) const;
  [[nodiscard]] std::optional<std::vector<std::string>> texts(std::string_view key) const;  ///< each once; among the choices, if any
  [[nodiscard]] std::optional<Section> table(std::string_view key) const;

  /// InputError for a key that the description does not have: before one that is needed is missed, since that may be the one.
  void refuse_unknown() const;
  /// As Section::finish; InputError too for a key without any of those that it needs.
  void finish() const;

 private:
  template <class Read>
  auto read(std::string_view key, const Read& from) const;
  void check_limits(const Key& key, double value) const;

  const KeyGroup* group_;
  Section defaults_;
};

/// Every key with type, unit, limits, default and meaning, grouped by table, in lines of at most `width` characters.
[[nodiscard]] std::string key_reference(std::span<const KeyGroup> groups, std::size_t width = 100);

}  // namespace misfit::config
