#include <algorithm>
#include <iostream>

#include "apps/print.h"
#include "apps/stages.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/core/progress.h"
#include "misfit/video/check_video.h"

namespace misfit {
namespace {

WriteRules rules_of(const Session& session) { return {files_of_study(session.study), session.options.force}; }

/// The first experiment with a video, with its track drawn on it.
void check_video(const Session& session, const std::vector<std::optional<TrackFacts>>& facts) {
  const auto first =
      static_cast<std::size_t>(std::find_if(facts.begin(), facts.end(), [](const auto& f) { return f.has_value(); }) - facts.begin());
  const TrackFacts& f = *facts[first];
  const Track track = read_track(track_files(session, first).track);
  const std::filesystem::path to = session.options.check_video;
  write_files(to.has_parent_path() ? to.parent_path() : ".", rules_of(session), {to.filename().string()},
              [&](const std::filesystem::path& dir) {
                Progress progress("check video", session.options.quiet);
                write_check_video(*session.study.experiments[first].video, dir / to.filename(), track, f.fields == "progressive" ? 1 : 2,
                                  f.fields == "bottom_first" ? 1 : 0, std::max(f.outer, 8.0),
                                  [&](std::size_t done, std::size_t total) { progress.update(done, total); });
              });
}

}  // namespace

int track_verb(const Options& options, const Registry& registry) {
  Session session(options, registry);
  if (!options.check_video.empty()) check_place(options.check_video, rules_of(session));
  const auto facts = track_stage(session);
  if (std::none_of(facts.begin(), facts.end(), [](const auto& f) { return f.has_value(); }))
    throw InputError({session.study.file.string(), 0, 0}, "no experiment of the study has a video: there is nothing to track");
  if (!options.check_video.empty()) check_video(session, facts);
  for (std::size_t e = 0; e < facts.size(); ++e) {
    if (!facts[e]) continue;
    const TrackFiles files = track_files(session, e);
    if (options.json) {
      print_file(files.facts);
    } else {
      print(session.study.experiments[e].name, *facts[e]);
      std::cout << "  " << files.track.string() << "\n  " << files.sheet.string() << '\n';
    }
  }
  return 0;
}

}  // namespace misfit
