#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int diagnose_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const std::optional<Diagnosis> diagnosis = diagnose_stage(session);
  if (!diagnosis) refuse_declined(session);
  if (options.json) {
    print_file(session.folder.file("diagnosis.json"));
  } else {
    print(*diagnosis);
  }
  return 0;
}

}  // namespace misfit
