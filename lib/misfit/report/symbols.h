#pragma once

#include <string>
#include <vector>

namespace misfit::report {

/// A piece of text on the line, below it or above it.
struct Run {
  enum class Place { line, below, above } place = Place::line;
  std::string text;
};

/// Known symbols in a plain text become Greek letters with indices ("alpha_T", "C_m_alphadot"), powers after '^' are raised ("m/s^2"). A
/// symbol counts only as a whole word. Values are unbroken() with their units; everything else stays as it is.
[[nodiscard]] std::vector<Run> typeset(const std::string& plain);

/// For a single-quoted gnuplot string in enhanced mode, with everything special escaped; an apostrophe becomes a typographic one.
[[nodiscard]] std::string gnuplot_text(const std::string& text);

/// For HTML: escaped, indices as <sub>, powers as <sup>.
[[nodiscard]] std::string html_text(const std::string& text);

/// Only escaped: & < > " '.
[[nodiscard]] std::string escape_html(const std::string& text);

}  // namespace misfit::report
