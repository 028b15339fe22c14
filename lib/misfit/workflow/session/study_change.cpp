#include "misfit/workflow/session/study_change.h"

#include <algorithm>
#include <charconv>

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

/// Of a message that begins with "FILE:LINE".
TextFault fault_in(const fs::path& file, const std::string& message) {
  TextFault fault{message, 0};
  const std::string place = file.string() + ":";
  if (!message.starts_with(place)) return fault;
  const char* end = message.data() + message.size();
  const auto [after, error] = std::from_chars(message.data() + place.size(), end, fault.line);
  if (error != std::errc()) return {message, 0};
  return fault;
}

TomlPath path_of(const std::string& key) {
  try {
    const std::vector<TomlNode> nodes = toml_outline(key + " = 0");
    if (!nodes.empty() && nodes.back().value == "0") return nodes.back().path;
  } catch (const InputError&) {
    // said below
  }
  throw InputError("'" + shown(key) + "': a key is expected, as parameters.k.free or curves.C_m.roughness");
}

/// Experiments of the text by their names: what stands behind "experiment." becomes the number of the element.
TomlPath with_number_of_experiment(const Study& study, TomlPath path) {
  if (path.size() < 3 || path.front() != "experiment") return path;
  std::vector<std::string> names;
  for (const ExperimentStudy& experiment : study.experiments) {
    names.push_back(experiment.name);
    if (experiment.name != path[1]) continue;
    for (const TomlNode& node : toml_outline(study.text)) {
      if (node.path.size() != 2 || node.path.front() != "experiment") continue;
      const auto lines = std::count(study.text.begin(), study.text.begin() + static_cast<std::ptrdiff_t>(node.begin), '\n');
      if (lines + 1 != experiment.where.line) continue;
      path[1] = node.path.back();
      return path;
    }
  }
  throw InputError("no experiment is called '" + shown(path[1]) + "'" + suggest(path[1], names));
}

}  // namespace

std::optional<TextFault> fault_of(const fs::path& file, const std::string& text, const Registry& registry) {
  if (text.find('\0') != std::string::npos) return TextFault{"the text contains a byte 0", 0};
  try {
    const Study study = read_study_text(file, text);
    const std::shared_ptr<const Registry> declared = study_registry(study, registry);
    (void)provisional_model(read_model(study, *declared).request, *declared);
  } catch (const InputError& error) {
    return fault_in(file, error.what());
  } catch (const RunError& error) {
    return TextFault{error.what(), 0};
  }
  return std::nullopt;
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
