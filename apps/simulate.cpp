#include "misfit/workflow/simulate.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/verbs.h"

namespace misfit {

int simulate_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const SimulatedRecord made = simulate_stage(session);
  if (options.json) {
    std::cout << nlohmann::json{{"file", made.file.string()}, {"samples", made.table.rows()}, {"system", made.system}}.dump(1) << '\n';
    return 0;
  }
  const std::vector<double>& t = made.table.columns.front().values;
  std::cout << fmt::format("{} samples, {:.2f} s of {} → {}\n", made.table.rows(), t.back() - t.front(), made.system, made.file.string());
  return 0;
}

}  // namespace misfit
