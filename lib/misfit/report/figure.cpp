#include "misfit/report/figure.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/core/unique_name.h"
#include "misfit/report/gnuplot_run.h"
#include "misfit/report/gnuplot_script.h"
#include "misfit/report/gnuplot_series.h"

namespace misfit::report {
namespace {

constexpr const char* name_characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";

std::vector<double> padded(std::vector<double> values, std::size_t rows) {
  values.resize(rows, std::numeric_limits<double>::quiet_NaN());
  return values;
}

/// Does this column run along x, and so have the unit of x?
bool along_x(Style style, const std::string& column) {
  if (column == "x") return true;
  if (style == Style::x_bars || style == Style::boxes) return column != "y";
  return style == Style::cells && column == "lo";
}

const std::string& unit_of(const Figure& figure, const Panel& panel, Style style, const std::string& column) {
  if (column == "z") return figure.z_unit;
  return along_x(style, column) ? figure.x_unit : panel.y_unit;
}

void check(const Figure& figure) {
  if (figure.name.empty() || figure.name.front() == '.' || figure.name.find_first_not_of(name_characters) != std::string::npos) {
    throw InputError("figure '" + figure.name + "': a name is made of letters, digits, '_', '-' and '.'");
  }
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      for (const auto& [column, values] : columns_of(s)) {
        if (values->size() != s.x.size())
          throw InputError("figure '" + figure.name + "', series '" + s.key + "': " + column + " and x differ in length");
      }
    }
  }
}

Table numbers_of(const Figure& figure) {
  std::size_t rows = 1;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) rows = std::max(rows, s.x.size());
  }
  Table table;
  std::set<std::string> used;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      const std::string key = unique_name(s.key.empty() ? "series" : s.key, used);
      for (const auto& [column, values] : columns_of(s)) {
        table.add(key + "." + column, unit_of(figure, panel, s.style, column), padded(*values, rows));
      }
    }
  }
  if (table.columns.empty()) table.add("no_data", "", padded({}, rows));
  return table;
}

}  // namespace

std::string palette(std::size_t k) {
  static constexpr std::array<const char*, 6> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};
  return colours[k % colours.size()];
}

void make_names_unique(std::vector<Figure>& figures) {
  std::set<std::string> used;
  for (Figure& figure : figures) figure.name = unique_name(figure.name, used, ".");
}

std::filesystem::path write_figure(const std::filesystem::path& dir, const Figure& figure) {
  check(figure);
  make_writable_folder(dir);
  constexpr int digits = 7;
  write_csv(dir / (figure.name + ".csv"), numbers_of(figure), digits);
  write_atomically(dir / (figure.name + ".gp"), gnuplot_script(figure));
  run_gnuplot(dir, figure.name);
  return dir / (figure.name + ".svg");
}

}  // namespace misfit::report
