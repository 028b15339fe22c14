#include <iostream>

#include "apps/print.h"
#include "apps/stages.h"
#include "apps/verbs.h"
#include "misfit/core/ranks.h"

namespace misfit {

int uncertainty_verb(const Options& options, const Registry& registry) {
  Options own = options;
  own.quiet = options.quiet || !ranks().first();
  // What the runs start from is written by one rank only; the others find it done.
  on_first_rank([&] {
    Session session(own, registry);
    static_cast<void>(attitude_stage(session));
  });
  Session session(own, registry);
  const Uncertainty result = uncertainty_stage(session);
  if (!ranks().first()) return 0;
  if (options.json) {
    print_file(session.folder.file("uncertainty.json"));
  } else {
    std::cout << uncertainty_text(result);
  }
  return 0;
}

}  // namespace misfit
