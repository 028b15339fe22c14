#include "misfit/workflow/measure/film_channels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/model/system.h"

namespace misfit {
std::string channel_of(const std::string& output, const ExperimentStudy& experiment) {
  for (const auto& [name, header] : experiment.columns.header_of) {
    if (name == output) return header;
  }
  return output;
}

bool reads_film(const Session& session, const ExperimentStudy& experiment) {
  if (!experiment.video) return false;
  const ModelRequest& request = session.model.request;
  const SystemSpec spec = session.registry.system(request.system, request.system_where).make(request.options)->spec();
  const std::vector<std::string> channels = film_channels(session.study.video.marker_names());
  return std::any_of(spec.outputs.begin(), spec.outputs.end(),
                     [&](const OutputSpec& o) { return std::count(channels.begin(), channels.end(), channel_of(o.name, experiment)) > 0; });
}

std::optional<double> metres_per_pixel(const VideoStudy& video) {
  if (!video.length) return std::nullopt;
  const auto& [from, to, metres] = *video.length;
  return metres / std::hypot(to.column - from.column, to.row - from.row);
}

Table film_table(const std::vector<FilmTrack>& tracks, const VideoStudy& video) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> scale = metres_per_pixel(video);
  Table table;
  table.source = tracks.front().facts.video;
  table.add("t", "s", tracks.front().track.t);
  for (const auto& [name, track, facts] : tracks) {
    if (track.t != tracks.front().track.t)
      throw RunError("video " + shown(facts.video) + ": the frames are read otherwise for marker '" + name + "' than for '" +
                     tracks.front().name + "'; fields = \"progressive\", \"top_first\" or \"bottom_first\" in [video] says how");
    const PixelPoint origin = video.origin.value_or(PixelPoint{0.5 * (facts.width - 1), 0.5 * (facts.height - 1)});
    std::vector<double> column, row, x, y;
    for (std::size_t k = 0; k < track.t.size(); ++k) {
      column.push_back(track.ok[k] ? 0.5 * facts.width - track.P_y[k] : missing);
      row.push_back(track.ok[k] ? 0.5 * facts.height + track.P_z[k] : missing);
      x.push_back(scale.value_or(missing) * (column.back() - origin.column));
      y.push_back(scale.value_or(missing) * (origin.row - row.back()));
    }
    const std::vector<std::string> channels = film_channels(name.empty() ? std::vector<std::string>{} : std::vector{name});
    table.add(channels[0], "px", column);
    table.add(channels[1], "px", row);
    if (!scale) continue;
    table.add(channels[2], "m", x);
    table.add(channels[3], "m", y);
  }
  return table;
}

}  // namespace misfit
