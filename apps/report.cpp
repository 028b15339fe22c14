#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/verbs.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int report_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const std::string page = report_stage(session, fit_stage(session)).string();
  std::cout << (options.json ? nlohmann::json{{"report", page}}.dump(1) : page) << '\n';
  return 0;
}

}  // namespace misfit
