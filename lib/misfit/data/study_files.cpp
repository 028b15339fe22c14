// text_for_folder of study_edit.h.

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/utf8.h"
#include "misfit/data/study_edit.h"
#include "misfit/data/study_keys.h"
#include "misfit/data/study_text.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

bool may_name_a_file(const TomlNode& node) {
  const config::Key* key = node.kind == TomlNode::Kind::text ? config::find_key(study_keys(), node.path) : nullptr;
  return key != nullptr && key->type == config::KeyType::file;
}

/// With links of folders followed, so that ".." leads back; a link that is the file itself stays.
fs::path true_path(const fs::path& file) { return fs::weakly_canonical(file.parent_path()) / file.filename(); }

}  // namespace

std::string text_for_folder(const Study& study, const fs::path& folder, OddPaths odd) {
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
    if (!is_utf8(path) && odd == OddPaths::refuse)
      throw InputError({study.file.string(), 0, 0}, "'" + shown(node->value) + "' is '" + shown(path) + "' as seen from " +
                                                        shown(folder.string()) + ": a path that is no UTF-8 cannot stand in a study");
    out += study.text.substr(done, at - done) + toml_string(path);
    done = node->end;
  }
  return out + study.text.substr(done);
}

}  // namespace misfit
