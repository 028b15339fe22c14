#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/track_facts.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

// From videos and pictures to angles.

/// Is there a track of the experiment, given or made from its video?
[[nodiscard]] bool has_track(const ExperimentStudy& experiment);
/// Is its track read as angles, through a camera? Not where the system's outputs are places in the film (film_channels.h).
[[nodiscard]] bool has_attitude(const Session& session, const ExperimentStudy& experiment);
/// Where it is: the study's own file, or what the track stage writes to the run folder (then with facts and contact sheet).
struct TrackFiles {
  std::filesystem::path track, facts, sheet;
};
[[nodiscard]] TrackFiles track_files(const Session& session, std::size_t experiment);
/// The same, one per marker that is followed in its film, in the order of VideoStudy::markers.
[[nodiscard]] std::vector<TrackFiles> files_of_tracks(const Session& session, std::size_t experiment);

/// One marker followed through the video of an experiment.
struct TrackedMarker {
  std::size_t experiment = 0;
  std::string name;  ///< of the experiment; of several markers "EXPERIMENT, MARKER"
  TrackFiles files;
  TrackFacts facts;
};
/// track.csv, track.json and figures/contact_sheet.png of every marker in every experiment that starts from a video: track_EXPERIMENT… for
/// further experiments, track-MARKER… or track_EXPERIMENT-MARKER… of several markers.
[[nodiscard]] std::vector<TrackedMarker> track_stage(Session& session);
/// A video with the track of a marker drawn on it, to the file `to`. WriteError: write_rules().
void write_check_video(const Session& session, const TrackedMarker& tracked, const std::filesystem::path& to);
/// Files that are never written over.
[[nodiscard]] WriteRules write_rules(const Session& session);
/// The table of the sweep: the study's own, or sweep.csv made from its pictures (with figures/sweep_sheet.png).
[[nodiscard]] std::filesystem::path sweep_stage(Session& session);
/// camera.json; nullopt if the study has no camera.
[[nodiscard]] std::optional<Calibration> calibrate_stage(Session& session);
/// attitude.csv (attitude_NAME.csv for further experiments); empty for experiments without a track.
std::vector<std::optional<Attitude>> attitude_stage(Session& session);
/// attitude.csv or, of further experiments, attitude_NAME.csv.
[[nodiscard]] std::filesystem::path attitude_file(const Session& session, std::size_t experiment);
/// camera.json, and of every experiment that starts from pixels the track and the attitude.
[[nodiscard]] std::vector<std::filesystem::path> files_of_attitude(const Session& session);

}  // namespace misfit
