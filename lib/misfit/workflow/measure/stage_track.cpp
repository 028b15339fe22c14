#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/video/check_video.h"
#include "misfit/workflow/measure/film_channels.h"
#include "misfit/workflow/measure/measure.h"
#include "misfit/workflow/measure/plane_calibration.h"
#include "misfit/workflow/measure/track_video.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Of the map from pixels to metres that track.json holds.
std::string settings_of_plane(const VideoStudy& video) {
  if (!video.has_plane()) return "";
  std::string text = " plane " + video.aruco.dictionary;
  if (video.chessboard) text += fmt::format(" board {} {} {}", video.chessboard->columns, video.chessboard->rows, video.chessboard->square);
  if (video.aruco.plane) text += fmt::format(" tag {} {}", *video.aruco.plane, video.aruco.side.value_or(0.0));
  if (video.origin) text += fmt::format(" origin {} {}", video.origin->column, video.origin->row);
  for (const KnownPoint& p : video.points) {
    text += fmt::format(" point {} {} {}", p.name, p.x, p.y);
    text += p.tag ? fmt::format(" tag {}", *p.tag) : fmt::format(" at {} {}", p.at->column, p.at->row);
  }
  return text;
}

std::string settings_of(const VideoStudy& video) {
  std::string text = video.fields + (video.check_fields ? " checked " : " insisted ") + video.marker.kind;
  if (video.start) text += " start " + std::to_string(video.start->column) + " " + std::to_string(video.start->row);
  if (video.region)
    for (double v : *video.region) text += " " + std::to_string(v);
  if (video.marker.id) text += fmt::format(" id {} of {}", *video.marker.id, video.aruco.dictionary);
  return text + settings_of_plane(video);
}

void make_track(Session& session, const fs::path& film, const VideoStudy& video, const TrackFiles& files) {
  VideoTrack result = track_video(film, video, session.progress("track"));
  result.facts.plane = calibrate_plane(film, video, result.track);
  write_track(files.track, result.track);
  write_track_facts(files.facts, result.facts);
  make_writable_folder(files.sheet.parent_path());
  write_contact_sheet(files.sheet, result.shots);
}

/// What the track stage writes into DIR.
TrackFiles made_files(const fs::path& dir, const std::string& end) {
  return {dir / ("track" + end + ".csv"), dir / ("track" + end + ".json"), dir / ("figures/contact_sheet" + end + ".png")};
}

/// Behind the stem of a file: of the experiment, then of the marker.
std::vector<std::string> ends_of(const Session& session, std::size_t e) {
  const std::string experiment = file_suffix(e, session.study.experiments[e].name);
  std::vector<std::string> out;
  for (const NamedMarker& marker : session.study.video.markers) out.push_back(experiment + "-" + marker.name);
  if (out.empty()) out.push_back(experiment);
  return out;
}

/// [video] as if the marker were the only one.
VideoStudy video_of(const VideoStudy& video, std::size_t marker) {
  VideoStudy out = video;
  if (video.markers.empty()) return out;
  const NamedMarker& one = video.markers[marker];
  out.marker = one.marker;
  out.start = one.start;
  out.region = one.region;
  out.markers.clear();
  return out;
}

TrackedMarker track_marker(Session& session, std::size_t e, std::size_t marker) {
  const ExperimentStudy& experiment = session.study.experiments[e];
  const VideoStudy video = video_of(session.study.video, marker);
  const std::vector<NamedMarker>& several = session.study.video.markers;
  std::vector<fs::path> read{*experiment.video};
  if (video.marker.picture) read.push_back(*video.marker.picture);
  const auto inputs = session.inputs(settings_of(video), read);
  const std::string stage = "track/" + experiment.name + (several.empty() ? "" : "/" + several[marker].name);
  if (!session.folder.up_to_date(stage, inputs) && !session.copied_from_parent(stage, inputs)) {
    const std::string end = ends_of(session, e)[marker];
    session.do_stage(stage, inputs, {"track" + end + ".csv", "track" + end + ".json"},
                     [&](const fs::path& dir) { make_track(session, *experiment.video, video, made_files(dir, end)); });
  }
  const TrackFiles files = files_of_tracks(session, e)[marker];
  return {e, experiment.name + (several.empty() ? "" : ", " + several[marker].name), files, read_track_facts(files.facts)};
}

}  // namespace

bool has_track(const ExperimentStudy& experiment) { return experiment.track || experiment.video; }

bool has_attitude(const Session& session, const ExperimentStudy& experiment) {
  return has_track(experiment) && !reads_film(session, experiment);
}

std::vector<TrackFiles> files_of_tracks(const Session& session, std::size_t e) {
  const ExperimentStudy& experiment = session.study.experiments[e];
  if (experiment.track) return {{*experiment.track, {}, {}}};
  std::vector<TrackFiles> out;
  for (const std::string& end : ends_of(session, e)) out.push_back(made_files(session.folder.path(), end));
  return out;
}

TrackFiles track_files(const Session& session, std::size_t e) { return files_of_tracks(session, e).front(); }

std::vector<TrackedMarker> track_stage(Session& session) {
  std::vector<TrackedMarker> out;
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    if (!session.study.experiments[e].video) continue;
    const std::size_t markers = std::max<std::size_t>(session.study.video.markers.size(), 1);
    for (std::size_t marker = 0; marker < markers; ++marker) {
      stop_if_interrupted();
      out.push_back(track_marker(session, e, marker));
    }
  }
  return out;
}

WriteRules write_rules(const Session& session) { return {files_of_study(session.study), session.options.force}; }

void write_check_video(const Session& session, const TrackedMarker& tracked, const fs::path& to) {
  const TrackFacts& f = tracked.facts;
  const Track track = read_track(tracked.files.track);
  write_files(to.has_parent_path() ? to.parent_path() : ".", write_rules(session), {to.filename().string()}, [&](const fs::path& dir) {
    const FieldsOfFrame fields{f.fields == "progressive" ? 1 : 2, f.fields == "bottom_first" ? 1 : 0};
    write_check_video({*session.study.experiments[tracked.experiment].video, track, fields, std::max(f.outer, 8.0)}, dir / to.filename(),
                      session.progress("check video"));
  });
}

}  // namespace misfit
