#include "misfit/report/gnuplot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

constexpr double full_width = 900.0;  // [px], as all that follow
constexpr double square_width = 680.0;
constexpr double left = 86.0;
constexpr double right = 24.0;
constexpr double title_height = 42.0;
constexpr double legend_row = 21.0;
constexpr double panel_gap = 16.0;
constexpr double bottom = 66.0;

/// Where a panel stands, from the top of the figure.
struct Place {
  double top = 0.0, height = 0.0;
  int legend_rows = 0;
};

std::string axis_text(const std::string& label, const std::string& unit) {
  const std::string plain = label + (unit.empty() ? "" : "  [" + unit + "]");
  return gnuplot_text(plain);
}

std::size_t letters(const std::string& text) {
  std::size_t count = 0;
  for (const Run& run : typeset(text)) {
    for (const char c : run.text) count += (static_cast<unsigned char>(c) & 0xC0U) == 0x80U ? 0U : 1U;
  }
  return count;
}

std::string legend_of(const Series& s) { return has_data(s) || s.legend.empty() ? s.legend : s.legend + " (no data)"; }

Place place_panel(const Panel& panel, double top, double width) {
  std::size_t entries = 0;
  std::size_t longest = 0;
  for (const Series& s : panel.series) {
    if (s.legend.empty()) continue;
    ++entries;
    longest = std::max(longest, letters(legend_of(s)));
  }
  Place place{top, panel.height, 0};
  if (entries == 0) return place;
  const double entry = 62.0 + 7.6 * static_cast<double>(longest);
  const int columns = std::clamp(static_cast<int>((width - left - right) / entry), 1, static_cast<int>(entries));
  place.legend_rows = (static_cast<int>(entries) + columns - 1) / columns;
  place.top += legend_row * place.legend_rows;
  return place;
}

using Range = std::array<double, 2>;

Range finite_range(const std::vector<const std::vector<double>*>& columns) {
  Range range = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const std::vector<double>* column : columns) {
    for (const double value : *column) {
      if (!std::isfinite(value)) continue;
      range = {std::min(range[0], value), std::max(range[1], value)};
    }
  }
  if (range[0] > range[1]) return {0.0, 1.0};
  if (range[0] == range[1]) return {range[0] - 0.5, range[1] + 0.5};
  return range;
}

Range x_range_of(const Figure& figure) {
  if (figure.x_range) return *figure.x_range;
  std::vector<const std::vector<double>*> columns;
  bool margin = false;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      columns.push_back(&s.x);
      if (s.style == Style::boxes) columns.insert(columns.end(), {&s.lo, &s.hi});
      margin = margin || s.style == Style::markers || s.style == Style::error_bars;
    }
  }
  const Range range = finite_range(columns);
  const double space = margin ? 0.015 * (range[1] - range[0]) : 0.0;  // whole markers at the edges
  return {range[0] - space, range[1] + space};
}

/// Ranges that make one unit equally long on both axes of a panel of size `w` × `h`.
void make_equal(Range& x, Range& y, double w, double h) {
  const double scale = 1.06 * std::max((x[1] - x[0]) / w, (y[1] - y[0]) / h);
  const double x_middle = 0.5 * (x[0] + x[1]);
  const double y_middle = 0.5 * (y[0] + y[1]);
  x = {x_middle - 0.5 * scale * w, x_middle + 0.5 * scale * w};
  y = {y_middle - 0.5 * scale * h, y_middle + 0.5 * scale * h};
}

/// Rows drawn of one series, more than the axes have pixels; a point costs a drawing ten times the bytes of a vertex.
std::size_t drawn_rows(Style style) {
  const bool vertices = style == Style::line || style == Style::dashed || style == Style::dotted || style == Style::steps;
  return vertices ? 5000 : 1200;
}

std::string look(const Series& s) {
  const std::string colour = "lc rgb '" + s.colour + "'";
  switch (s.style) {
    case Style::line:
      return fmt::format("with lines lw {} dt 1 {}", s.width, colour);
    case Style::dashed:
      return fmt::format("with lines lw {} dt (7,5) {}", s.width, colour);
    case Style::dotted:
      return fmt::format("with lines lw {} dt (2,4) {}", s.width, colour);
    case Style::points:
      return "with points pt 7 ps 0.28 " + colour;
    case Style::markers:
      return "with points pt 6 ps 0.7 lw 1.5 " + colour;
    case Style::error_bars:
      return "with points pt 7 ps 0.4 " + colour;
    case Style::x_bars:
      return "with points pt 13 ps 0.9 " + colour;
    case Style::band:
      return "with filledcurves fs transparent solid 0.20 noborder fc rgb '" + s.colour + "'";
    case Style::pale_band:
      return "with filledcurves fs transparent solid 0.07 noborder fc rgb '" + s.colour + "'";
    case Style::steps:
      return fmt::format("with steps lw {} {}", s.width, colour);
    case Style::boxes:
      return "with boxxyerror fc rgb '" + s.colour + "' fs transparent solid 0.45 border lc rgb '" + s.colour + "'";
  }
  return "";
}

std::string columns_text(const Series& s, std::size_t first) {
  if (s.style == Style::boxes)
    return fmt::format("(v({0})):(v({1})):(v({2})):(v({3})):(0):(v({1}))", first, first + 1, first + 2, first + 3);
  if (s.style == Style::band || s.style == Style::pale_band) return fmt::format("(v({})):(v({})):(v({}))", first, first + 1, first + 2);
  return fmt::format("(v({})):(v({}))", first, first + 1);
}

/// The bars of a series with errors, as lines from lo to hi: gnuplot's own error bars leave a white halo about the point that hides short
/// ones.
std::string bars_clause(const Figure& figure, const Series& s, std::size_t first) {
  const bool horizontal = s.style == Style::x_bars;
  if (!horizontal && s.style != Style::error_bars) return "";
  const std::string from =
      horizontal ? fmt::format("(v({})):(v({}))", first + 2, first + 1) : fmt::format("(v({})):(v({}))", first, first + 2);
  const std::string length = fmt::format("(v({})-v({}))", first + 3, first + 2);
  return fmt::format("'{}.csv' using {}:{} with vectors nohead lw {} lc rgb '{}' notitle, \\\n     ", figure.name, from,
                     horizontal ? length + ":(0)" : "(0):" + length, horizontal ? 3 : 1.4, s.colour);
}

std::string clause(const Figure& figure, const Series& s, std::size_t first) {
  const std::string legend = legend_of(s);
  if (!has_data(s)) return legend.empty() ? "" : fmt::format("keyentry {} title '{}'", look(s), gnuplot_text(legend));
  const std::size_t step = (s.x.size() + drawn_rows(s.style) - 1) / drawn_rows(s.style);
  const std::string every = step > 1 ? fmt::format(" every {}", step) : "";
  const std::string title = legend.empty() ? "notitle" : "title '" + gnuplot_text(legend) + "'";
  return bars_clause(figure, s, first) +
         fmt::format("'{}.csv' using {}{} {} {}", figure.name, columns_text(s, first), every, look(s), title);
}

std::string plot_command(const Figure& figure, const Panel& panel, std::size_t& column) {
  std::vector<std::string> clauses;
  if (panel.zero_line) clauses.emplace_back("0 with lines lw 1 lc rgb '#777777' notitle");
  bool any = false;
  for (const Series& s : panel.series) {
    const std::string text = clause(figure, s, column);
    if (!text.empty()) clauses.push_back(text);
    any = any || has_data(s);
    column += columns_of(s).size();
  }
  if (!any) {
    clauses.insert(clauses.begin(), "NaN notitle");
    return fmt::format("set label 1 'no data' at graph 0.5, graph 0.5 center tc rgb '#777777' font ',16'\nset yrange [0:1]\nplot {}\n",
                       fmt::join(clauses, ", \\\n     "));
  }
  return fmt::format("unset label 1\nplot {}\n", fmt::join(clauses, ", \\\n     "));
}

std::string range_text(const std::optional<Range>& range) {
  return range ? fmt::format("[{:.9g}:{:.9g}]", (*range)[0], (*range)[1]) : "[*:*]";
}

std::string head(const Figure& figure, double width, double height) {
  std::string text = fmt::format("# {}\n# Run in this folder: gnuplot {}.gp\n", figure.name, figure.name);
  for (std::string note : figure.notes) {
    std::replace_if(
        note.begin(), note.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += "# " + note + " \n";  // the blank: a backslash at the end would continue the comment
  }
  text += fmt::format(
      "if (!exists('out')) out = '{}.svg'\nset encoding utf8\nset terminal svg size {:.0f},{:.0f} enhanced font 'sans-serif,13' background "
      "'#ffffff'\nset output out\n",
      figure.name, width, height);
  return text +
         "set datafile separator ','\nset datafile columnheaders\nv(c) = valid(c) ? column(c) : NaN\n"
         "set style line 11 lc rgb '#e2e2e2' lw 1\nset grid xtics ytics back ls 11, ls 11\nset border 3 lw 1 lc rgb '#555555'\n"
         "set tics nomirror out scale 0.6 tc rgb '#222222'\nset multiplot\n";
}

/// The whole drawing [px].
struct Size {
  double width = 0.0, height = 0.0;
};

std::string panel_text(const Figure& figure, std::size_t k, const Place& place, const Size& size) {
  const auto [width, height] = size;
  const Panel& panel = figure.panels[k];
  const bool lowest = k + 1 == figure.panels.size();
  const auto from_below = [&, all = height](double y) { return 1.0 - y / all; };
  std::string text = fmt::format(
      "\nset lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n",
      left / width, 1.0 - right / width, from_below(place.top), from_below(place.top + place.height));
  text += fmt::format(
      "set key at screen {:.5f}, screen {:.5f} left bottom vertical maxrows {} Left reverse samplen 2.2 width 1 spacing 1.15 tc rgb "
      "'#222222'\n",
      (left - 12.0) / width, from_below(place.top - 5.0), std::max(place.legend_rows, 1));
  text += fmt::format("set ylabel '{}' offset 0.5,0\nset ytics {}\n", axis_text(panel.y_label, panel.y_unit),
                      panel.y_step > 0.0 ? fmt::format("{}", panel.y_step) : "autofreq");
  return text + (lowest ? fmt::format("set xlabel '{}' offset 0,0.2\nset format x '%g'\n", axis_text(figure.x_label, figure.x_unit))
                        : std::string("unset xlabel\nset format x ''\n"));
}

}  // namespace

std::vector<std::pair<const char*, const std::vector<double>*>> columns_of(const Series& s) {
  switch (s.style) {
    case Style::band:
    case Style::pale_band:
      return {{"x", &s.x}, {"lo", &s.lo}, {"hi", &s.hi}};
    case Style::error_bars:
    case Style::x_bars:
    case Style::boxes:
      return {{"x", &s.x}, {"y", &s.y}, {"lo", &s.lo}, {"hi", &s.hi}};
    default:
      return {{"x", &s.x}, {"y", &s.y}};
  }
}

bool has_data(const Series& s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    bool complete = true;
    for (const auto& [name, values] : columns_of(s)) complete = complete && std::isfinite((*values)[i]);
    if (complete) return true;
  }
  return false;
}

std::string gnuplot_script(const Figure& figure) {
  std::vector<Place> places;
  const double width = figure.equal_axes ? square_width : full_width;
  double top = figure.title.empty() ? 14.0 : title_height;
  for (const Panel& panel : figure.panels) {
    places.push_back(place_panel(panel, top, width));
    if (figure.equal_axes) places.back().height = width - left - right;
    top = places.back().top + places.back().height + panel_gap;
  }
  const double height = top - panel_gap + bottom;
  std::string text = head(figure, width, height);
  if (!figure.title.empty()) {
    text += fmt::format("set label 2 '{}' at screen {:.5f}, screen {:.5f} left font ',15' tc rgb '#111111'\n", gnuplot_text(figure.title),
                        left / width, 1.0 - 18.0 / height);
  }
  Range x = x_range_of(figure);
  std::size_t column = 1;
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    std::optional<Range> y = figure.panels[k].y_range;
    if (figure.equal_axes) {
      std::vector<const std::vector<double>*> columns;
      for (const Series& s : figure.panels[k].series) columns.push_back(&s.y);
      y = finite_range(columns);
      make_equal(x, *y, width - left - right, places[k].height);
    }
    text += panel_text(figure, k, places[k], {width, height}) + fmt::format("set xrange {}\nset yrange {}\n", range_text(x), range_text(y));
    text += plot_command(figure, figure.panels[k], column) + (k == 0 ? "unset label 2\n" : "");
  }
  return text + "unset multiplot\nset output\ndrawn = 1\n";
}

}  // namespace misfit::report
