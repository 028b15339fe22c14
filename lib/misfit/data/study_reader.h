#pragma once

#include <filesystem>
#include <string>

#include "misfit/data/study.h"

namespace misfit {

/// study.toml where `path` is the folder that holds it, else `path`.
[[nodiscard]] std::filesystem::path study_file(const std::filesystem::path& path);

/// As read_study(), of a text that is to become the content of `file`.
[[nodiscard]] Study read_study_text(const std::filesystem::path& file, std::string text);

}  // namespace misfit
