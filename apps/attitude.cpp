#include <iostream>

#include "apps/print.h"
#include "apps/stages.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"

namespace misfit {

int attitude_verb(const Options& options, const Registry& registry) {
  Session session(options, registry);
  const auto attitudes = attitude_stage(session);
  bool any = false;
  for (std::size_t e = 0; e < attitudes.size(); ++e) {
    if (attitudes[e]) std::cout << attitude_text(session.study.experiments[e].name, *attitudes[e]);
    any = any || attitudes[e].has_value();
  }
  if (!any)
    throw InputError({session.study.file.string(), 0, 0}, "no experiment of the study has a track: there is no attitude to extract");
  return 0;
}

}  // namespace misfit
