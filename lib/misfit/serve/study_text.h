#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "misfit/model/registry.h"

namespace misfit::serve {

/// What is wrong with a study's text, and where.
struct TextFault {
  std::string message;
  int line = 0;  ///< counts from 1; 0: not known, or of another file
};

/// What misfit says of the text as the content of `file`: keys, values, names and files, as before a run. nullopt: nothing.
[[nodiscard]] std::optional<TextFault> fault_of(const std::filesystem::path& file, const std::string& text, const Registry& registry);

/// Writes it whole or not at all, if nothing is wrong with it (else that is returned), `file` still has the text of this hash
/// (hash_text), and is no link. InputError: it is not written for one of the latter.
[[nodiscard]] std::optional<TextFault> save_text(const std::filesystem::path& file, const std::string& text, const std::string& hash_before,
                                                 const Registry& registry);

}  // namespace misfit::serve
