#include "misfit/report/gnuplot_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "misfit/report/extent.h"
#include "misfit/report/gnuplot_series.h"
#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

constexpr double full_width = 900.0;  // [px], as all that follow
constexpr double square_width = 680.0;
constexpr double left = 86.0;
constexpr double right = 24.0;
constexpr double colour_bar = 135.0;
constexpr double title_height = 42.0;
constexpr double legend_row = 21.0;
constexpr double panel_gap = 16.0;
constexpr double bottom = 66.0;
constexpr double left_column = 0.65;

/// Room beside the axes of all panels.
struct Margins {
  double left = 0.0, right = 0.0, bottom = 0.0;
  bool slanted = false;  ///< the names below do not fit side by side
};

/// Where a panel stands, from the top of the figure.
struct Place {
  double top = 0.0, height = 0.0;
  int legend_rows = 0;
};

std::string label_with_unit(const std::string& label, const std::string& unit) {
  return label + (unit.empty() || unit == "-" ? "" : "  [" + unit + "]");
}

std::string axis_text(const std::string& label, const std::string& unit) { return gnuplot_text(label_with_unit(label, unit)); }

std::size_t letters(const std::string& text) {
  std::size_t count = 0;
  for (const Run& run : typeset(text)) {
    for (const char c : run.text) count += (static_cast<unsigned char>(c) & 0xC0U) == 0x80U ? 0U : 1U;
  }
  return count;
}

/// A name beside an axis: of one that would leave the axes no room, begin and end.
std::string shortened(const std::string& name) {
  constexpr std::size_t most = 48, end = 18;
  std::vector<std::size_t> letters_at;  // where each begins
  for (std::size_t byte = 0; byte < name.size(); ++byte) {
    if ((static_cast<unsigned char>(name[byte]) & 0xC0U) != 0x80U) letters_at.push_back(byte);
  }
  if (letters_at.size() <= most) return name;
  return name.substr(0, letters_at[most - end - 1]) + "…" + name.substr(letters_at[letters_at.size() - end]);
}

/// High enough for the words along its y axis.
double height_of(const Panel& panel) {
  constexpr double letter = 7.0, between = 12.0;
  return std::max(panel.height, between + letter * static_cast<double>(letters(label_with_unit(panel.y_label, panel.y_unit))));
}

/// `width`: of the axes.
Place place_panel(const Panel& panel, double top, double width) {
  std::size_t entries = 0;
  std::size_t longest = 0;
  for (const Series& s : panel.series) {
    if (s.legend.empty()) continue;
    ++entries;
    longest = std::max(longest, letters(legend_of(s)));
  }
  Place place{top, height_of(panel), 0};
  if (entries == 0) return place;
  const double entry = 62.0 + 7.6 * static_cast<double>(longest);
  const int columns = std::clamp(static_cast<int>(width / entry), 1, static_cast<int>(entries));
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

/// What is drawn along y.
Range y_extent_of(const Panel& panel) {
  if (panel.y_range) return *panel.y_range;
  std::vector<const std::vector<double>*> columns;
  for (const Series& s : panel.series) {
    for (const auto& [name, values] : columns_of(s)) {
      if (!along_x(s.style, name) && values != &s.z) columns.push_back(values);
    }
  }
  return finite_range(columns);
}

/// Digits of the numbers beside an axis that tell neighbours apart, where the six of gnuplot's own formats are too few; else 0.
int digits_of_tics(const Range& range) {
  constexpr int between_tics = 2, usual = 6, all = 15;
  const int digits = digits_before_span(range) + between_tics;
  if (digits <= usual) return 0;
  const int whole = static_cast<int>(std::ceil(std::log10(std::max(std::abs(range[0]), std::abs(range[1])))));
  return std::min(std::max(digits, whole), all);
}

std::string tics_format(const Range& range, const std::string& usual) {
  constexpr double least = 1e-4;  // below, gnuplot's own formats write out six decimals and no more
  if (std::max(std::abs(range[0]), std::abs(range[1])) < least) return "%.3g";
  const int digits = digits_of_tics(range);
  return digits > 0 ? fmt::format("%.{}g", digits) : usual;
}

/// As many marks on the x axis as long numbers find room; empty: gnuplot's own choice.
std::string x_tics_text(const Range& range, double width) {
  const int digits = digits_of_tics(range);
  if (digits == 0) return "";
  constexpr double letter = 8.0, between = 3.0;
  const double least = (range[1] - range[0]) * letter * (digits + between) / width, decade = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10.0 * decade;
  for (const double part : {5.0, 2.0}) step = part * decade >= least ? part * decade : step;
  return fmt::format("set xtics {:.15g}\n", step);
}

Margins margins_of(const Figure& figure) {
  constexpr double letter = 7.2;
  Margins m{left, right, bottom, false};
  for (const Panel& panel : figure.panels) {
    for (const Mark& mark : panel.y_marks) m.left = std::max(m.left, 30.0 + letter * static_cast<double>(letters(shortened(mark.text))));
    const int digits = panel.y_marks.empty() ? digits_of_tics(y_extent_of(panel)) : 0;
    if (digits > 0) m.left = std::max(m.left, 60.0 + letter * digits);
    for (const Series& s : panel.series) m.right = s.style == Style::cells ? colour_bar : m.right;
  }
  std::size_t longest = 0;
  for (const Mark& mark : figure.x_marks) longest = std::max(longest, letters(shortened(mark.text)));
  const double room = (full_width - m.left - m.right) / static_cast<double>(std::max<std::size_t>(figure.x_marks.size(), 1));
  m.slanted = letter * static_cast<double>(longest) > room;
  if (m.slanted) m.bottom += 0.35 * letter * static_cast<double>(longest);
  return m;
}

/// Both edges of cells about `middle`.
std::vector<double> beyond(const std::vector<double>& middle, const std::vector<double>& half) {
  std::vector<double> out;
  for (std::size_t i = 0; i < middle.size(); ++i) out.insert(out.end(), {middle[i] - half[i], middle[i] + half[i]});
  return out;
}

/// Of the panels that share x.
Range x_range_of(const Figure& figure) {
  if (figure.x_range) return *figure.x_range;
  std::vector<const std::vector<double>*> columns;
  std::vector<std::vector<double>> edges;
  bool margin = false, bars = false;
  for (const Panel& panel : figure.panels) {
    if (panel.beside) continue;
    for (const Series& s : panel.series) {
      columns.push_back(&s.x);
      if (s.style == Style::boxes) columns.insert(columns.end(), {&s.lo, &s.hi});
      if (s.style == Style::cells) edges.push_back(beyond(s.x, s.lo));
      if (s.style == Style::bars) edges.push_back({0.0});
      bars = bars || s.style == Style::bars;
      margin = margin || s.style == Style::markers || s.style == Style::error_bars;
    }
  }
  for (const auto& edge : edges) columns.push_back(&edge);
  const Range range = finite_range(columns);
  const double space = margin ? 0.015 * (range[1] - range[0]) : 0.0;  // whole markers at the edges
  const double beyond_bars = bars ? 0.03 * (range[1] - range[0]) : 0.0;
  return {range[0] - space, range[1] + space + beyond_bars};
}

/// In which long times are shown beside an axis, whose numbers stay in seconds.
struct LongTime {
  const char* unit;
  double seconds;
};

/// nullopt: the axis is none of time, or seconds tell it as well.
std::optional<LongTime> long_time(const Figure& figure) {
  constexpr double hour = 3600.0, day = 24.0 * hour;
  if (figure.x_label != "time" || figure.x_unit != "s" || !figure.x_marks.empty()) return std::nullopt;
  const Range range = x_range_of(figure);
  const double span = range[1] - range[0];
  if (span >= 3.0 * day) return LongTime{"d", day};
  return span >= 3.0 * hour ? std::optional(LongTime{"h", hour}) : std::nullopt;
}

/// Marks at whole and broken days or hours, as many as find room.
std::vector<Mark> marks_of_time(const Range& range, const LongTime& time, double width) {
  constexpr double room = 70.0;
  const double least = room * (range[1] - range[0]) / (time.seconds * width), decade = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10.0 * decade;
  for (const double part : {5.0, 2.0, 1.0}) step = part * decade >= least ? part * decade : step;
  std::vector<Mark> marks;
  constexpr double rounding = 1e-9;
  for (double k = std::ceil(range[0] / (time.seconds * step) - rounding); k * step * time.seconds <= range[1] * (1.0 + rounding); k += 1.0)
    marks.push_back({k * step * time.seconds, fmt::format("{:.10g}", k * step)});
  return marks;
}

/// Ranges that make one unit equally long on both axes of a panel of size `w` × `h`.
void make_equal(Range& x, Range& y, double w, double h) {
  const double scale = 1.06 * std::max((x[1] - x[0]) / w, (y[1] - y[0]) / h);
  const double x_middle = 0.5 * (x[0] + x[1]);
  const double y_middle = 0.5 * (y[0] + y[1]);
  x = {x_middle - 0.5 * scale * w, x_middle + 0.5 * scale * w};
  y = {y_middle - 0.5 * scale * h, y_middle + 0.5 * scale * h};
}

std::string plot_command(const Figure& figure, const Panel& panel, std::size_t& column) {
  std::vector<std::string> clauses;
  if (panel.zero_line) clauses.emplace_back("0 with lines lw 1 lc rgb '#777777' notitle");
  bool any = false;
  for (const Series& s : panel.series) {
    const std::string text = plot_clause(figure, s, column);
    if (!text.empty()) clauses.push_back(text);
    any = any || has_data(s);
    column += columns_written(s);
  }
  if (!any) {
    clauses.insert(clauses.begin(), "NaN notitle");
    return fmt::format("set label 1 'no data' at graph 0.5, graph 0.5 center tc rgb '#777777' font ',16'\nset yrange [0:1]\nplot {}\n",
                       fmt::join(clauses, ", \\\n     "));
  }
  return fmt::format("unset label 1\nplot {}\n", fmt::join(clauses, ", \\\n     "));
}

std::string range_text(const std::optional<Range>& range) {
  return range ? fmt::format("[{:.17g}:{:.17g}]", (*range)[0], (*range)[1]) : "[*:*]";
}

std::string head(const Figure& figure, double width, double height) {
  std::string text = fmt::format("# {}\n# Run in this folder: gnuplot {}.gp\n", figure.name, figure.name);
  for (std::string note : figure.notes) {
    std::replace_if(
        note.begin(), note.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += "# " + note + " \n";  // the blank: a backslash at the end would continue the comment
  }
  text += fmt::format(
      "if (!exists('out')) out = '{}.svg'\nset encoding utf8\nset minussign\nset terminal svg size {:.0f},{:.0f} enhanced font "
      "'sans-serif,13' background "
      "'#ffffff'\nset output out\n",
      figure.name, width, height);
  return text +
         "set datafile separator ','\nset datafile columnheaders\nv(c) = valid(c) ? column(c) : NaN\n"
         "set style line 11 lc rgb '#e2e2e2' lw 1\nset grid xtics ytics back ls 11, ls 11\nset border 3 lw 1 lc rgb '#555555'\n"
         "set tics nomirror out scale 0.6 tc rgb '#222222'\nset multiplot\n";
}

std::string marks_text(const std::vector<Mark>& marks) {
  std::string text;
  for (const Mark& mark : marks)
    text += fmt::format("{}'{}' {:.9g}", text.empty() ? "" : ", ", gnuplot_text(shortened(mark.text)), mark.at);
  return "(" + text + ")";
}

std::vector<Mark> blank(std::vector<Mark> marks) {
  for (Mark& mark : marks) mark.text.clear();
  return marks;
}

/// Blue for negative, red for positive, white at 0.
std::string colours_text(const Figure& figure, const Panel& panel) {
  const bool cells = std::any_of(panel.series.begin(), panel.series.end(), [](const Series& s) { return s.style == Style::cells; });
  if (!cells) return "";
  const double most = colour_limit(figure);
  return fmt::format(
      "set palette defined (-1 '#0072B2', 0 '#ffffff', 1 '#D55E00')\nset cbrange [{:.9g}:{:.9g}]\nset cblabel '{}' offset 1.2,0\n"
      "set colorbox\n",
      -most, most, axis_text(figure.z_label, figure.z_unit));
}

/// The whole drawing [px].
struct Size {
  double width = 0.0, height = 0.0;
};

bool has_columns(const Figure& figure) {
  return std::any_of(figure.panels.begin(), figure.panels.end(), [](const Panel& panel) { return panel.beside.has_value(); });
}

/// Room beside the axes of one panel: of two columns the left one is twice as wide.
Margins margins_of_panel(const Figure& figure, const Panel& panel, double width) {
  Margins m = margins_of(figure);
  if (!has_columns(figure)) return m;
  constexpr double gap = 26.0;
  const double split = m.left + left_column * (width - m.left - m.right);
  if (panel.beside) {
    m.left = split + gap;
  } else {
    m.right = width - split;
  }
  return m;
}

std::string panel_text(const Figure& figure, std::size_t k, const Place& place, const Size& size) {
  const auto [width, height] = size;
  const Panel& panel = figure.panels[k];
  const Margins m = margins_of_panel(figure, panel, width);
  const std::size_t below = k + 1 + (k + 1 < figure.panels.size() && figure.panels[k + 1].beside && !panel.beside ? 1U : 0U);
  const bool lowest = below == figure.panels.size();
  const auto from_below = [&, all = height](double y) { return 1.0 - y / all; };
  std::string text = fmt::format(
      "\nset lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n",
      m.left / width, 1.0 - m.right / width, from_below(place.top), from_below(place.top + place.height));
  text += fmt::format(
      "set key at screen {:.5f}, screen {:.5f} left bottom vertical maxrows {} Left reverse samplen 2.2 width 1 spacing 1.15 tc rgb "
      "'#222222'\n",
      (m.left - 12.0) / width, from_below(place.top - 5.0), std::max(place.legend_rows, 1));
  text += panel.ground.empty()
              ? "unset object 1\n"
              : fmt::format("set object 1 rect from graph 0,0 to graph 1,1 fc rgb '{}' fs solid noborder behind\n", panel.ground);
  const std::string y_tics = panel.beside             ? marks_text(blank(figure.panels[k - 1].y_marks))
                             : !panel.y_marks.empty() ? marks_text(panel.y_marks)
                             : panel.y_step > 0.0     ? fmt::format("{}", panel.y_step)
                                                      : "autofreq";
  text += fmt::format("set ylabel '{}' offset 0.5,0\nset ytics {}\nset format y '{}'\n", axis_text(panel.y_label, panel.y_unit), y_tics,
                      tics_format(y_extent_of(panel), "% h"));
  text += colours_text(figure, panel);
  if (figure.x_marks.empty() && !has_columns(figure)) text += x_tics_text(x_range_of(figure), width - m.left - m.right);
  const auto time = has_columns(figure) ? std::nullopt : long_time(figure);
  const std::vector<Mark> marks = time ? marks_of_time(x_range_of(figure), *time, width - m.left - m.right) : figure.x_marks;
  if (!lowest) return text + "unset xlabel\nset format x ''\n" + (marks.empty() ? "" : "set xtics " + marks_text(blank(marks)) + "\n");
  if (panel.beside) return text + fmt::format("set xlabel '{}' offset 0,0.2\nset format x '%g'\n", axis_text(panel.beside->label, ""));
  text += fmt::format("set xlabel '{}' offset 0,0.2\nset format x '{}'\n", axis_text(figure.x_label, time ? time->unit : figure.x_unit),
                      tics_format(x_range_of(figure), "%g"));
  if (marks.empty()) return text;
  return text + fmt::format("set xtics {} {}\n", m.slanted ? "rotate by -20 left" : "norotate center", marks_text(marks));
}

}  // namespace

std::string gnuplot_script(const Figure& figure) {
  std::vector<Place> places;
  const double width = figure.equal_axes ? square_width : full_width;
  double top = figure.title.empty() ? 14.0 : title_height;
  for (const Panel& panel : figure.panels) {
    if (panel.beside && !places.empty()) {
      places.push_back(places.back());  // its legend has the rows of its neighbour's
      continue;
    }
    const Margins m = margins_of_panel(figure, panel, width);
    places.push_back(place_panel(panel, top, width - m.left - m.right));
    if (figure.equal_axes) places.back().height = width - left - right;
    top = places.back().top + places.back().height + panel_gap;
  }
  const double height = top - panel_gap + margins_of(figure).bottom;
  std::string text = head(figure, width, height);
  if (!figure.title.empty()) {
    text += fmt::format("set label 2 '{}' at screen {:.5f}, screen {:.5f} left font ',15' tc rgb '#111111'\n", gnuplot_text(figure.title),
                        margins_of(figure).left / width, 1.0 - 18.0 / height);
  }
  Range shared = x_range_of(figure);
  std::size_t column = 1;
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    std::optional<Range> y = figure.panels[k].y_range;
    Range x = figure.panels[k].beside ? figure.panels[k].beside->range : shared;
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
