#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/files.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int fit_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const std::vector<Fit> fits = fit_stage(session);
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::object();  // method → its fit.json
    for (const auto& fit : fits)
      all[fit.method] = nlohmann::ordered_json::parse(read_file(session.folder.file("fit/" + fit.method + "/fit.json")));
    std::cout << all.dump(1) << '\n';
  } else {
    print(fits);
  }
  return status_of(fits);
}

}  // namespace misfit
