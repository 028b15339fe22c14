#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int report_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const std::vector<Fit> fits = fit_stage(session);
  const std::string page = report_stage(session, fits).string();
  if (options.json) {
    std::cout << nlohmann::json{{"report", page}}.dump(1) << '\n';
  } else {
    print_verdict(verdict_of(session, fits), page);
  }
  return 0;
}

}  // namespace misfit
