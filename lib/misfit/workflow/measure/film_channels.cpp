#include "misfit/workflow/measure/film_channels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/missing.h"
#include "misfit/core/shown.h"
#include "misfit/math/homography.h"
#include "misfit/math/statistics.h"
#include "misfit/model/system.h"
#include "misfit/workflow/measure/plane_calibration.h"

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

namespace {

/// From pixels to metres, right and upwards: the map of the plane, or one scale.
std::optional<PlaneMap> metres_of(const TrackFacts& facts, const VideoStudy& video) {
  if (facts.plane) return map_of(*facts.plane);
  const std::optional<double> scale = metres_per_pixel(video);
  if (!scale) return std::nullopt;
  const PixelPoint origin = video.origin.value_or(PixelPoint{0.5 * (facts.width - 1), 0.5 * (facts.height - 1)});
  PlaneMap map;
  map.homography << 1.0 / *scale, 0.0, origin.column, 0.0, -1.0 / *scale, origin.row, 0.0, 0.0, 1.0;
  return map;
}

/// Where the track is in the picture.
Eigen::Vector2d pixel_of(const FilmTrack& followed, std::size_t k) {
  return {0.5 * followed.facts.width - followed.track.P_y[k], 0.5 * followed.facts.height + followed.track.P_z[k]};
}

std::vector<std::string> channels_of(const FilmTrack& followed) {
  return film_channels(followed.name.empty() ? std::vector<std::string>{} : std::vector{followed.name});
}

}  // namespace

Table film_table(const std::vector<FilmTrack>& tracks, const VideoStudy& video) {
  Table table;
  table.source = tracks.front().facts.video;
  table.add("t", "s", tracks.front().track.t);
  for (const FilmTrack& followed : tracks) {
    const Track& track = followed.track;
    if (track.t != tracks.front().track.t) {
      throw RunError("video " + shown(followed.facts.video) + ": the frames are read otherwise for marker '" + followed.name +
                     "' than for '" + tracks.front().name +
                     "'; fields = \"progressive\", \"top_first\" or \"bottom_first\" in [video] says how");
    }
    const std::optional<PlaneMap> metres = metres_of(followed.facts, video);
    std::array<std::vector<double>, 4> values;
    for (std::size_t k = 0; k < track.t.size(); ++k) {
      const Eigen::Vector2d pixel = track.ok[k] ? pixel_of(followed, k) : Eigen::Vector2d(kMissing, kMissing);
      const std::optional<Eigen::Vector2d> place = metres && track.ok[k] ? metres->place(pixel) : std::nullopt;
      values[0].push_back(pixel.x());
      values[1].push_back(pixel.y());
      values[2].push_back(place ? place->x() : kMissing);
      values[3].push_back(place ? place->y() : kMissing);
    }
    const std::vector<std::string> channels = channels_of(followed);
    for (std::size_t i = 0; i < (metres ? 4 : 2); ++i) table.add(channels[i], i < 2 ? "px" : "m", values[i]);
  }
  return table;
}

double film_sigma(const FilmTrack& followed, const std::string& channel, const VideoStudy& video) {
  const std::vector<std::string> channels = channels_of(followed);
  const auto which = std::find(channels.begin(), channels.end(), channel) - channels.begin();
  const std::optional<PlaneMap> metres = metres_of(followed.facts, video);
  std::vector<double> known;
  for (std::size_t k = 0; k < followed.track.sigma.size(); ++k) {
    const double sigma = followed.track.sigma[k];
    if (!followed.track.ok[k] || !std::isfinite(sigma)) continue;
    if (which < 2) known.push_back(sigma);
    if (which != 2 && which != 3) continue;
    const auto place = metres ? metres->place(pixel_of(followed, k)) : std::nullopt;
    if (place) known.push_back(metres->sigmas_at(*place, sigma)(which - 2));
  }
  return known.empty() ? 0.0 : median(known);
}

}  // namespace misfit
