#include "misfit/data/study_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/toml_text.h"
#include "misfit/data/study_text.h"

namespace misfit {
namespace {

/// `after` must say what `before` says, but for what stands under `path`, which goes by the name of `as` if one is given.
void refuse_unless_same(const StudyText& before, const std::string& after, const TomlPath& path, const TomlPath& as = {}) {
  const std::string refusal = fmt::format(
      "[{}] cannot be changed as it is written: write its entries below a header of its own, one line each", toml_key(path.front()));
  try {
    const bool same = as.empty() ? values_of(before, path) == values_of(StudyText(after), path)
                                 : values_of(before, path, as) == values_of(StudyText(after), {}, as);
    if (same) return;
  } catch (const InputError& error) {
    throw InputError(refusal + " (it would be " + error.what() + ")");
  }
  throw InputError(refusal);
}

/// The key of "NAME = …".
std::string name_of(const std::string& line) { return toml_outline(line).front().path.front(); }

std::string inserted(const std::string& text, std::size_t at, const std::string& piece) {
  return text.substr(0, at) + piece + text.substr(at);
}

/// `entry` as the last one between the braces of an inline table.
std::string with_inline_entry(const StudyText& study, const TomlNode& table, const std::string& entry) {
  if (study.entries(table).empty()) return study.text().substr(0, table.begin) + "{ " + entry + " }" + study.text().substr(table.end);
  std::size_t end = 0;
  for (const TomlNode* known : study.entries(table)) end = std::max(end, study.end_of(*known));
  return inserted(study.text(), end, ", " + entry);
}

std::string with_new_section(const StudyText& study, const std::string& section, const std::string& line) {
  const std::string& text = study.text();
  const std::string end = study.newline();
  return text + (text.empty() || text.back() == '\n' ? "" : end) + end + "[" + section + "]" + end + line + end;
}

/// Lines, by where they begin.
using Lines = std::set<std::size_t>;

void add_lines(const StudyText& study, std::size_t begin, std::size_t end, Lines& lines) {
  for (std::size_t at = study.line_begin(begin); at < end; at = study.text().find('\n', at) + 1) {
    lines.insert(at);
    if (study.text().find('\n', at) == std::string::npos) return;
  }
}

/// The lines that make an entry, wherever they stand.
void lines_of(const StudyText& study, const TomlNode& node, Lines& lines) {
  if (node.kind != TomlNode::Kind::table || node.inline_table) {
    add_lines(study, node.key_begin, node.end, lines);
    return;
  }
  if (study.has_header(node)) add_lines(study, node.begin, study.next_header(node.begin), lines);
  for (const TomlNode* entry : study.entries(node)) lines_of(study, *entry, lines);
}

std::string as_comments(const StudyText& study, const Lines& lines, const std::string& why) {
  std::string out;
  std::size_t done = 0;
  for (const std::size_t at : lines) {
    const std::size_t end = study.line_end(at);
    out += study.text().substr(done, at - done);
    const std::string line = study.text().substr(at, end - at);
    out += line.find_first_not_of(" \t\r") == std::string::npos ? line : "# " + line;
    if (at == *lines.begin()) out += "  # " + toml_comment(why);
    done = end;
  }
  return out + study.text().substr(done);
}

/// Without an entry between braces; what it was stands in a comment above.
std::string without_inline_entry(const StudyText& study, const TomlNode& node, const std::string& why) {
  const TomlPath above(node.path.begin(), node.path.end() - 1);
  const TomlNode& table = *study.find(above);
  const std::string& text = study.text();
  const std::size_t end = study.end_of(node);
  std::size_t before = 0, next = text.size();  // where the entry before it ends, and the one behind it begins
  for (const TomlNode* other : study.entries(table)) {
    if (other->key_begin < node.key_begin) before = std::max(before, study.end_of(*other));
    if (other->key_begin > end) next = std::min(next, other->key_begin);
  }
  const std::size_t from = before > 0 ? before : node.key_begin;
  const std::size_t to = before > 0 || next == text.size() ? end : next;
  const std::size_t line = study.line_begin(study.outermost_inline(node)->key_begin);
  const std::string comment =
      "# " + toml_comment(text.substr(node.key_begin, end - node.key_begin)) + "  # " + toml_comment(why) + study.newline();
  return text.substr(0, line) + comment + text.substr(line, from - line) + text.substr(to);
}

/// "a.b.c" of the last parts of a path.
std::string dotted(const TomlPath& path, std::size_t first) {
  std::vector<std::string> keys;
  for (std::size_t k = first; k < path.size(); ++k) keys.push_back(toml_key(path[k]));
  return fmt::format("{}", fmt::join(keys, "."));
}

/// The innermost table on the way to `path` for which `holds`; nullptr: none.
template <class Holds>
const TomlNode* innermost(const StudyText& study, TomlPath path, const Holds& holds) {
  for (path.pop_back(); !path.empty(); path.pop_back()) {
    const TomlNode* node = study.find(path);
    if (node != nullptr && holds(*node)) return node;
  }
  return nullptr;
}

std::string with_new_value(const StudyText& study, const TomlPath& path, const std::string& value) {
  const TomlNode* above = innermost(study, path, [](const TomlNode&) { return true; });
  if (above != nullptr && above->kind != TomlNode::Kind::table) throw InputError(dotted(above->path, 0) + " has no keys");
  if (above != nullptr && above->inline_table) return with_inline_entry(study, *above, dotted(path, above->path.size()) + " = " + value);
  const TomlNode* header = innermost(study, path, [&](const TomlNode& node) { return study.has_own_header(node); });
  const bool of_keys = above != nullptr && !study.has_header(*above);  // a.b = … makes the table a
  if (header == nullptr && !of_keys) return with_new_section(study, toml_key(path.front()), dotted(path, 1) + " = " + value);
  const std::string entry = dotted(path, header != nullptr ? header->path.size() : 0) + " = " + value;
  const std::size_t end = study.line_end(study.end_of(of_keys ? *above : *header));
  return inserted(study.text(), end, study.newline() + entry);
}

/// The keys that `name` may be written as: with quotation marks around all of it, around two parts, around none.
std::vector<TomlPath> spellings(const std::string& name) {
  std::vector<TomlPath> out{{name}};
  TomlPath parts;
  std::size_t begin = 0;
  for (std::size_t point = name.find('.'); point != std::string::npos; point = name.find('.', begin)) {
    out.push_back({name.substr(0, point), name.substr(point + 1)});
    parts.push_back(name.substr(begin, point - begin));
    begin = point + 1;
  }
  parts.push_back(name.substr(begin));
  out.push_back(parts);
  return out;
}

/// Where the text has this entry of [parameters]; empty: nowhere.
TomlPath spelled(const StudyText& study, const std::string& name) {
  for (const TomlPath& keys : spellings(name)) {
    TomlPath path{"parameters"};
    path.insert(path.end(), keys.begin(), keys.end());
    if (study.find(path) != nullptr) return path;
  }
  return {};
}

/// The path to an entry of [parameters], or to a key of one, as the text spells the parameter's name.
TomlPath as_spelled(const StudyText& study, const TomlPath& path) {
  if (path.front() != "parameters" || path.size() < 3 || study.find(path) != nullptr) return path;
  for (const auto end : {path.end(), path.end() - 1}) {
    TomlPath out = spelled(study, fmt::format("{}", fmt::join(path.begin() + 1, end, ".")));
    if (out.empty()) continue;
    out.insert(out.end(), end, path.end());
    return out;
  }
  return path;
}

}  // namespace

std::vector<std::string> parameter_path(const std::string& text, const std::string& name) {
  TomlPath path = spelled(StudyText(text), name);
  if (!path.empty()) return path;
  path = spellings(name).back();
  path.insert(path.begin(), "parameters");
  return path;
}

std::string effect_line(const std::string& name, const std::string& kind, const std::map<std::string, std::string>& roles,
                        const EffectStart& start) {
  std::vector<std::string> entries;
  if (kind != name) entries.push_back("kind = " + toml_string(kind));
  for (const auto& [role, target] : roles) entries.push_back(toml_key(role) + " = " + toml_string(target));
  std::vector<std::string> values;
  for (const auto& [parameter, value] : start.values) values.push_back(fmt::format("{} = {:.6g}", toml_key(parameter), value));
  if (!values.empty()) entries.push_back(fmt::format("start = {{ {} }}", fmt::join(values, ", ")));
  for (const auto& [key, list] : {std::pair{"free", &start.free}, std::pair{"fixed", &start.fixed}}) {
    std::vector<std::string> quoted;
    for (const std::string& parameter : *list) quoted.push_back(toml_string(parameter));
    if (!quoted.empty()) entries.push_back(fmt::format("{} = [{}]", key, fmt::join(quoted, ", ")));
  }
  if (entries.empty()) return toml_key(name) + " = {}";
  return fmt::format("{} = {{ {} }}", toml_key(name), fmt::join(entries, ", "));
}

std::string with_effect(const std::string& text, const std::string& line) {
  const StudyText study(text);
  const TomlNode* effects = study.find({"effects"});
  std::string out;
  if (effects == nullptr || (study.has_header(*effects) && !study.has_own_header(*effects))) {
    out = with_new_section(study, "effects", line);
  } else if (effects->inline_table) {
    out = with_inline_entry(study, *effects, line);
  } else {  // below [effects], or among dotted keys: effects.NAME = …
    const std::string entry = study.has_header(*effects) ? line : "effects." + line;
    out = inserted(text, study.line_end(study.end_of(*effects)), study.newline() + entry);
  }
  const TomlPath added{"effects", name_of(line)};
  refuse_unless_same(study, out, added);
  if (study.find(added) != nullptr) throw InputError("[effects] has an effect '" + shown(added.back()) + "' already");
  return out;
}

std::string without_entry(const std::string& text, const std::string& section, const std::string& key, const std::string& why) {
  const StudyText study(text);
  const TomlNode* entry = study.find({section, key});
  if (entry == nullptr) return text;
  std::string out;
  if (study.outermost_inline(*entry) != nullptr) {
    out = without_inline_entry(study, *entry, why);
  } else {
    Lines lines;
    lines_of(study, *entry, lines);
    out = as_comments(study, lines, why);
  }
  refuse_unless_same(study, out, {section, key});
  if (StudyText(out).find({section, key}) != nullptr) throw InputError("'" + shown(key) + "' cannot be taken out of [" + section + "]");
  return out;
}

std::string with_renamed_entry(const std::string& text, const std::string& section, const std::string& key, const std::string& name) {
  const StudyText study(text);
  const TomlNode* entry = study.find({section, key});
  if (entry == nullptr || key == name) return text;
  std::string out = text.substr(0, entry->key_begin) + toml_key(name) + text.substr(entry->key_end);
  refuse_unless_same(study, out, {section, key}, {section, name});
  return out;
}

std::string with_value(const std::string& text, const std::vector<std::string>& path_given, const std::string& value) {
  if (path_given.size() < 2) throw InputError("a key of a section is expected, as parameters.k.free");
  if (!is_toml_value(value)) throw InputError("'" + shown(value) + "': one value is expected");
  const StudyText study(text);
  const TomlPath path = as_spelled(study, path_given);
  const TomlNode* old = study.find(path);
  if (old != nullptr && old->kind == TomlNode::Kind::table && !old->inline_table)
    throw InputError(dotted(path, 0) + " is a section: one of its keys is expected");
  std::string out = old != nullptr ? text.substr(0, old->begin) + value + text.substr(old->end) : with_new_value(study, path, value);
  refuse_unless_same(study, out, path);
  if (StudyText(out).find(path) == nullptr) throw InputError(dotted(path, 0) + " cannot be set as the study is written");
  return out;
}

std::string with_system(const std::string& text, const std::string& kind) {
  const StudyText study(text);
  const TomlNode* entry = study.find({"system", "kind"});
  if (entry == nullptr || entry->kind != TomlNode::Kind::text)
    throw InputError("the study has no line kind = \"…\" under [system] that could be changed");
  std::string out = text.substr(0, entry->begin) + toml_string(kind) + text.substr(entry->end);
  refuse_unless_same(study, out, {"system", "kind"});
  return out;
}

}  // namespace misfit
