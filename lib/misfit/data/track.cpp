#include "misfit/data/track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"

namespace misfit {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double farthest = 1e5;  // [px] beyond any image: a tracker's mark for "not found"

void check_names(const ColumnMap& columns) {
  const std::vector<std::string>& known = track_signals();
  for (const auto& [name, header] : columns.header_of) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError("columns: a track has no signal '" + shown(name) + "'" + suggest(name, known));
  }
}

/// The column of an optional signal: NaN in every row where the file has none and the map asks for none.
std::vector<double> optional_column(const Table& table, const ColumnMap& columns, const std::string& name, const std::string& unit) {
  const std::string header = columns.header(name);
  if (header == name && table.find(name) == nullptr) return std::vector<double>(table.rows(), missing);
  return table.values(header, unit);
}

struct Raw {
  std::vector<double> t, P_y, P_z, sigma, ok;
  bool has_ok = false;
};

class TrackBuilder {
 public:
  explicit TrackBuilder(const Table& table) : table_(table) {}

  void add_row(const Raw& raw, std::size_t i) {
    const double t = raw.t[i];
    if (std::isnan(t)) {
      ++without_time_;
      return;
    }
    if (!track_.t.empty() && t <= track_.t.back()) {
      fail(i, fmt::format("time does not increase: {} s after {} s", t, track_.t.back()));
    }
    if (raw.sigma[i] <= 0.0) fail(i, fmt::format("sigma = {} px must be above 0 (leave it empty where it is not known)", raw.sigma[i]));
    if (raw.has_ok && raw.ok[i] != 0.0 && raw.ok[i] != 1.0 && !std::isnan(raw.ok[i]))
      fail(i, fmt::format("ok = {} must be 0 or 1", raw.ok[i]));
    const bool far = std::abs(raw.P_y[i]) > farthest || std::abs(raw.P_z[i]) > farthest;
    const bool ok = !far && !std::isnan(raw.P_y[i]) && !std::isnan(raw.P_z[i]) && (!raw.has_ok || raw.ok[i] == 1.0);
    far_ += far ? 1 : 0;
    lost_ += ok ? 0 : 1;
    track_.t.push_back(t);
    track_.P_y.push_back(ok ? raw.P_y[i] : missing);
    track_.P_z.push_back(ok ? raw.P_z[i] : missing);
    track_.sigma.push_back(raw.sigma[i]);
    track_.ok.push_back(ok);
  }

  Track finish() {
    if (lost_ == track_.t.size()) {
      throw RunError(
          fmt::format("{}: all {} samples are lost: there is no position of the apex to work with", table_.source, table_.rows()));
    }
    if (without_time_ > 0) track_.notes.push_back(fmt::format("{} rows without a time were dropped", without_time_));
    if (far_ > 0) track_.notes.push_back(fmt::format("{} samples more than {:.0f} px from the image centre count as lost", far_, farthest));
    if (lost_ > 0) track_.notes.push_back(fmt::format("{} of {} samples are lost", lost_, track_.t.size()));
    return std::move(track_);
  }

 private:
  [[noreturn]] void fail(std::size_t row, const std::string& message) const {
    throw InputError({table_.source, table_.line[row], 0}, message);
  }

  const Table& table_;
  Track track_;
  std::size_t without_time_ = 0, far_ = 0, lost_ = 0;
};

}  // namespace

const std::vector<std::string>& track_signals() {
  static const std::vector<std::string> names{"t", "P_y", "P_z", "sigma", "ok"};
  return names;
}

std::string ColumnMap::header(const std::string& name) const {
  const auto it = std::find_if(header_of.begin(), header_of.end(), [&](const auto& entry) { return entry.first == name; });
  return it == header_of.end() ? name : it->second;
}

Track read_track(const std::filesystem::path& path, const ColumnMap& columns) {
  check_names(columns);
  const Table table = read_csv(path);
  Raw raw;
  raw.t = table.values(columns.header("t"), "s");
  raw.P_y = table.values(columns.header("P_y"), "px");
  raw.P_z = table.values(columns.header("P_z"), "px");
  raw.sigma = optional_column(table, columns, "sigma", "px");
  raw.has_ok = table.find(columns.header("ok")) != nullptr;
  raw.ok = optional_column(table, columns, "ok", "-");
  TrackBuilder builder(table);
  for (std::size_t i = 0; i < table.rows(); ++i) builder.add_row(raw, i);
  return builder.finish();
}

void write_track(const std::filesystem::path& path, const Track& track) {
  Table table;
  table.add("t", "s", track.t);
  table.add("P_y", "px", track.P_y);
  table.add("P_z", "px", track.P_z);
  table.add("sigma", "px", track.sigma);
  table.add("ok", "", std::vector<double>(track.ok.begin(), track.ok.end()));
  write_csv(path, table);
}

}  // namespace misfit
