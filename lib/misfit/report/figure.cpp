#include "misfit/report/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/core/unique_name.h"
#include "misfit/report/extent.h"
#include "misfit/report/gnuplot_run.h"
#include "misfit/report/gnuplot_script.h"
#include "misfit/report/gnuplot_series.h"
#include "misfit/report/page.h"

namespace misfit::report {
namespace {

constexpr const char* name_characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";

/// To a ten-millionth of what they span, a thousand times finer than is seen; of what spans nothing, as it is.
std::vector<double> as_drawn(std::vector<double> values) {
  constexpr int of_span = 7, all = 17;
  const auto range = extent_of(values);
  const int digits = range[1] > range[0] ? std::min(of_span + digits_before_span(range), all) : all;
  if (digits == all) return values;
  for (double& value : values) value = std::isfinite(value) ? std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr) : value;
  return values;
}

std::vector<double> padded(std::vector<double> values, std::size_t rows) {
  values.resize(rows, std::numeric_limits<double>::quiet_NaN());
  return values;
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
      const auto add = [&](const std::string& name, const Series& part) {
        for (const auto& [column, values] : columns_of(part))
          table.add(name + "." + column, unit_of(figure, panel, s.style, column), padded(as_drawn(*values), rows));
      };
      add(key, s);
      if (is_thinned(s)) add(unique_name(key + "_drawn", used), drawn_part(figure, panel, s));
    }
  }
  if (table.columns.empty()) table.add("no_data", "", padded({}, rows));
  return table;
}

}  // namespace

double colour_limit(const Figure& figure) {
  constexpr double least = 3.0;
  double most = 0.0;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      if (s.style != Style::cells) continue;
      most = std::max(most, least);
      for (const double z : s.z) most = std::isfinite(z) ? std::max(most, std::ceil(std::abs(z))) : most;
    }
  }
  return most;
}

std::string palette(std::size_t k) {
  static constexpr std::array<const char*, 6> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};
  return colours[k % colours.size()];
}

void make_names_unique(std::vector<Figure>& figures) {
  std::set<std::string> used;
  for (Figure& figure : figures) figure.name = unique_name(figure.name, used, ".");
}

std::vector<std::string> write_figures(const std::filesystem::path& dir, const std::vector<Figure>& figures) {
  if (figures.empty()) return {};
  std::for_each(figures.begin(), figures.end(), check);
  make_writable_folder(dir);
  std::vector<DrawingOrder> orders;
  for (const Figure& figure : figures) {
    write_csv(dir / (figure.name + ".csv"), numbers_of(figure));
    write_atomically(dir / (figure.name + ".gp"), gnuplot_script(figure));
    orders.push_back({figure.name, {figure.title.empty() ? figure.name : figure.title, alt_text(figure)}});
  }
  return run_gnuplot(dir, orders);
}

std::vector<std::string> files_of(const std::vector<Figure>& figures) {
  std::vector<std::string> out;
  for (const Figure& figure : figures) {
    for (const char* extension : {".csv", ".gp", ".svg"}) out.push_back(figure.name + extension);
  }
  return out;
}

std::filesystem::path write_figure(const std::filesystem::path& dir, const Figure& figure) {
  static_cast<void>(write_figures(dir, {figure}));
  return dir / (figure.name + ".svg");
}

}  // namespace misfit::report
