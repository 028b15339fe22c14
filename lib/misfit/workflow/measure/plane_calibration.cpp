#include "misfit/workflow/measure/plane_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/math/statistics.h"
#include "misfit/workflow/measure/plane_patterns.h"

namespace misfit {
namespace {

using Eigen::Vector2d;

KnownPlaces known_places(const std::filesystem::path& path, const VideoStudy& study) {
  if (study.chessboard) return chessboard_places(path, *study.chessboard);
  return study.points.empty() ? tag_places(path, study.aruco) : point_places(path, study);
}

/// What a large residual may mean, in words.
std::vector<std::string> doubts(const KnownPlaces& known, const PlaneFit& fit) {
  constexpr double doubtful = 1.5, of_points = 3.0;  // [px]: corners are found to a tenth of one, places clicked on to one or two
  if (!(fit.rms > (known.names.empty() ? doubtful : of_points))) return {};
  const std::string off = fmt::format("places known in metres lie {:.1f} px (RMS) from where a camera sees a plane", fit.rms);
  if (known.names.empty()) return {off + ": is the pattern flat, are its squares as large as said, does the camera stand still?"};
  const auto worst = std::max_element(fit.distances.begin(), fit.distances.end()) - fit.distances.begin();
  return {fmt::format("{}; the farthest is '{}' of [video.points], {:.1f} px: is its pixel or its place wrong?", off, known.names[worst],
                      fit.distances[worst])};
}

/// Scale and uncertainty of the map where the track is.
void look_along(const Track& track, const PlaneFit& fit, PlaneFacts& facts) {
  std::vector<double> scales;
  const Vector2d half(facts.column + 0.5, facts.row + 0.5);
  for (std::size_t k = 0; k < track.t.size(); ++k) {
    if (!track.ok[k]) continue;
    const auto place = fit.map.place(half + Vector2d(-track.P_y[k], track.P_z[k]));
    if (!place) continue;
    scales.push_back(fit.map.sigmas_at(*place, std::sqrt(0.5)).norm());
    facts.sigma = std::max(facts.sigma, fit.sigma_at(*place));
  }
  if (!scales.empty()) facts.scale = median(scales);
}

}  // namespace

std::optional<PlaneFacts> calibrate_plane(const std::filesystem::path& path, const VideoStudy& study, const Track& track) {
  if (!study.has_plane()) return std::nullopt;
  const KnownPlaces known = known_places(path, study);
  std::string why;
  auto fit = fit_plane(known.points, known.picture, why, known.sigma);
  if (!fit && !study.points.empty()) throw InputError("[video.points]: " + why);
  if (!fit) throw RunError(path.string() + ": no map from pixels to metres: " + why);
  PlaneFacts out;
  out.from = study.chessboard ? "chessboard" : study.points.empty() ? "aruco" : "points";
  out.points = known.points.size();
  out.frames = known.frames;
  out.rms = fit->rms;
  out.k1 = fit->map.k1;
  out.column = fit->map.middle.x();
  out.row = fit->map.middle.y();
  out.radius = fit->map.radius;
  out.warnings = known.warnings;
  for (const std::string& doubt : doubts(known, *fit)) out.warnings.push_back(doubt);
  look_along(track, *fit, out);
  Eigen::Matrix3d& h = fit->map.homography;
  if (study.origin) {
    const auto origin = fit->map.place({study.origin->column, study.origin->row});
    if (!origin) throw InputError("[video] origin: the plane of the motion is not seen there");
    h.col(2) += h.leftCols<2>() * *origin;  // metres from there
  }
  h /= h.norm();
  for (int k = 0; k < 9; ++k) out.homography.push_back(h(k / 3, k % 3));
  return out;
}

PlaneMap map_of(const PlaneFacts& facts) {
  PlaneMap map;
  if (facts.homography.size() != 9) throw InputError("plane.homography: nine numbers are expected");
  for (int k = 0; k < 9; ++k) map.homography(k / 3, k % 3) = facts.homography[k];
  map.k1 = facts.k1;
  map.middle = {facts.column, facts.row};
  map.radius = facts.radius;
  return map;
}

}  // namespace misfit
