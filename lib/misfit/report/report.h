#pragma once

#include <filesystem>

#include "misfit/report/input.h"

namespace misfit::report {

/// Draws the figures into DIR/figures and writes DIR/report.html, one page that needs no other file and no network. Returns the page's
/// path. RunError as write_figure.
std::filesystem::path write_report(const std::filesystem::path& dir, const ReportInput& input);

}  // namespace misfit::report
