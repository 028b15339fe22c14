#include "misfit/data/track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/missing.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

constexpr double farthest = 1e5;  // [px] beyond any image: a tracker's mark for "not found"

void check_names(const ColumnMap& columns) {
  const std::vector<std::string>& known = track_signals();
  for (const auto& [name, header] : columns.header_of) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError("columns: a track has no signal '" + shown(name) + "'" + suggest(name, known));
  }
}

/// The file has no column of that signal, and the map asks for none.
bool absent(const Table& table, const ColumnMap& columns, const std::string& name) {
  return columns.header(name) == name && table.find(name) == nullptr;
}

struct Raw {
  std::vector<double> t, P_y, P_z, sigma, ok;
  bool has_ok = false;
};

class TrackBuilder {
 public:
  TrackBuilder(const Table& table, std::vector<std::string> notes) : table_(table) { track_.notes = std::move(notes); }

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
    track_.P_y.push_back(ok ? raw.P_y[i] : kMissing);
    track_.P_z.push_back(ok ? raw.P_z[i] : kMissing);
    track_.sigma.push_back(raw.sigma[i]);
    track_.ok.push_back(ok);
  }

  Track finish() {
    if (lost_ == track_.t.size()) {
      throw RunError(fmt::format("{}: {} lost: there is no position of the apex to work with", table_.source,
                                 table_.rows() == 1 ? "its one sample is" : fmt::format("all {} samples are", table_.rows())));
    }
    if (without_time_ > 0)
      track_.notes.push_back(counted(without_time_, "row without a time was dropped", "rows without a time were dropped"));
    if (far_ > 0)
      track_.notes.push_back(fmt::format("{} more than {:.0f} px from the image centre {} as lost", counted(far_, "sample", "samples"),
                                         farthest, far_ == 1 ? "counts" : "count"));
    if (lost_ > 0) track_.notes.push_back(fmt::format("{} of {} samples {} lost", lost_, track_.t.size(), lost_ == 1 ? "is" : "are"));
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

std::vector<std::string> film_channels(const std::vector<std::string>& markers) {
  const std::vector<std::string> of_one{"x_px", "y_px", "x_m", "y_m"};
  std::vector<std::string> out;
  for (const std::string& marker : markers) {
    for (const std::string& channel : of_one) out.push_back(channel + "_" + marker);
  }
  return markers.empty() ? of_one : out;
}

const std::vector<std::string>& track_signals() {
  static const std::vector<std::string> names{"t", "P_y", "P_z", "sigma", "ok"};
  return names;
}

Track read_track(const std::filesystem::path& path, const ColumnMap& columns) {
  check_names(columns);
  const Table table = read_csv(path);
  Raw raw;
  std::vector<std::string> notes;
  const auto required = [&](const char* name, const char* unit) { return columns.values(table, name, unit, notes); };
  const auto optional = [&](const char* name, const char* unit) {
    return absent(table, columns, name) ? std::vector<double>(table.rows(), kMissing) : required(name, unit);
  };
  raw.t = required("t", "s");
  raw.P_y = required("P_y", "px");
  raw.P_z = required("P_z", "px");
  raw.sigma = optional("sigma", "px");
  raw.has_ok = table.find(columns.header("ok")) != nullptr;
  raw.ok = optional("ok", "-");
  TrackBuilder builder(table, std::move(notes));
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
