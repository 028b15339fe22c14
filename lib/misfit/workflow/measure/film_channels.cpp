#include "misfit/workflow/measure/film_channels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/model/system.h"

namespace misfit {
namespace {

/// The channel that an output is read from.
std::string channel_of(const std::string& output, const ExperimentStudy& experiment) {
  for (const auto& [name, header] : experiment.columns.header_of) {
    if (name == output) return header;
  }
  return output;
}

}  // namespace

bool reads_film(const Session& session, const ExperimentStudy& experiment) {
  if (!experiment.video) return false;
  const ModelRequest& request = session.model.request;
  const SystemSpec spec = session.registry.system(request.system, request.system_where).make(request.options)->spec();
  return std::any_of(spec.outputs.begin(), spec.outputs.end(), [&](const OutputSpec& o) {
    return std::count(film_channels().begin(), film_channels().end(), channel_of(o.name, experiment)) > 0;
  });
}

std::optional<double> metres_per_pixel(const VideoStudy& video) {
  if (!video.length) return std::nullopt;
  const auto& [from, to, metres] = *video.length;
  return metres / std::hypot(to.column - from.column, to.row - from.row);
}

Table film_table(const Track& track, const TrackFacts& facts, const VideoStudy& video) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const PixelPoint origin = video.origin.value_or(PixelPoint{0.5 * (facts.width - 1), 0.5 * (facts.height - 1)});
  const std::optional<double> scale = metres_per_pixel(video);
  std::vector<double> column, row, x, y;
  for (std::size_t k = 0; k < track.t.size(); ++k) {
    column.push_back(track.ok[k] ? 0.5 * facts.width - track.P_y[k] : missing);
    row.push_back(track.ok[k] ? 0.5 * facts.height + track.P_z[k] : missing);
    x.push_back(scale.value_or(missing) * (column.back() - origin.column));
    y.push_back(scale.value_or(missing) * (origin.row - row.back()));
  }
  Table table;
  table.source = facts.video;
  table.add("t", "s", track.t);
  table.add("x_px", "px", column);
  table.add("y_px", "px", row);
  if (!scale) return table;
  table.add("x_m", "m", x);
  table.add("y_m", "m", y);
  return table;
}

}  // namespace misfit
