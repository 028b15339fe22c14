#pragma once

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <vector>

#include "misfit/core/files.h"
#include "misfit/show/results.h"

namespace misfit {

/// A result (show/results.h) on the terminal, and a blank line.
inline void print(const Blocks& blocks) {
  if (!blocks.all().empty()) std::cout << as_text(blocks) << '\n' << std::flush;
}
template <class... Result>
void print(const Result&... result) {
  print(blocks_of(result...));
}

/// 1 if every method failed or declined although some were asked for, else 0.
[[nodiscard]] inline int status_of(const std::vector<Fit>& fits) {
  return fits.empty() || std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.usable(); }) ? 0 : 1;
}

/// The content of a result file, to stdout: for --json.
inline void print_file(const std::filesystem::path& path) { std::cout << read_file(path); }

}  // namespace misfit
