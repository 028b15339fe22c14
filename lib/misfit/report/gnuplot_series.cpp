#include "misfit/report/gnuplot_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/report/extent.h"
#include "misfit/report/symbols.h"
#include "misfit/show/extreme_rows.h"

namespace misfit::report {
namespace {

constexpr std::size_t most_vertices = 5000;  // some five for each pixel of the axes
constexpr std::size_t most_dots = 2000;      // one costs a drawing ten times the bytes of a vertex

bool is_dots(Style style) { return style == Style::points || style == Style::markers; }

/// Which of `places` places of an axis; what is beyond an end belongs to that end.
std::size_t place_on(const std::array<double, 2>& axis, std::size_t places, double value) {
  const double part = axis[1] > axis[0] ? (value - axis[0]) / (axis[1] - axis[0]) : 0.0;
  return static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 1.0) * static_cast<double>(places - 1)));
}

/// The first dot at each place of the finest grid of which no more than `most_dots` places are taken.
std::vector<std::size_t> rows_on_grid(const Series& s, const std::array<double, 2>& x, const std::array<double, 2>& y) {
  constexpr std::size_t finest = 512, coarsest = 64;
  std::vector<std::size_t> out;
  for (std::size_t columns = finest; columns >= coarsest; columns = columns * 3 / 4) {
    const std::size_t rows = columns / 2;
    std::vector<bool> taken(columns * rows, false);
    out.clear();
    for (std::size_t k = 0; k < s.x.size() && out.size() <= most_dots; ++k) {
      if (!std::isfinite(s.x[k]) || !std::isfinite(s.y[k])) continue;
      const std::size_t place = place_on(x, columns, s.x[k]) * rows + place_on(y, rows, s.y[k]);
      if (!taken[place]) out.push_back(k);
      taken[place] = true;
    }
    if (out.size() <= most_dots) break;
  }
  return out;
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
    case Style::error_bars:
      return "with points pt 7 ps 0.6 " + colour;
    case Style::x_bars:
      return "with points pt 13 ps 0.9 " + colour;
    case Style::band:
      return "with filledcurves fs transparent solid 0.20 noborder fc rgb '" + s.colour + "'";
    case Style::pale_band:
      return "with filledcurves fs transparent solid 0.07 noborder fc rgb '" + s.colour + "'";
    case Style::steps:
      return fmt::format("with steps lw {} {}", s.width, colour);
    case Style::boxes:
    case Style::bars:
      return "with boxxyerror fc rgb '" + s.colour + "' fs transparent solid 0.6 border lc rgb '" + s.colour + "'";
    case Style::cells:
      return "with boxxyerror fs solid 1 noborder lc palette";
  }
  return "";
}

std::string columns_text(const Series& s, std::size_t first) {
  if (s.style == Style::boxes)
    return fmt::format("(v({0})):(v({1})):(v({2})):(v({3})):(0):(v({1}))", first, first + 1, first + 2, first + 3);
  if (s.style == Style::bars)
    return fmt::format("(v({0})):(v({1})):(0):(v({0})):(v({2})):(v({3}))", first, first + 1, first + 2, first + 3);
  if (s.style == Style::cells) {
    return fmt::format("(v({0})):(v({1})):(v({0})-v({2})):(v({0})+v({2})):(v({1})-v({3})):(v({1})+v({3})):(v({4}))", first, first + 1,
                       first + 2, first + 3, first + 4);
  }
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
                     horizontal ? length + ":(0)" : "(0):" + length, horizontal ? 3.0 : 1.8, s.colour);
}

}  // namespace

std::vector<std::pair<const char*, const std::vector<double>*>> columns_of(const Series& s) {
  switch (s.style) {
    case Style::band:
    case Style::pale_band:
      return {{"x", &s.x}, {"lo", &s.lo}, {"hi", &s.hi}};
    case Style::cells:
      return {{"x", &s.x}, {"y", &s.y}, {"lo", &s.lo}, {"hi", &s.hi}, {"z", &s.z}};
    case Style::error_bars:
    case Style::x_bars:
    case Style::boxes:
    case Style::bars:
      return {{"x", &s.x}, {"y", &s.y}, {"lo", &s.lo}, {"hi", &s.hi}};
    default:
      return {{"x", &s.x}, {"y", &s.y}};
  }
}

bool along_x(Style style, const std::string& column) {
  if (column == "x") return true;
  if (style == Style::x_bars || style == Style::boxes) return column != "y";
  return style == Style::cells && column == "lo";
}

bool is_thinned(const Series& s) {
  switch (s.style) {
    case Style::line:
    case Style::dashed:
    case Style::dotted:
    case Style::steps:
    case Style::band:
    case Style::pale_band:
      return s.x.size() > most_vertices;
    default:
      return is_dots(s.style) && s.x.size() > most_dots;
  }
}

Series drawn_part(const Figure& figure, const Panel& panel, const Series& s) {
  std::vector<std::size_t> rows;
  if (is_dots(s.style)) {
    rows = rows_on_grid(s, figure.x_range.value_or(extent_of(s.x)), panel.y_range.value_or(extent_of(s.y)));
  } else {
    std::vector<const std::vector<double>*> lists;
    for (const auto& [name, values] : columns_of(s)) lists.push_back(values);
    rows = extreme_rows(lists, most_vertices);
  }
  Series out = s;
  for (std::vector<double>* list : {&out.x, &out.y, &out.lo, &out.hi, &out.z}) {
    if (list->size() != s.x.size()) continue;
    const std::vector<double> all = std::move(*list);
    list->clear();
    for (const std::size_t k : rows) list->push_back(all[k]);
  }
  return out;
}

std::size_t columns_written(const Series& s) { return columns_of(s).size() * (is_thinned(s) ? 2 : 1); }

bool has_data(const Series& s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    bool complete = true;
    for (const auto& [name, values] : columns_of(s)) complete = complete && std::isfinite((*values)[i]);
    if (complete) return true;
  }
  return false;
}

std::string legend_of(const Series& s) { return has_data(s) || s.legend.empty() ? s.legend : s.legend + " (no data)"; }

std::string plot_clause(const Figure& figure, const Series& s, std::size_t first) {
  const std::string legend = legend_of(s);
  if (!has_data(s)) return legend.empty() ? "" : fmt::format("keyentry {} title '{}'", look(s), gnuplot_text(legend));
  const std::size_t drawn = first + columns_written(s) - columns_of(s).size();
  const std::string title = legend.empty() ? "notitle" : "title '" + gnuplot_text(legend) + "'";
  return bars_clause(figure, s, first) + fmt::format("'{}.csv' using {} {} {}", figure.name, columns_text(s, drawn), look(s), title);
}

}  // namespace misfit::report
