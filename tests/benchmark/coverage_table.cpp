#include "tests/benchmark/coverage_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace misfit::bench {
namespace {

constexpr const char* header = "method,kind,number,status,quantity,truth,value,sigma,plain_sigma,low,high";
constexpr double two_sided = 1.959964;  // of 95 %

std::string key(const CoverageRow& row) { return row.method + " " + row.kind + " " + std::to_string(row.number); }

CoverageRow parse(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  constexpr std::size_t columns = 11;
  if (cells.size() != columns) return {};
  return {cells[0],
          cells[1],
          std::stoi(cells[2]),
          cells[3],
          cells[4],
          std::stod(cells[5]),
          std::stod(cells[6]),
          std::stod(cells[7]),
          std::stod(cells[8]),
          std::stod(cells[9]),
          std::stod(cells[10])};
}

struct Cell {
  int flights = 0, inside = 0, with_plain = 0, inside_plain = 0;
  double error = 0.0, squares = 0.0, scatter = 0.0, sigma = 0.0, plain = 0.0;

  void add(const CoverageRow& row) {
    const double e = row.value - row.truth;
    ++flights;
    const bool own = row.high > row.low;
    inside += (own ? row.low <= row.truth && row.truth <= row.high : std::abs(e) <= two_sided * row.sigma) ? 1 : 0;
    error += e / row.sigma;
    squares += std::pow(e / row.sigma, 2);
    if (!std::isfinite(row.plain_sigma)) return;
    ++with_plain;
    inside_plain += std::abs(e) <= two_sided * row.plain_sigma ? 1 : 0;
    plain += row.plain_sigma / row.sigma;
  }
  [[nodiscard]] double share() const { return 100.0 * inside / std::max(flights, 1); }
  [[nodiscard]] double plain_share() const { return 100.0 * inside_plain / with_plain; }
};

}  // namespace

std::vector<CoverageRow> read_coverage(const std::string& path) {
  std::vector<CoverageRow> rows;
  std::set<std::string> complete;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    CoverageRow row = parse(line == header ? "" : line);
    if (row.method.empty()) continue;
    if (row.quantity == "end") complete.insert(key(row));
    rows.push_back(std::move(row));
  }
  std::erase_if(rows, [&](const CoverageRow& row) { return !complete.contains(key(row)); });
  return rows;
}

void append_coverage(const std::string& path, const std::vector<CoverageRow>& rows) {
  std::ostringstream text;
  text.precision(12);
  if (!std::ifstream(path).good()) text << header << "\n";
  for (const auto& r : rows)
    text << r.method << ',' << r.kind << ',' << r.number << ',' << r.status << ',' << r.quantity << ',' << r.truth << ',' << r.value << ','
         << r.sigma << ',' << r.plain_sigma << ',' << r.low << ',' << r.high << "\n";
  std::ofstream out(path, std::ios::app);
  out << text.str() << std::flush;
}

void print_coverage(const std::vector<CoverageRow>& rows) {
  std::map<std::string, std::map<std::string, Cell>> cells;
  std::map<std::string, std::map<std::string, int>> statuses;
  std::map<std::string, double> seconds;
  std::set<std::string> seen;
  for (const auto& row : rows) {
    if (!seen.insert(key(row) + " " + row.quantity).second) continue;
    const std::string group = row.method + ", " + row.kind;
    if (row.quantity == "end") {
      ++statuses[group][row.status];
      seconds[group] += row.value;
    } else if (std::isfinite(row.value) && row.sigma > 0.0) {
      cells[group][row.quantity].add(row);
    }
  }
  double sum = 0.0, count = 0.0, plain = 0.0, plain_count = 0.0;
  for (const auto& [group, quantities] : cells) {
    std::printf("\n%s:", group.c_str());
    int flights = 0;
    for (const auto& [status, times] : statuses[group]) {
      std::printf(" %d %s", times, status.c_str());
      flights += times;
    }
    std::printf(", %.2f s each\n%18s %8s %9s %8s %11s %12s %12s\n", seconds[group] / std::max(flights, 1), "quantity", "flights",
                "coverage", "plain", "mean error", "rms error", "plain sigma");
    std::printf("%18s %8s %9s %8s %11s %12s %12s\n", "", "", "%", "%", "sigmas", "sigmas", "/ sigma");
    for (const auto& [quantity, cell] : quantities) {
      const double n = std::max(cell.flights, 1);
      std::printf("%18s %8d %9.1f", quantity.c_str(), cell.flights, cell.share());
      if (cell.with_plain > 0) std::printf(" %8.1f", cell.plain_share());
      if (cell.with_plain == 0) std::printf(" %8s", "-");
      std::printf(" %11.2f %12.2f", cell.error / n, std::sqrt(cell.squares / n));
      sum += cell.share();
      count += 1.0;
      if (cell.with_plain > 0) {
        std::printf(" %12.2f\n", cell.plain / cell.with_plain);
        plain += cell.plain_share();
        plain_count += 1.0;
      } else {
        std::printf(" %12s\n", "-");
      }
    }
  }
  std::printf("\nmean over %g cells: %.1f %%", count, sum / std::max(count, 1.0));
  if (plain_count > 0.0) std::printf("; plain over %g cells: %.1f %%", plain_count, plain / plain_count);
  std::printf("\nof the flights whose estimate was given: the others are counted by their status above\n");
}

}  // namespace misfit::bench
