#include <fmt/format.h>

#include "misfit/attitude/attitude.h"
#include "misfit/calibrate/calibrate.h"
#include "misfit/calibrate/camera_from_study.h"
#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/measure/measure.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

CameraModel model_of(const CameraStudy& camera) {
  return camera.model == "plane_by_plane" ? CameraModel::plane_by_plane : CameraModel::pinhole;
}

std::string settings_of(const Session& session) {
  const RigGeometry& rig = session.model.rig;
  std::string text = session.study.camera.model;
  for (double v : {rig.R, rig.R_cp, rig.V, rig.l_b, rig.l_s, rig.l_p, rig.R1, rig.R2, rig.R3}) text += fmt::format(" {}", v);
  for (const auto& name : session.study.camera.offer) text += " offer " + name;
  for (const auto& name : session.study.camera.free) text += " free " + name;
  for (const auto& [name, number] : session.study.camera.given)
    text += fmt::format(" {}={}~{}", name, number.value, number.sigma.value_or(0.0));
  return text;
}

Calibration make_calibration(const Session& session, const fs::path& sweep) {
  const CameraStudy& camera = session.study.camera;
  if (!camera.from_sweep()) return camera_from_study(model_of(camera), camera.given);
  require_rig(session.study, session.model.rig, true);
  CalibrateOptions options;
  options.model = model_of(camera);
  options.candidates = camera.offer;
  options.force = camera.free;
  return calibrate(read_sweep(sweep), session.model.rig, options);
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> lines;
  if (!fs::exists(path)) return lines;
  const std::string text = read_file(path);
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    if (to > from) lines.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return lines;
}

void write_notes(const fs::path& path, const std::vector<std::string>& notes) {
  std::string text;
  for (const auto& note : notes) text += note + "\n";
  write_atomically(path, text);
}

}  // namespace

std::optional<Calibration> calibrate_stage(Session& session) {
  stop_if_interrupted();
  if (!session.study.has_camera) return std::nullopt;
  const fs::path file = session.folder.file("camera.json");
  std::vector<fs::path> files;
  if (session.study.camera.from_sweep()) files.push_back(sweep_stage(session));
  const auto inputs = session.inputs(settings_of(session), files);
  session.do_stage("calibrate", inputs, {"camera.json"}, [&](const fs::path& dir) {
    write_calibration(dir / "camera.json", make_calibration(session, files.empty() ? fs::path() : files.front()));
  });
  return read_calibration(file);
}

fs::path attitude_file(const Session& session, std::size_t e) {
  return session.folder.file("attitude" + file_suffix(e, session.study.experiments[e].name) + ".csv");
}

std::vector<fs::path> files_of_attitude(const Session& session) {
  std::vector<fs::path> files;
  if (session.study.has_camera) files.push_back(session.folder.file("camera.json"));
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (has_track(experiment)) {
      for (const TrackFiles& track : files_of_tracks(session, e)) files.push_back(track.track);
    }
    if (has_attitude(session, experiment)) files.push_back(attitude_file(session, e));
  }
  return files;
}

std::vector<std::optional<Attitude>> attitude_stage(Session& session) {
  std::vector<std::optional<Attitude>> out;
  const std::vector<TrackedMarker> tracked = track_stage(session);
  const std::optional<Calibration> calibration = calibrate_stage(session);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    stop_if_interrupted();
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (!has_attitude(session, experiment)) {
      out.emplace_back();
      continue;
    }
    if (!calibration) {
      throw InputError(experiment.where,
                       "experiment '" + experiment.name + "' is a track in pixels: the study needs [camera] (sweep = \"…\", or h_c and K)" +
                           std::string(!experiment.video ? ""
                                                         : ", or the system outputs called " +
                                                               join_words(film_channels(session.study.video.marker_names())) +
                                                               " (column and row in the film, or metres)"));
    }
    require_rig(session.study, session.model.rig, false);
    const fs::path file = attitude_file(session, e), notes = fs::path(file).replace_extension(".notes.txt");
    std::string settings = settings_of(session);
    for (const auto& [name, header] : experiment.columns.header_of) settings += fmt::format("\ncolumn {}={}", name, header);
    const auto inputs = session.inputs(settings, {track_files(session, e).track, session.folder.file("camera.json")});
    const std::string angles_name = file.filename().string(), notes_name = notes.filename().string();
    session.do_stage("attitude/" + experiment.name, inputs, {angles_name, notes_name}, [&](const fs::path& dir) {
      const Track track = read_track(track_files(session, e).track, experiment.columns);
      Attitude result = attitude(track, *calibration, session.model.rig);
      for (const TrackedMarker& marker : tracked) {
        const std::vector<std::string>& warnings = marker.facts.warnings;
        if (marker.experiment == e) result.notes.insert(result.notes.begin(), warnings.begin(), warnings.end());
      }
      result.notes.insert(result.notes.begin(), track.notes.begin(), track.notes.end());
      write_attitude(dir / angles_name, result);
      write_notes(dir / notes_name, result.notes);
    });
    out.emplace_back(read_attitude(file));
    out.back()->notes = lines_of(notes);
  }
  return out;
}

}  // namespace misfit
