#include "misfit/data/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"

namespace misfit {
namespace {

/// A static rig is tilted by less than a quarter turn: a larger angle is degrees under a header without unit.
void check_angles(const Table& table, const std::vector<double>& theta) {
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const Source where{table.source, table.line[i], 0};
    if (std::isnan(theta[i])) throw InputError(where, "column 'theta': the angle is missing");
    if (std::abs(theta[i]) < std::numbers::pi / 2.0) continue;
    throw InputError(where,
                     fmt::format("theta = {} rad is beyond a quarter turn; if it is in degrees, the header must be theta[deg]", theta[i]));
  }
}

std::vector<double> positions(const Table& table, const std::string& name) {
  constexpr double farthest = 1e5;  // [px] beyond any image
  std::vector<double> values = table.values(name, "px");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) > farthest) {
      throw InputError(
          {table.source, table.line[i], 0},
          fmt::format("{} = {} px is beyond any image: at most {:.0f} px from its centre are possible", name, values[i], farthest));
    }
  }
  return values;
}

}  // namespace

Sweep read_sweep(const std::filesystem::path& path) {
  const Table table = read_csv(path);
  constexpr std::size_t max_rows = 5000;
  if (table.rows() > max_rows) {
    throw InputError({table.source, 0, 0},
                     fmt::format("{} rows; at most {} are possible: a sweep has one row for each angle at which the rig "
                                 "stood still",
                                 table.rows(), max_rows));
  }
  Sweep sweep;
  sweep.source = path.string();
  sweep.theta = table.values("theta", "rad");
  check_angles(table, sweep.theta);
  for (std::size_t k = 0; k < sweep.P_z.size(); ++k) {
    const std::string point = fmt::format("P_{}", k + 1);
    sweep.P_z[k] = positions(table, point + "z");
    if (table.find(point + "y") != nullptr) sweep.P_y[k] = positions(table, point + "y");
  }
  return sweep;
}

void write_sweep(const std::filesystem::path& path, const Sweep& sweep) {
  Table table;
  std::vector<double> degrees;
  for (double theta : sweep.theta) degrees.push_back(theta * 180.0 / std::numbers::pi);
  table.add("theta", "deg", degrees);
  for (std::size_t k = 0; k < sweep.P_z.size(); ++k) {
    const std::string point = fmt::format("P_{}", k + 1);
    if (!sweep.P_y[k].empty()) table.add(point + "y", "px", sweep.P_y[k]);
    table.add(point + "z", "px", sweep.P_z[k]);
  }
  write_csv(path, table);
}

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream rest(text);
  for (std::string line; std::getline(rest, line);) lines.push_back(line);
  return lines;
}

/// The text in column `index` of a line, without blanks and quotes about it.
std::string field_of(const std::string& line, std::size_t index) {
  std::istringstream cells(line);
  std::string field;
  for (std::size_t k = 0; k <= index; ++k) {
    field.clear();
    std::getline(cells, field, ',');
  }
  const auto first = field.find_first_not_of(" \t\"\r"), last = field.find_last_not_of(" \t\"\r");
  return first == std::string::npos ? "" : field.substr(first, last - first + 1);
}

std::optional<double> time_at(const std::vector<double>& times, std::size_t row) {
  return times.empty() || std::isnan(times[row]) ? std::nullopt : std::optional(times[row]);
}

}  // namespace

std::vector<SweepPicture> read_sweep_pictures(const std::filesystem::path& path) {
  const Table table = read_csv(path, {"file"});
  const std::vector<double> theta = table.values("theta", "rad");
  check_angles(table, theta);
  const auto column = static_cast<std::size_t>(&table.at("file") - table.columns.data());
  const auto times = [&](const char* name) { return table.find(name) == nullptr ? std::vector<double>{} : table.values(name, "s"); };
  const std::vector<double> from = times("from"), to = times("to");
  const std::vector<std::string> lines = lines_of(read_file(path));
  std::vector<SweepPicture> out;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const Source where{table.source, table.line[k], 0};
    const std::string name = field_of(lines.at(static_cast<std::size_t>(table.line[k]) - 1), column);
    if (name.empty()) throw InputError(where, "column 'file': the picture of this angle is missing");
    if (name.find('\0') != std::string::npos) throw InputError(where, "column 'file': a file name cannot hold the character NUL");
    const std::filesystem::path file = (path.parent_path() / name).lexically_normal();
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none))
      throw InputError(where, "no such file '" + shown(name) + "' in " + shown(path.parent_path().string()));
    const auto begin = time_at(from, k), end = time_at(to, k);
    if (begin && end && !(*begin < *end)) throw InputError(where, fmt::format("from = {} s must be before to = {} s", *begin, *end));
    out.push_back({theta[k], file, begin, end, where});
  }
  return out;
}

}  // namespace misfit
