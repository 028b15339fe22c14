#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace misfit::report {

/// How a series is drawn, and which of its columns it uses.
enum class Style {
  line,        ///< x, y
  dashed,      ///< x, y
  dotted,      ///< x, y
  points,      ///< x, y: small dots for many samples
  markers,     ///< x, y: circles
  error_bars,  ///< x, y, lo, hi: circles with vertical bars
  x_bars,      ///< x, y, lo, hi: diamonds with horizontal bars (lo, hi along x)
  band,        ///< x, lo, hi: translucent area
  pale_band,   ///< the same, paler: not to be relied on
  steps,       ///< x, y
  boxes,       ///< x, y, lo, hi: boxes from 0 to y, between lo and hi along x
  bars,        ///< x, y, lo, hi: boxes from 0 to x, between lo and hi along y
  cells        ///< x, y, lo, hi, z: rectangles from x − lo to x + lo and y − hi to y + hi, coloured by z about 0
};

inline constexpr double no_point = std::numeric_limits<double>::quiet_NaN();

/// One thing drawn. Vectors of equal length; no_point breaks a line and leaves out a point.
struct Series {
  std::string key;     ///< short name for the columns of the CSV: letters, digits, '_' (made unique when written)
  std::string legend;  ///< plain text; empty: not in the legend
  Style style = Style::line;
  std::string colour = "#000000";
  std::vector<double> x, y, lo, hi;  ///< in the units of the figure's axes
  double width = 2.0;                ///< of lines [px]
  std::vector<double> z = {};        ///< cells: what the colour shows, in Figure::z_unit
};

/// A name at a place of an axis, instead of numbers.
struct Mark {
  double at = 0.0;
  std::string text;
};

/// An x axis that is not the figure's.
struct OwnX {
  std::string label;
  std::array<double, 2> range{};
};

/// One pair of axes; the panels of a figure stand above each other and share x.
struct Panel {
  std::string y_label, y_unit;
  std::vector<Series> series = {};
  std::optional<std::array<double, 2>> y_range = {};  ///< absent: from the data
  double y_step = 0.0;                                ///< distance of the marks on the y axis; 0: chosen
  double height = 300.0;                              ///< of the axes [px]
  bool zero_line = false;
  std::vector<Mark> y_marks = {};   ///< names instead of numbers
  std::string ground = {};          ///< colour behind the series where they leave it free; empty: paper
  std::optional<OwnX> beside = {};  ///< stands to the right of the panel before it, with this x axis and the same places along y, unnamed
};

/// A figure as plain data. Texts are plain UTF-8; known symbols ("alpha_T", "C_m") are typeset when drawn.
struct Figure {
  std::string name;  ///< file stem: letters, digits, '_', '-', '.'
  std::string title;
  std::string caption;  ///< for the page: what it shows and how to read it
  std::string x_label, x_unit;
  std::optional<std::array<double, 2>> x_range;
  std::vector<Panel> panels;
  std::vector<std::string> notes;  ///< what a reader must know: left out, not informative; under the figure
  bool equal_axes = false;         ///< one degree is as long in x as in y (one panel)
  std::vector<Mark> x_marks;       ///< names instead of numbers
  std::string z_label, z_unit;     ///< of the colours of cells
};

/// Ends of the scale of the colours of cells, ± as much, in every drawing: a whole number that none of them is beyond, 3 at least, so that
/// chance is pale. 0: the figure has no cells.
[[nodiscard]] double colour_limit(const Figure& figure);

/// Okabe and Ito's palette, safe for colour-blind readers, dark colours first, without yellow: colour k of k = 0, 1, 2, …; repeats after 6.
[[nodiscard]] std::string palette(std::size_t k);
inline constexpr const char* grey = "#8a8a8a";
inline constexpr const char* black = "#000000";

/// Figures whose name another one before them has get ".2", ".3", … behind it: no figure's files may be written over by the next.
void make_names_unique(std::vector<Figure>& figures);

/// Writes DIR/NAME.csv (every number, columns SERIES.x[unit], SERIES.y[unit], …, shorter series padded with empty fields; of a series too
/// long to be drawn whole, what is drawn of it in columns SERIES_drawn.x[unit], …),
/// DIR/NAME.gp (a stand-alone gnuplot script that draws NAME.svg from NAME.csv when run in that folder) and DIR/NAME.svg, drawn by that
/// script. A panel without a finite number says "no data"; so does the legend of a series without one. RunError: gnuplot is not installed
/// or fails (its words are given), the folder cannot be written. InputError: series with vectors of unequal length, a name that is no file
/// name.
std::filesystem::path write_figure(const std::filesystem::path& dir, const Figure& figure);
/// The same of several, which takes a fraction of the time: one gnuplot draws them all. Returns the drawings (SVG).
std::vector<std::string> write_figures(const std::filesystem::path& dir, const std::vector<Figure>& figures);
/// Names of the files that it writes.
[[nodiscard]] std::vector<std::string> files_of(const std::vector<Figure>& figures);

}  // namespace misfit::report
