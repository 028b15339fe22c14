#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "misfit/data/study.h"

namespace misfit {

// Changes to the text of a study that keep everything else as it is, comments and layout included, however TOML lets it be written:
// headers, inline tables, dotted keys. After every change the text is read again: where it would say anything else than before and the
// change, it is refused (InputError without the file's name).

/// Every entry that names an existing file, taken from the study's folder, rewritten so that it names the same file from `folder`. Absolute
/// paths stay. A path that is no UTF-8, which TOML cannot name, is refused, or its odd bytes become U+FFFD.
enum class OddPaths { refuse, replace };
[[nodiscard]] std::string text_for_folder(const Study& study, const std::filesystem::path& folder, OddPaths odd = OddPaths::refuse);

/// What the line of an effect says of its parameters.
struct EffectStart {
  std::map<std::string, double> values = {};       ///< to start from [SI]
  std::vector<std::string> free = {}, fixed = {};  ///< estimated, or fixed, unlike the effect says itself
};
/// The line of [effects] for an effect: "bearing = { kind = \"coulomb_friction\", rate = \"omega\" }".
[[nodiscard]] std::string effect_line(const std::string& name, const std::string& kind, const std::map<std::string, std::string>& roles,
                                      const EffectStart& start = {});

/// `line` after the last entry of [effects]; the section is made where there is none.
[[nodiscard]] std::string with_effect(const std::string& text, const std::string& line);

/// The entry KEY of [section] as a comment with `why` behind it; out of an inline table the comment stands above it. Text unchanged if
/// there is no such entry.
[[nodiscard]] std::string without_entry(const std::string& text, const std::string& section, const std::string& key,
                                        const std::string& why);

/// The entry KEY of [section] under another name; text unchanged if there is no such entry.
[[nodiscard]] std::string with_renamed_entry(const std::string& text, const std::string& section, const std::string& key,
                                             const std::string& name);

/// The value at a path of tables, {"parameters", "k", "free"} = "false" (as TOML writes it, on one line): in place of the one that is
/// there, else as an entry of the innermost table that is there; a section is made where there is none. An element of [[experiment]] goes
/// by its number, from "0". InputError if `value` is no value, or the path leads through one or to a table.
[[nodiscard]] std::string with_value(const std::string& text, const std::vector<std::string>& path, const std::string& value);

/// Where [parameters] of the text says something of a parameter: under its name, or, without quotation marks, under the parts of a name
/// with a point. Its parts where it says nothing. with_value() finds it, too.
[[nodiscard]] std::vector<std::string> parameter_path(const std::string& text, const std::string& name);

/// [system] kind = "KIND" instead of what is there. InputError if the study has no such line.
[[nodiscard]] std::string with_system(const std::string& text, const std::string& kind);

}  // namespace misfit
