#include "misfit/compare/compare.h"

#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int compare_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const Comparison comparison = compare_stage(session, fit_stage(session));
  if (options.json) {
    print_file(session.folder.file("compare.json"));
  } else {
    print(comparison);
  }
  return 0;
}

}  // namespace misfit
