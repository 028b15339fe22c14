#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int attitude_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const auto attitudes = attitude_stage(session);
  bool any = false;
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (std::size_t e = 0; e < attitudes.size(); ++e) {
    if (attitudes[e] && !options.json) print(session.study.experiments[e].name, *attitudes[e]);
    if (attitudes[e]) all[session.study.experiments[e].name] = {{"samples", attitudes[e]->t.size()}, {"notes", attitudes[e]->notes}};
    any = any || attitudes[e].has_value();
  }
  if (!any)
    throw InputError({session.study.file.string(), 0, 0}, "no experiment of the study has a track: there is no attitude to extract");
  if (options.json) std::cout << all.dump(1) << '\n';
  return 0;
}

}  // namespace misfit
