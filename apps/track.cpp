#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int track_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  if (!options.check_video.empty()) check_place(options.check_video, write_rules(session));
  const std::vector<TrackedMarker> tracked = track_stage(session);
  if (tracked.empty())
    throw InputError({session.study.file.string(), 0, 0}, "no experiment of the study has a video: there is nothing to track");
  if (!options.check_video.empty()) write_check_video(session, tracked.front(), options.check_video);
  if (options.json) {
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    for (const TrackedMarker& marker : tracked) files.emplace_back(marker.name, marker.files.facts);
    print_files(files);
    return 0;
  }
  for (const TrackedMarker& marker : tracked) {
    print(marker.name, marker.facts);
    std::cout << "  " << marker.files.track.string() << "\n  " << marker.files.sheet.string() << '\n';
  }
  return 0;
}

}  // namespace misfit
