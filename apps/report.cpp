#include <iostream>

#include "apps/stages.h"
#include "apps/verbs.h"

namespace misfit {

int report_verb(const Options& options, const Registry& registry) {
  Session session(options, registry);
  std::cout << report_stage(session, fit_stage(session)).string() << '\n';
  return 0;
}

}  // namespace misfit
