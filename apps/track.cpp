#include <algorithm>
#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int track_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  if (!options.check_video.empty()) check_place(options.check_video, write_rules(session));
  const auto facts = track_stage(session);
  if (std::none_of(facts.begin(), facts.end(), [](const auto& f) { return f.has_value(); }))
    throw InputError({session.study.file.string(), 0, 0}, "no experiment of the study has a video: there is nothing to track");
  if (!options.check_video.empty()) write_check_video(session, facts, options.check_video);
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
