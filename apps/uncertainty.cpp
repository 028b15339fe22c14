#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/jobs/ranks.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int uncertainty_verb(const Options& options, const Registry& registry) {
  // What the runs start from is written by one rank only; the others find it done.
  on_first_rank([&] {
    Session session(options.session, registry);
    attitude_stage(session);
    if (asks_for_resampling(session.study)) check_profile_names(session);
  });
  Session session(options.session, registry);
  // Bootstrap and profiles alone need no perturbed rig.
  const bool resampling = asks_for_resampling(session.study);
  const bool perturbs_rig = !resampling || !session.study.uncertainty->perturb.empty();
  Uncertainty result;
  if (perturbs_rig) result = uncertainty_stage(session);
  Resampling again;
  if (resampling) again = resampling_stage(session);
  if (!ranks().first()) return 0;
  if (options.json) {
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    for (const auto& [there, name] : {std::pair{perturbs_rig, "uncertainty"},
                                      {!again.bootstraps.empty(), "bootstrap"},
                                      {!again.profiles.empty(), "profile"},
                                      {!again.starts.empty(), "starts"}}) {
      if (there) files.emplace_back(name, session.folder.file(name + std::string(".json")));
    }
    print_files(files);
  } else {
    if (perturbs_rig) print(result);
    print(again);
  }
  return 0;
}

}  // namespace misfit
