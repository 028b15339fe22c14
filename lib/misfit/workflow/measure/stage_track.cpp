#include <algorithm>

#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/video/check_video.h"
#include "misfit/workflow/measure/film_channels.h"
#include "misfit/workflow/measure/measure.h"
#include "misfit/workflow/measure/track_video.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::string settings_of(const VideoStudy& video) {
  std::string text = video.fields + (video.check_fields ? " checked " : " insisted ") + video.marker.kind;
  if (video.start) text += " start " + std::to_string(video.start->column) + " " + std::to_string(video.start->row);
  if (video.region)
    for (double v : *video.region) text += " " + std::to_string(v);
  return text;
}

void make_track(Session& session, std::size_t e, const TrackFiles& files) {
  const VideoTrack result = track_video(*session.study.experiments[e].video, session.study.video, session.progress("track"));
  write_track(files.track, result.track);
  write_track_facts(files.facts, result.facts);
  make_writable_folder(files.sheet.parent_path());
  write_contact_sheet(files.sheet, result.shots);
}

/// What the track stage writes into DIR.
TrackFiles made_files(const fs::path& dir, const std::string& end) {
  return {dir / ("track" + end + ".csv"), dir / ("track" + end + ".json"), dir / ("figures/contact_sheet" + end + ".png")};
}

}  // namespace

bool has_track(const ExperimentStudy& experiment) { return experiment.track || experiment.video; }

bool has_attitude(const Session& session, const ExperimentStudy& experiment) {
  return has_track(experiment) && !reads_film(session, experiment);
}

TrackFiles track_files(const Session& session, std::size_t e) {
  const ExperimentStudy& experiment = session.study.experiments[e];
  if (experiment.track) return {*experiment.track, {}, {}};
  return made_files(session.folder.path(), file_suffix(e, session.study.experiments[e].name));
}

std::vector<std::optional<TrackFacts>> track_stage(Session& session) {
  std::vector<std::optional<TrackFacts>> out;
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (!experiment.video) {
      out.emplace_back();
      continue;
    }
    stop_if_interrupted();
    const TrackFiles files = track_files(session, e);
    std::vector<fs::path> read{*experiment.video};
    if (session.study.video.marker.picture) read.push_back(*session.study.video.marker.picture);
    const auto inputs = session.inputs(settings_of(session.study.video), read);
    const std::string stage = "track/" + experiment.name;
    if (!session.folder.up_to_date(stage, inputs) && !session.copied_from_parent(stage, inputs)) {
      const std::string end = file_suffix(e, session.study.experiments[e].name);
      session.do_stage(stage, inputs, {"track" + end + ".csv", "track" + end + ".json"},
                       [&](const fs::path& dir) { make_track(session, e, made_files(dir, end)); });
    }
    out.emplace_back(read_track_facts(files.facts));
  }
  return out;
}

WriteRules write_rules(const Session& session) { return {files_of_study(session.study), session.options.force}; }

void write_check_video(const Session& session, const std::vector<std::optional<TrackFacts>>& facts, const fs::path& to) {
  const auto tracked = std::find_if(facts.begin(), facts.end(), [](const auto& f) { return f.has_value(); });
  const std::size_t e = tracked - facts.begin();
  const TrackFacts& f = **tracked;
  const Track track = read_track(track_files(session, e).track);
  write_files(to.has_parent_path() ? to.parent_path() : ".", write_rules(session), {to.filename().string()}, [&](const fs::path& dir) {
    const FieldsOfFrame fields{f.fields == "progressive" ? 1 : 2, f.fields == "bottom_first" ? 1 : 0};
    write_check_video({*session.study.experiments[e].video, track, fields, std::max(f.outer, 8.0)}, dir / to.filename(),
                      session.progress("check video"));
  });
}

}  // namespace misfit
