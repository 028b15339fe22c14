#pragma once

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "apps/progress.h"
#include "apps/terminal.h"
#include "misfit/core/files.h"
#include "misfit/show/lines.h"
#include "misfit/show/results.h"
#include "misfit/show/verdict.h"

namespace misfit {

/// A result (show/results.h) on the terminal, and a blank line.
inline void print(const Blocks& blocks) {
  if (blocks.all().empty()) return;
  clear_progress_line();
  std::cout << as_text(blocks, terminal_style()) << '\n' << std::flush;
}
template <class... Result>
void print(const Result&... result) {
  print(blocks_of(result...));
}

/// A stage that has ended, in one line; nothing for empty words.
inline void print_stage(const std::string& stage, const std::string& words) {
  if (words.empty()) return;
  clear_progress_line();
  std::cout << stage_line(stage, words, terminal_style()) << std::flush;
}

/// What the study has come to, at the end of what is printed, and where its page is.
inline void print_verdict(const Verdict& verdict, const std::filesystem::path& page) {
  Blocks blocks = blocks_of(verdict);
  blocks.paragraph("report: " + page.lexically_normal().string(), Tone::command);
  clear_progress_line();
  std::cout << '\n' << as_text(blocks, terminal_style()) << std::flush;
}

/// 1 if every method failed or declined although some were asked for, else 0.
[[nodiscard]] inline int status_of(const std::vector<Fit>& fits) {
  return fits.empty() || std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.usable(); }) ? 0 : 1;
}

/// The content of a result file, to stdout: for --json.
inline void print_file(const std::filesystem::path& path) { std::cout << read_file(path); }
/// The same of JSON files by name: one as it is, several as members of one object.
void print_files(const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace misfit
