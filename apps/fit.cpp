#include <iostream>

#include "apps/print.h"
#include "apps/stages.h"
#include "apps/verbs.h"

namespace misfit {

int fit_verb(const Options& options, const Registry& registry) {
  Session session(options, registry);
  const std::vector<Fit> fits = fit_stage(session);
  if (options.json) {
    for (const auto& fit : fits) print_file(session.folder.file("fit/" + fit.method + "/fit.json"));
  } else {
    std::cout << fits_text(fits);
  }
  return status_of(fits);
}

}  // namespace misfit
