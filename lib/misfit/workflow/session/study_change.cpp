#include "misfit/workflow/session/study_change.h"

#include <algorithm>
#include <cctype>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shown.h"
#include "misfit/core/toml_outline.h"
#include "misfit/core/toml_text.h"
#include "misfit/data/study_edit.h"
#include "misfit/data/study_reader.h"
#include "misfit/model/declared.h"
#include "misfit/model/provisional.h"
#include "misfit/model/request.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

TomlPath path_of(const std::string& key) {
  try {
    const std::vector<TomlNode> nodes = toml_outline(key + " = 0");
    if (!nodes.empty() && nodes.back().value == "0") return nodes.back().path;
  } catch (const InputError&) {
    // said below
  }
  throw InputError("'" + shown(key) + "': a key is expected, as parameters.k.free or curves.C_m.roughness");
}

/// Experiments of the text by their names: what stands behind "experiment." becomes the number of the element; of a single [experiment]
/// it goes.
TomlPath with_number_of_experiment(const Study& study, TomlPath path) {
  if (path.size() < 3 || path.front() != "experiment") return path;
  std::vector<std::string> names;
  int number = -1;  // of the table
  for (std::size_t k = 0; k < study.experiments.size(); ++k) {
    const bool held_out = is_held_out_file(study.experiments, k);
    if (!held_out) ++number;
    const std::string& name = study.experiments[k].name;
    if (name == path[1]) {
      if (held_out)
        throw InputError("'" + shown(name) + "' is the recording that '" + shown(study.experiments[k - 1].name) +
                         "' holds out as a whole: it has no keys of its own");
      const TomlPath element{"experiment", std::to_string(number)};
      const std::vector<TomlNode> nodes = toml_outline(study.text);
      const bool array = std::any_of(nodes.begin(), nodes.end(), [&](const TomlNode& node) { return node.path == element; });
      if (array) path[1] = element.back();
      if (!array) path.erase(path.begin() + 1);
      return path;
    }
    if (!held_out) names.push_back(name);
  }
  throw InputError("no experiment is called '" + shown(path[1]) + "'" + suggest(path[1], names));
}

/// Of the line, counted from 1: its first byte and the one behind its last.
std::pair<std::size_t, std::size_t> bytes_of_line(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int k = 1; k < line && begin < text.size(); ++k) begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
  return {begin, std::min(text.find('\n', begin), text.size())};
}

/// A text without a value whose absence may be an error itself.
struct Shortened {
  std::string text, key;
};

/// Does the message name the key, as a word, before its suggestions? Not in the place with which it begins.
bool names(const TextFault& fault, const fs::path& file, const std::string& key) {
  std::string said = fault.message.substr(0, fault.message.find(" — "));
  if (said.starts_with(file.string())) said.erase(0, file.string().size());
  const auto in_word = [&](std::size_t at) {
    return at < said.size() && (std::isalnum(static_cast<unsigned char>(said[at])) != 0 || said[at] == '_');
  };
  for (std::size_t at = said.find(key); at != std::string::npos; at = said.find(key, at + 1)) {
    if ((at == 0 || !in_word(at - 1)) && !in_word(at + key.size())) return true;
  }
  return false;
}

/// Blanks the value that begins in the line; of what is no TOML, the line. nullopt: there is none.
std::optional<Shortened> without_value_in(const std::string& text, int line) {
  auto [begin, end] = bytes_of_line(text, line);
  std::string key;
  try {
    const std::vector<TomlNode> nodes = toml_outline(text);
    const auto found = std::find_if(nodes.begin(), nodes.end(), [&, from = begin, to = end](const TomlNode& node) {
      return node.key_end > node.key_begin && node.key_begin >= from && node.key_begin < to && node.end > node.key_end;
    });
    if (found == nodes.end()) return std::nullopt;
    key = found->path.back();
    end = std::max(end, found->end);
  } catch (const InputError&) {
    // no TOML: the whole line goes
  }
  Shortened out{text, key};
  for (std::size_t at = begin; at < end; ++at) {
    if (out.text[at] != '\n') out.text[at] = ' ';
  }
  return out;
}

}  // namespace

bool is_held_out_file(const std::vector<ExperimentStudy>& experiments, std::size_t k) {
  if (k == 0) return false;
  const Source &own = experiments[k].where, &before = experiments[k - 1].where;  // of the table that both are read from
  return own.line == before.line && own.column == before.column;
}

std::optional<TextFault> fault_of(const fs::path& file, const std::string& text, const Registry& registry) {
  if (text.find('\0') != std::string::npos) return TextFault{"the text contains a byte 0", 0};
  try {
    const Study study = read_study_text(file, text);
    const std::shared_ptr<const Registry> declared = study_registry(study, registry);
    (void)provisional_model(read_model(study, *declared).request, *declared);
  } catch (const InputError& error) {
    return TextFault{error.what(), error.where().file == file.string() ? error.where().line : 0};
  } catch (const RunError& error) {
    return TextFault{error.what(), 0};
  }
  return std::nullopt;
}

std::vector<TextFault> faults_of(const fs::path& file, const std::string& text, const Registry& registry) {
  constexpr std::size_t most = 10;
  std::vector<TextFault> out;
  std::string rest = text;
  std::vector<std::string> left_out;
  while (out.size() < most) {
    const std::optional<TextFault> fault = fault_of(file, rest, registry);
    const auto follows = [&](const std::string& key) { return !key.empty() && names(*fault, file, key); };
    const auto known = [&](const TextFault& other) { return other.line == fault->line; };
    if (!fault || std::any_of(left_out.begin(), left_out.end(), follows) || std::any_of(out.begin(), out.end(), known)) break;
    out.push_back(*fault);
    const std::optional<Shortened> shorter = fault->line > 0 ? without_value_in(rest, fault->line) : std::nullopt;
    if (!shorter) break;
    rest = shorter->text;
    left_out.push_back(shorter->key);
  }
  return out;
}

std::optional<TextFault> save_text(const fs::path& file, const std::string& text, const std::string& hash_before,
                                   const Registry& registry) {
  if (auto fault = fault_of(file, text, registry)) return fault;
  std::error_code none;
  if (fs::symlink_status(file, none).type() != fs::file_type::regular)
    throw InputError(file.string() + ": is a link, which misfit does not write through: edit the file itself");
  if (hash_file(file) != hash_before)
    throw InputError(file.string() + ": was changed by somebody else since it was read: reload it, and make the change again");
  const fs::perms mode = fs::status(file, none).permissions();
  write_atomically(file, text);
  fs::permissions(file, mode, none);
  return std::nullopt;
}

Setting read_setting(const std::string& words) {
  std::size_t at = 0;  // of the first '=' that is not in quotation marks
  for (char quote = '\0'; at < words.size() && (quote != '\0' || words[at] != '='); ++at) {
    if (quote != '\0' ? words[at] == quote : words[at] == '"' || words[at] == '\'') quote = quote != '\0' ? '\0' : words[at];
  }
  if (at == 0 || at + 1 >= words.size()) throw InputError("'" + shown(words) + "': KEY=VALUE is expected, as parameters.k.free=false");
  return {words.substr(0, at), words.substr(at + 1)};
}

std::string with_settings(const Study& study, const std::vector<Setting>& settings) {
  std::string text = study.text;
  for (const Setting& setting : settings) {
    const TomlPath path = with_number_of_experiment(study, path_of(setting.key));
    try {
      text = with_value(text, path, is_toml_value(setting.value) ? setting.value : toml_string(setting.value));
    } catch (const InputError& error) {
      throw InputError(setting.key + ": " + error.what());
    }
  }
  return text;
}

}  // namespace misfit
