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
    print_file(session.folder.file(perturbs_rig                ? "uncertainty.json"
                                   : !again.bootstraps.empty() ? "bootstrap.json"
                                   : !again.profiles.empty()   ? "profile.json"
                                                               : "starts.json"));
  } else {
    if (perturbs_rig) print(result);
    print(again);
  }
  return 0;
}

}  // namespace misfit
