#pragma once

#include <filesystem>
#include <string>

namespace misfit::report {

/// What a drawing is called, and what it shows, for viewers and screen readers.
struct DrawingWords {
  std::string title, description;
};

/// Draws DIR/NAME.svg with DIR/NAME.gp (NAME without quotes or blanks; the script honours `out` and ends with `drawn = 1`): the old drawing
/// stays until the new one is complete. What gnuplot draws depends on the script alone: it reads neither .gnuplot nor the environment.
/// RunError in words if gnuplot is not on the PATH or fails, WriteError if the drawing cannot be written.
void run_gnuplot(const std::filesystem::path& dir, const std::string& name, const DrawingWords& words);

}  // namespace misfit::report
