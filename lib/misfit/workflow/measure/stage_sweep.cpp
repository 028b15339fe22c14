// Positions of the rig's three points out of pictures of the sweep.
#include <fmt/format.h>

#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/missing.h"
#include "misfit/core/shown.h"
#include "misfit/data/sweep.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/track/survey.h"
#include "misfit/track/sweep_points.h"
#include "misfit/video/video.h"
#include "misfit/workflow/measure/measure.h"
#include "misfit/workflow/measure/track_video.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_markers = 8;  // per picture: the three points and things alike
constexpr double max_drift = 3.0;       // [px] within which a marker stays while the rig stands
/// A picture with the markers in it.
struct MarkerDetections {
  Image image;
  std::vector<PixelPoint> markers;  ///< best first
  double radius = 0.0;
};

void detect_markers(const Image& image, const Marker& marker, MarkerDetections& detections) {
  detections.image = image;
  detections.markers.clear();
  for (const Location& l : find_markers({image, 0, 1}, marker, max_markers)) {
    detections.markers.push_back(l.at);
    detections.radius = std::max({detections.radius, l.outer, 5.0});
  }
}

/// Mean places over the frames of a part of a video in which the rig stands.
MarkerDetections detections_in_video(const SweepPicture& picture, const Marker& marker) {
  Video video(picture.file);
  MarkerDetections out;
  std::vector<double> count;
  bool any = false;
  while (const auto frame = video.next()) {
    const VideoFacts& facts = video.facts();
    const double t = facts.variable && frame->time ? *frame->time : static_cast<double>(frame->number) / facts.rate;
    if (picture.from && t < *picture.from) continue;
    if (picture.to && t > *picture.to) break;
    any = true;
    MarkerDetections now;
    detect_markers(frame->image, marker, now);
    if (count.empty()) {
      out = now;
      count.assign(now.markers.size(), 1.0);
      continue;
    }
    for (const PixelPoint& p : now.markers) {
      for (std::size_t k = 0; k < count.size(); ++k) {
        PixelPoint& mean = out.markers[k];
        if (std::hypot(mean.column - p.column, mean.row - p.row) > max_drift) continue;
        count[k] += 1.0;
        mean.column += (p.column - mean.column) / count[k];
        mean.row += (p.row - mean.row) / count[k];
      }
    }
  }
  if (!any) throw InputError(picture.where, "no frame of " + picture.file.filename().string() + " lies in this part");
  return out;
}

bool is_image(const fs::path& file) {
  static const std::vector<std::string> endings{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm"};
  const std::string ending = file.extension().string();
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

Shot shot_of(const SweepPicture& picture, MarkerDetections detections, const SweepPoints& points) {
  Shot shot;
  std::size_t missing_points = 0;
  for (const auto& point : points) {
    if (point) shot.at.push_back(*point);
    if (!point) ++missing_points;
  }
  shot.field = {std::move(detections.image), 0, 1};
  shot.label = fmt::format("{:.2f} deg", picture.theta * 180.0 / 3.14159265358979323846);
  if (missing_points > 0) shot.lost = fmt::format("{} of 3 points not found", missing_points);
  if (!shot.at.empty()) shot.zoom_at = shot.at.front();
  shot.radius = detections.radius;
  return shot;
}

std::string settings_of(const CameraStudy& camera) {
  std::string text = camera.sweep_marker.kind;
  for (const PixelPoint& p : camera.sweep_points) text += fmt::format(" {} {}", p.column, p.row);
  return text;
}

/// assign_sweep_points() with the pictures and their table named where it fails.
std::vector<SweepPoints> points_of(const CameraStudy& camera, const std::vector<SweepPicture>& pictures, const std::vector<double>& theta,
                                   const std::vector<std::vector<PixelPoint>>& found) {
  try {
    return assign_sweep_points(theta, found, camera.sweep_points);
  } catch (const RunError& error) {
    std::vector<std::string> names;
    for (const SweepPicture& picture : pictures) names.push_back(picture.file.filename().string());
    throw RunError(fmt::format("{} ({}): {}", camera.sweep_images->string(), some_names("", names), error.what()));
  }
}

void make_sweep(const Session& session, const std::vector<SweepPicture>& pictures, const fs::path& file, const fs::path& sheet) {
  const Marker marker = marker_of(session.study.camera.sweep_marker);
  std::vector<MarkerDetections> detections;
  std::vector<std::vector<PixelPoint>> found;
  Sweep sweep;
  for (const SweepPicture& picture : pictures) {
    stop_if_interrupted();
    detections.emplace_back();
    if (is_image(picture.file)) {
      detect_markers(read_image(picture.file), marker, detections.back());
    } else {
      detections.back() = detections_in_video(picture, marker);
    }
    found.push_back(detections.back().markers);
    sweep.theta.push_back(picture.theta);
  }
  const auto points = points_of(session.study.camera, pictures, sweep.theta, found);
  std::vector<Shot> shots;
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t p = 0; p < 3; ++p) {
      sweep.P_y[p].push_back(points[k][p] ? 0.5 * detections[k].image.width - points[k][p]->column : kMissing);
      sweep.P_z[p].push_back(points[k][p] ? points[k][p]->row - 0.5 * detections[k].image.height : kMissing);
    }
    shots.push_back(shot_of(pictures[k], std::move(detections[k]), points[k]));
  }
  write_sweep(file, sweep);
  make_writable_folder(sheet.parent_path());
  write_contact_sheet(sheet, shots);
}

}  // namespace

fs::path sweep_stage(Session& session) {
  const CameraStudy& camera = session.study.camera;
  if (camera.sweep) return *camera.sweep;
  fs::path file = session.folder.file("sweep.csv");
  const std::string sheet = "figures/sweep_sheet.png";
  const std::vector<SweepPicture> pictures = read_sweep_pictures(*camera.sweep_images);
  std::vector<fs::path> read{*camera.sweep_images};
  for (const SweepPicture& picture : pictures) read.push_back(picture.file);
  if (camera.sweep_marker.picture) read.push_back(*camera.sweep_marker.picture);
  const auto inputs = session.inputs(settings_of(camera), read);
  if (session.folder.up_to_date("sweep", inputs) || session.copied_from_parent("sweep", inputs)) return file;
  session.do_stage("sweep", inputs, {"sweep.csv", sheet},
                   [&](const fs::path& dir) { make_sweep(session, pictures, dir / "sweep.csv", dir / sheet); });
  return file;
}

}  // namespace misfit
