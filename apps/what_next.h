#pragma once

#include <filesystem>
#include <string>

namespace misfit {

/// What `misfit` alone prints: the next command for what lies in `folder` (a study, studies in folders, CSV files), or how to begin.
/// `examples`: studies that came with the program; empty: there are none.
[[nodiscard]] std::string what_next(const std::filesystem::path& folder, const std::filesystem::path& examples);

/// share/doc/misfit/examples beside the bin/ of the running program, where it is installed; else empty.
[[nodiscard]] std::filesystem::path installed_examples();

}  // namespace misfit
