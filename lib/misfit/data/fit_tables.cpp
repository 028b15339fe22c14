#include "misfit/data/fit_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

bool same_columns(const CurveEstimate& a, const CurveEstimate& b) { return a.of == b.of && a.of_unit == b.of_unit && a.unit == b.unit; }

std::string curve_header(const CurveEstimate& curve) {
  return fmt::format("curve,{}[{}],value[{}],sigma[{}],count", curve.of, display_unit(curve.of_unit), display_unit(curve.unit),
                     display_unit(curve.unit));
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

double parse_number(const std::string& field, const Source& where) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || stop != end) throw InputError(where, "'" + field + "' is not a number");
  return value;
}

CurveEstimate& curve_named(std::vector<CurveEstimate>& curves, const CurveFile& file, const std::string& name, const Source& where) {
  std::vector<std::string> valid;
  for (const std::size_t k : file.curves) {
    if (curves[k].name == name) return curves[k];
    valid.push_back(curves[k].name);
  }
  throw InputError(where, "curve '" + name + "' is not one of fit.json" + suggest(name, valid));
}

constexpr const char* ahead_column = "_ahead";

bool same_times(const ChannelPrediction& a, const ChannelPrediction& b) { return a.t == b.t && a.held_out == b.held_out; }

}  // namespace

std::vector<CurveFile> curve_files(const std::vector<CurveEstimate>& curves) {
  std::vector<CurveFile> files;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const auto fits = [&](const CurveFile& file) { return same_columns(curves[file.curves.front()], curves[k]); };
    const auto found = std::find_if(files.begin(), files.end(), fits);
    if (found == files.end()) {
      files.push_back({"", {k}});
    } else {
      found->curves.push_back(k);
    }
  }
  const auto static_curve = std::find_if(curves.begin(), curves.end(), [](const CurveEstimate& curve) { return curve.trimmed; });
  if (static_curve != curves.end()) {
    const auto of_it = [&](const CurveFile& file) { return curves[file.curves.front()].of == static_curve->of; };
    std::stable_partition(files.begin(), files.end(), of_it);
  }
  std::vector<std::string> used;
  for (CurveFile& file : files) {
    const std::string base = used.empty() ? "curves" : "curves_" + file_name_for(curves[file.curves.front()].of);
    const auto taken = [&](const std::string& name) { return std::find(used.begin(), used.end(), name) != used.end(); };
    std::string name = base;
    for (int number = 2; taken(name); ++number) name = base + "_" + std::to_string(number);
    used.push_back(name);
    file.name = name + ".csv";
  }
  return files;
}

void write_curves(const std::filesystem::path& path, const std::vector<CurveEstimate>& curves, const CurveFile& file) {
  std::string text = curve_header(curves[file.curves.front()]) + "\n";
  for (const std::size_t k : file.curves) {
    const CurveEstimate& curve = curves[k];
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const std::string count = std::isfinite(curve.count[i]) ? fmt::format("{}", curve.count[i]) : std::string();
      text += fmt::format("{},{},{},{},{}\n", curve.name, display_field(curve.x[i], curve.of_unit),
                          display_field(curve.value[i], curve.unit), display_field(curve.sigma[i], curve.unit), count);
    }
  }
  write_atomically(path, text);
}

void read_curves(const std::filesystem::path& path, std::vector<CurveEstimate>& curves, const CurveFile& file) {
  std::istringstream lines(read_file(path));
  std::string line;
  Source where{path.string(), 1, 0};
  const std::string header = curve_header(curves[file.curves.front()]);
  if (!std::getline(lines, line) || line != header) throw InputError(where, "header is '" + line + "', expected '" + header + "'");
  while (std::getline(lines, line)) {
    ++where.line;
    const std::vector<std::string> cells = split(line);
    if (cells.size() != 5) throw InputError(where, fmt::format("{} fields where the header has 5", cells.size()));
    CurveEstimate& curve = curve_named(curves, file, cells[0], where);
    const auto si = [&](std::size_t k, const std::string& unit) {
      return convert(parse_number(cells[k], where), display_unit(unit), unit);
    };
    curve.x.push_back(si(1, curve.of_unit));
    curve.value.push_back(si(2, curve.unit));
    curve.sigma.push_back(si(3, curve.unit));
    curve.count.push_back(parse_number(cells[4], where));
  }
}

std::vector<PredictionFile> prediction_files(const std::vector<ChannelPrediction>& predictions) {
  std::vector<PredictionFile> files;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const std::string& experiment = predictions[k].experiment;
    const auto found = std::find_if(files.begin(), files.end(), [&](const PredictionFile& file) { return file.experiment == experiment; });
    if (found == files.end()) {
      files.push_back({"prediction" + file_suffix(files.size(), experiment) + ".csv", experiment, {k}});
    } else {
      found->channels.push_back(k);
    }
  }
  return files;
}

void write_predictions(const std::filesystem::path& path, const std::vector<ChannelPrediction>& predictions, const PredictionFile& file) {
  const ChannelPrediction& first = predictions[file.channels.front()];
  Table table;
  table.add("t", "s", first.t);
  for (const std::size_t k : file.channels) {
    const ChannelPrediction& channel = predictions[k];
    if (!same_times(first, channel)) {
      throw RunError(fmt::format("{}: channels {} and {} are not on one time base", path.string(), first.channel, channel.channel));
    }
    const std::string unit = display_level_unit(channel.unit);
    table.add(channel.channel + "_measured", unit, display_levels(channel.measured, channel.unit));
    table.add(channel.channel + "_predicted", unit, display_levels(channel.predicted, channel.unit));
    table.add(channel.channel + "_sigma", display_unit(channel.unit), display_values(channel.sigma, channel.unit));
    if (!channel.ahead.empty()) table.add(channel.channel + ahead_column, unit, display_levels(channel.ahead, channel.unit));
  }
  table.add("held_out", "", std::vector<double>(first.held_out.begin(), first.held_out.end()));
  write_csv(path, table);
}

void read_predictions(const std::filesystem::path& path, std::vector<ChannelPrediction>& predictions, const PredictionFile& file) {
  const Table table = read_csv(path);
  const std::vector<double>& held_out = table.at("held_out").values;
  for (const std::size_t k : file.channels) {
    ChannelPrediction& channel = predictions[k];
    channel.t = table.values("t", "s");
    channel.measured = table.values(channel.channel + "_measured", channel.unit);
    channel.predicted = table.values(channel.channel + "_predicted", channel.unit);
    channel.sigma = table.values(channel.channel + "_sigma", channel.unit);
    if (table.find(channel.channel + ahead_column) != nullptr) channel.ahead = table.values(channel.channel + ahead_column, channel.unit);
    channel.held_out.assign(held_out.size(), false);
    std::transform(held_out.begin(), held_out.end(), channel.held_out.begin(), [](double flag) { return flag > 0.5; });
  }
}

}  // namespace misfit
