#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/study.h"
#include "misfit/model/registry.h"

namespace misfit {

/// What is wrong with a study's text, and where.
struct TextFault {
  std::string message;
  int line = 0;  ///< counts from 1; 0: not known, or of another file
};

/// What misfit says of the text as the content of `file`: keys, values, names and files, as before a run. nullopt: nothing.
[[nodiscard]] std::optional<TextFault> fault_of(const std::filesystem::path& file, const std::string& text, const Registry& registry);

/// The same, and what it says further once the values in the faulty lines are left out: not what only follows from their absence, as far as
/// that can be told. At most ten; it ends at one whose line is not known or holds no value.
[[nodiscard]] std::vector<TextFault> faults_of(const std::filesystem::path& file, const std::string& text, const Registry& registry);

/// Writes it whole or not at all, if nothing is wrong with it (else that is returned), `file` still has the text of this hash
/// (hash_text), and is no link. InputError: it is not written for one of the latter.
[[nodiscard]] std::optional<TextFault> save_text(const std::filesystem::path& file, const std::string& text, const std::string& hash_before,
                                                 const Registry& registry);

/// Is experiment `k` the recording that the one before it holds out as a whole (validation = FILE)? It has no table in the text.
[[nodiscard]] bool is_held_out_file(const std::vector<ExperimentStudy>& experiments, std::size_t k);

/// A key and its value, as `misfit set` takes them: "parameters.k.free=false".
struct Setting {
  std::string key, value;  ///< as written; value: TOML, or any text
};
/// InputError: there is no '=', or nothing on one of its sides.
[[nodiscard]] Setting read_setting(const std::string& words);

/// The text of a study with other values; a key begins with the name of a section. [experiment] and the elements of [[experiment]] go by
/// the experiment's name: experiment.NAME.validation. A value that is no TOML is a text. InputError naming the key: it is not written as a
/// key, there is no such experiment, it is a recording that another one holds out, or with_value() refuses it.
[[nodiscard]] std::string with_settings(const Study& study, const std::vector<Setting>& settings);

}  // namespace misfit
