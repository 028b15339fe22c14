#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit {

/// The name of a study made of `data`: its file's name without extension, on one line.
[[nodiscard]] std::string study_name(const std::filesystem::path& data);

/// Names of `count` recordings found in `data`, for experiments and their files: the file's name without extension where that can be both
/// (no control characters, no backslash, no '.' or '-' in front, not too long), else one made of it; numbered if there are more than one.
[[nodiscard]] std::vector<std::string> part_names(const std::filesystem::path& data, std::size_t count);

}  // namespace misfit
