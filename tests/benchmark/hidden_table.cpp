#include "tests/benchmark/hidden_table.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

namespace misfit::bench {
namespace {

constexpr const char* header =
    "kind,number,hidden,known_as,seconds,strength,oracle_drop,verdict,named,group,quantity,nearest,named_first,right_group,right_quantity,"
    "predicted_drop,actual_drop,trim_error_deg,trim_sigma_deg,band_share,fit_seconds,discover_seconds";

using Test = std::function<bool(const Row&)>;
constexpr double confidence = 0.95;

int count(const std::vector<Row>& rows, const Test& test) { return static_cast<int>(std::count_if(rows.begin(), rows.end(), test)); }

std::vector<Row> some(const std::vector<Row>& rows, const Test& test) {
  std::vector<Row> out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out), test);
  return out;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

struct Bin {
  double from, to;
  const char* name;
};
constexpr Bin bins[] = {{-1e9, 10, "< 10"},  {10, 20, "10-20"},   {20, 60, "20-60"},
                        {60, 200, "60-200"}, {200, 1e9, "> 200"}, {60, 1e9, "> 60"}};

void print_share(int k, std::size_t n) {
  if (n == 0) {
    std::printf("%10s", "-");
  } else {
    std::printf("%4d %4.0f%%", k, 100.0 * k / static_cast<double>(n));
  }
}

void print_found(const std::string& title, const std::vector<Row>& rows) {
  std::printf("\n%s (%zu worlds)\n%10s %7s %10s %10s %10s %10s\n", title.c_str(), rows.size(), "drop", "worlds", "detected", "first",
              "group", "unknown");
  for (const auto& bin : bins) {
    const std::vector<Row> in = some(rows, [&](const Row& r) { return r.oracle_drop >= bin.from && r.oracle_drop < bin.to; });
    std::printf("%10s %7zu ", bin.name, in.size());
    print_share(count(in, [](const Row& r) { return r.verdict == "named" || r.verdict == "unknown"; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.named_first; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.right_group; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.verdict == "unknown"; }), in.size());
    std::printf("\n");
  }
}

void print_unlisted(const std::vector<Row>& rows) {
  std::printf("\nunlisted (%zu worlds)\n%10s %7s %10s %10s %10s\n", rows.size(), "drop", "worlds", "unknown", "quantity", "named");
  for (const auto& bin : bins) {
    const std::vector<Row> in = some(rows, [&](const Row& r) { return r.oracle_drop >= bin.from && r.oracle_drop < bin.to; });
    std::printf("%10s %7zu ", bin.name, in.size());
    print_share(count(in, [](const Row& r) { return r.verdict == "unknown"; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.verdict == "unknown" && r.right_quantity; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.verdict == "named"; }), in.size());
    std::printf("\n");
  }
}

void print_null(const std::vector<Row>& rows) {
  const auto n = static_cast<int>(rows.size());
  const int alarms = count(rows, [](const Row& r) { return r.verdict == "named" || r.verdict == "unknown"; });
  const int named = count(rows, [](const Row& r) { return r.verdict == "named"; });
  std::printf("\nnull (%d worlds)\nfalse alarms %d (%d named): %.1f %%, 95 %% upper bound %.1f %%\n", n, alarms, named,
              n > 0 ? 100.0 * alarms / n : 0.0, 100.0 * upper_bound(alarms, n));
  if (n == 0) return;
  const int covered = count(rows, [](const Row& r) { return std::abs(r.trim_error) < 1.96 * r.trim_sigma; });
  double share = 0.0;
  for (const auto& r : rows) share += r.band_share / n;
  std::printf("trim inside its 95 %% interval: %d of %d (%.0f %%); share of samples with C_m inside its band: %.1f %%\n", covered, n,
              100.0 * covered / n, 100.0 * share);
}

void print_ratio(const std::vector<Row>& rows) {
  std::vector<double> ratio;
  for (const auto& r : rows) {
    if (r.actual_drop >= 20.0 && r.actual_drop <= 200.0) ratio.push_back(r.predicted_drop / r.actual_drop);
  }
  const auto inside = std::count_if(ratio.begin(), ratio.end(), [](double q) { return q >= 0.7 && q <= 1.4; });
  std::printf(
      "\npredicted over actual drop, %zu worlds with 20 to 200: quantiles 5 %% %.2f, 25 %% %.2f, 50 %% %.2f, 75 %% %.2f, 95 %% %.2f; "
      "inside 0.7 to 1.4: %.0f %%\n",
      ratio.size(), quantile(ratio, 0.05), quantile(ratio, 0.25), quantile(ratio, 0.5), quantile(ratio, 0.75), quantile(ratio, 0.95),
      ratio.empty() ? 0.0 : 100.0 * static_cast<double>(inside) / static_cast<double>(ratio.size()));
}

void print_by_effect(const std::vector<Row>& rows) {
  std::vector<std::string> effects;
  for (const auto& r : rows) {
    if (r.kind == "effect" && std::find(effects.begin(), effects.end(), r.hidden) == effects.end()) effects.push_back(r.hidden);
  }
  std::sort(effects.begin(), effects.end());
  std::printf("\nby hidden effect, drop > 60\n%24s %7s %10s %10s\n", "", "worlds", "first", "group");
  for (const auto& effect : effects) {
    const std::vector<Row> in = some(rows, [&](const Row& r) { return r.kind == "effect" && r.hidden == effect && r.oracle_drop >= 60.0; });
    std::printf("%24s %7zu ", effect.c_str(), in.size());
    print_share(count(in, [](const Row& r) { return r.named_first; }), in.size());
    std::printf(" ");
    print_share(count(in, [](const Row& r) { return r.right_group; }), in.size());
    std::printf("\n");
  }
}

}  // namespace

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::vector<Row> rows;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line.rfind("kind,", 0) == 0) continue;
    std::vector<std::string> f;
    std::stringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) f.push_back(field);
    if (f.size() != 22) continue;  // cut off by the end of an earlier run: done again
    rows.push_back({f[0],
                    f[2],
                    f[3],
                    std::stoi(f[1]),
                    std::stod(f[4]),
                    std::stod(f[5]),
                    std::stod(f[6]),
                    f[7],
                    f[8],
                    f[9],
                    f[10],
                    f[11],
                    f[12] == "1",
                    f[13] == "1",
                    f[14] == "1",
                    std::stod(f[15]),
                    std::stod(f[16]),
                    std::stod(f[17]),
                    std::stod(f[18]),
                    std::stod(f[19]),
                    std::stod(f[20]),
                    std::stod(f[21])});
  }
  return rows;
}

void append_row(const std::filesystem::path& file, const Row& r) {
  const bool fresh = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << header << '\n';
  std::ostringstream line;
  line << r.kind << ',' << r.number << ',' << r.hidden << ',' << r.known_as << ',' << r.seconds << ',' << r.strength << ',' << r.oracle_drop
       << ',' << r.verdict << ',' << r.named << ',' << r.group << ',' << r.quantity << ',' << r.nearest << ',' << r.named_first << ','
       << r.right_group << ',' << r.right_quantity << ',' << r.predicted_drop << ',' << r.actual_drop << ',' << r.trim_error << ','
       << r.trim_sigma << ',' << r.band_share << ',' << r.fit_seconds << ',' << r.discover_seconds << '\n';
  out << line.str() << std::flush;
}

double upper_bound(int k, int n) {
  if (n == 0 || k >= n) return 1.0;
  return boost::math::ibeta_inv(k + 1.0, static_cast<double>(n - k), 0.5 * (1.0 + confidence));
}

void print_summary(const std::vector<Row>& rows) {
  const auto of = [&](const std::string& kind) { return some(rows, [&](const Row& r) { return r.kind == kind; }); };
  print_null(of("null"));
  print_found("one listed effect, other forms of wake and vortices included", of("effect"));
  print_by_effect(rows);
  print_found("two at once (drop: the larger alone; first: either)", of("two"));
  print_unlisted(of("unlisted"));
  print_ratio(rows);
  std::vector<double> fit, discover;
  for (const auto& r : rows) {
    fit.push_back(r.fit_seconds);
    discover.push_back(r.discover_seconds);
  }
  std::printf("\nprocessor seconds per world: fit median %.1f, 95 %% %.1f; discover median %.1f, 95 %% %.1f; failed %d of %zu\n",
              quantile(fit, 0.5), quantile(fit, 0.95), quantile(discover, 0.5), quantile(discover, 0.95),
              count(rows, [](const Row& r) { return r.verdict == "failed"; }), rows.size());
}

}  // namespace misfit::bench
