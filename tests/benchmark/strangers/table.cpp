#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>

#include "tests/benchmark/strangers/bench.h"

namespace strangers {
namespace {

using nlohmann::json;
using Rows = std::vector<json>;
constexpr double seen = 60.0;  ///< drop from which an effect ought to be found

/// The larger of what the true model gains from the truth and what discovery found that the right effect gains. A run that failed has no
/// likelihood to compare with: it counts among those that ought to be found.
double drop(const json& row) {
  if (row["verdict"] == "failed" && !row.contains("oracle_drop") && !row.contains("twin_drop"))
    return std::numeric_limits<double>::infinity();
  const json right = row.value("right", json::object());
  const json found = right.value("actual", json());
  return std::max(row.value("oracle_drop", row.value("twin_drop", 0.0)), found.is_number() ? found.get<double>() : 0.0);
}
bool named(const json& row) { return row["verdict"] == "named"; }
bool unknown(const json& row) { return row["verdict"] == "unknown"; }
bool first(const json& row) { return row.value("first", false); }
bool grouped(const json& row) { return row.value("in_group", false); }
bool wrong(const json& row) { return named(row) && !grouped(row); }

Rows some(const Rows& rows, const std::function<bool(const json&)>& test) {
  Rows out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out), test);
  return out;
}

void print_share(const Rows& rows, const std::function<bool(const json&)>& test) {
  const auto k = std::count_if(rows.begin(), rows.end(), test);
  std::printf(" %5td %4.0f%%", k, rows.empty() ? 0.0 : 100.0 * static_cast<double>(k) / static_cast<double>(rows.size()));
}

void print_head() {
  std::printf("%34s %6s %11s %11s %11s %11s %11s %11s %11s\n", "", "worlds", "detected", "first", "group", "wrong name", "unknown",
              "refused", "failed");
}

void print_line(const std::string& title, const Rows& rows) {
  std::printf("%34s %6zu", title.c_str(), rows.size());
  print_share(rows, [](const json& r) { return named(r) || unknown(r) || r["verdict"] == "refused"; });
  print_share(rows, first);
  print_share(rows, grouped);
  print_share(rows, wrong);
  print_share(rows, unknown);
  print_share(rows, [](const json& r) { return r["verdict"] == "refused"; });
  print_share(rows, [](const json& r) { return r["verdict"] == "failed"; });
  std::printf("\n");
}

std::string hidden(const json& row) {
  std::string text;
  for (const auto& h : row.value("hidden", json::array())) text += (text.empty() ? "" : "+") + h["effect"].get<std::string>();
  return text;
}

void print_by(const Rows& rows, const std::function<std::string(const json&)>& key) {
  std::map<std::string, Rows> groups;
  for (const auto& row : rows) groups[key(row)].push_back(row);
  for (const auto& [name, list] : groups) print_line(name, list);
}

/// In words, why the right name was not first: what became of its candidate.
std::string fate(const json& row) {
  if (first(row)) return "first";
  if (row["verdict"] == "failed") return "the run failed";
  if (!row.contains("right")) return "never a candidate there";
  const json& right = row["right"];
  if (named(row) && grouped(row)) return "in the group";
  if (right["actual"].is_null()) return right["p"] < 0.05 ? "significant but not refitted" : "not significant by its score";
  if (right["gain"].is_null()) return "refitted, then passed by";
  return "refused after its refit";
}

void print_times(const Rows& rows) {
  std::printf("\n");
  for (const char* name : {"seconds", "processor_seconds"}) {
    std::vector<double> seconds;
    for (const auto& row : rows) seconds.push_back(row.value(name, 0.0));
    std::sort(seconds.begin(), seconds.end());
    if (!seconds.empty()) std::printf("%s of discover: median %.1f, largest %.1f\n", name, seconds[seconds.size() / 2], seconds.back());
  }
}

void print_null(const Rows& rows) {
  const auto alarms = std::count_if(rows.begin(), rows.end(), [](const json& r) { return named(r) || unknown(r); });
  const auto n = static_cast<std::ptrdiff_t>(rows.size());
  if (n == 0) return;
  const double upper =
      alarms >= n ? 1.0 : boost::math::ibeta_inv(static_cast<double>(alarms) + 1.0, static_cast<double>(n - alarms), 0.975);
  std::printf("\nnull: false alarms %td of %td (%.1f %%), 95 %% upper bound %.1f %%\n", alarms, n,
              100.0 * static_cast<double>(alarms) / static_cast<double>(n), 100.0 * upper);
}

/// Of what was accepted in any world, by its held-out gain: is it right to believe it more where it gains more?
void print_reliability(const Rows& rows) {
  constexpr double edges[] = {0.0, 3.0, 10.0, 30.0, 100.0, 300.0, std::numeric_limits<double>::infinity()};
  std::printf("\naccepted, by held-out gain of the log-likelihood\n%34s %6s %11s\n", "", "worlds", "right");
  for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
    const Rows accepted = some(rows, [&](const json& r) {
      return named(r) && r.contains("gain") && r["gain"].is_number() && r["gain"] >= edges[i] && r["gain"] < edges[i + 1];
    });
    char title[64];
    std::snprintf(title, sizeof title, "%g to %g", edges[i], edges[i + 1]);
    std::printf("%34s %6zu", title, accepted.size());
    print_share(accepted, grouped);
    std::printf("\n");
  }
}

/// Of the hidden numbers of effects that were named first, how many lie within two and three standard errors of their estimate.
void print_intervals(const Rows& rows) {
  double numbers = 0.0, within_two = 0.0, within_three = 0.0;
  for (const json& row : rows) {
    for (const json& i : row.value("intervals", json::array())) {
      const double off = std::abs(i["value"].get<double>() - i["truth"].get<double>()) / i["sigma"].get<double>();
      numbers += 1.0;
      within_two += off < 2.0 ? 1.0 : 0.0;
      within_three += off < 3.0 ? 1.0 : 0.0;
    }
  }
  if (numbers > 0.0)
    std::printf("\nhidden numbers within 2 sigma of their estimates: %.1f %% of %.0f, within 3 sigma %.1f %%\n",
                100.0 * within_two / numbers, numbers, 100.0 * within_three / numbers);
}

}  // namespace

void print_table(const Rows& rows) {
  const auto of = [&](const char* kind) { return some(rows, [=](const json& r) { return r["kind"] == kind; }); };
  const auto large = [&](const Rows& list) { return some(list, [](const json& r) { return drop(r) > seen; }); };
  const Rows effect = of("effect"), two = of("two"), unlisted = of("unlisted");
  std::printf("\ndrop > %.0f\n", seen);
  print_head();
  print_line("one listed effect", large(effect));
  print_line("two at once (either is right)", large(two));
  print_line("unlisted (drop: of the twin)", large(unlisted));
  std::printf("\nthe rest\n");
  print_head();
  print_line("one listed effect, smaller", some(effect, [](const json& r) { return drop(r) <= seen; }));
  print_line("two, smaller", some(two, [](const json& r) { return drop(r) <= seen; }));
  print_line("unlisted, smaller", some(unlisted, [](const json& r) { return drop(r) <= seen; }));
  print_line("null", of("null"));
  print_null(of("null"));
  std::printf("\none listed effect, drop > %.0f, by what became of the right candidate\n", seen);
  print_head();
  print_by(large(effect), fate);
  std::printf("\nby system\n");
  print_head();
  print_by(large(effect), [](const json& r) { return r["system"].get<std::string>(); });
  std::printf("\nby effect\n");
  print_head();
  print_by(large(effect), [](const json& r) { return r["system"].get<std::string>() + " " + hidden(r); });
  print_reliability(rows);
  print_intervals(rows);
  print_times(rows);
}

}  // namespace strangers
