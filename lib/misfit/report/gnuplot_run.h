#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit::report {

/// What a drawing is called, and what it shows, for viewers and screen readers.
struct DrawingWords {
  std::string title, description;
};

struct DrawingOrder {
  std::string name;  ///< of the script, without .gp: no quotes or blanks
  DrawingWords words;
};

/// Draws DIR/NAME.svg of each with DIR/NAME.gp (the script honours `out` and ends with `drawn = 1`), all with one gnuplot, and returns the
/// drawings (SVG): an old drawing stays until the new one is complete. What gnuplot draws depends on the script alone: it reads neither
/// .gnuplot nor the environment, and forgets the scripts before, but for options of a terminal that a script leaves out. RunError in words
/// if gnuplot is not on the PATH or fails, at the first that it fails on, WriteError if a drawing cannot be written.
std::vector<std::string> run_gnuplot(const std::filesystem::path& dir, const std::vector<DrawingOrder>& orders);

}  // namespace misfit::report
