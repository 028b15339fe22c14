// text_for_folder of study_edit.h.

#include <array>
#include <functional>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/utf8.h"
#include "misfit/data/study_edit.h"
#include "misfit/data/study_text.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Where a study names files: "*" stands for any key or element.
using Pattern = std::vector<const char*>;
const std::vector<Pattern>& file_entries() {
  static const std::vector<Pattern> all{{"system", "file"},           {"video", "marker"},         {"camera", "sweep"},
                                        {"camera", "sweep_images"},   {"camera", "sweep_marker"},  {"experiment", "*", "track"},
                                        {"experiment", "*", "video"}, {"experiment", "*", "data"}, {"experiment", "*", "validation"},
                                        {"experiment", "track"},      {"experiment", "video"},     {"experiment", "data"},
                                        {"experiment", "validation"}, {"curves", "*", "table"},    {"reference", "*"}};
  return all;
}

bool fits(const TomlPath& path, const Pattern& pattern) {
  return std::equal(path.begin(), path.end(), pattern.begin(), pattern.end(),
                    [](const std::string& key, const char* wanted) { return std::string_view(wanted) == "*" || key == wanted; });
}

bool may_name_a_file(const TomlNode& node) {
  const auto& all = file_entries();
  return node.kind == TomlNode::Kind::text && std::any_of(all.begin(), all.end(), [&](const Pattern& p) { return fits(node.path, p); });
}

/// With links of folders followed, so that ".." leads back; a link that is the file itself stays.
fs::path true_path(const fs::path& file) { return fs::weakly_canonical(file.parent_path()) / file.filename(); }

}  // namespace

std::string text_for_folder(const Study& study, const fs::path& folder) {
  const fs::path from = fs::absolute(study.folder), to = fs::weakly_canonical(fs::absolute(folder));
  const StudyText before(study.text);
  std::map<std::size_t, const TomlNode*> found;  // by place
  for (const TomlNode& node : before.nodes()) {
    std::error_code error;
    const bool relative = !node.value.empty() && fs::path(node.value).is_relative();
    if (may_name_a_file(node) && relative && fs::is_regular_file(from / node.value, error)) found[node.begin] = &node;
  }
  std::string out;
  std::size_t done = 0;
  for (const auto& [at, node] : found) {
    const std::string path = true_path((from / node->value).lexically_normal()).lexically_relative(to).generic_string();
    if (!is_utf8(path))
      throw InputError({study.file.string(), 0, 0}, "'" + shown(node->value) + "' is '" + shown(path) + "' as seen from " +
                                                        shown(folder.string()) + ": a path that is no UTF-8 cannot stand in a study");
    out += study.text.substr(done, at - done) + toml_string(path);
    done = node->end;
  }
  return out + study.text.substr(done);
}

}  // namespace misfit
