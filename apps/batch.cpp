#include "misfit/workflow/batch.h"

#include <algorithm>
#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"

namespace misfit {
namespace {

int status_of(const Batch& batch) {
  const bool any = std::any_of(batch.rows.begin(), batch.rows.end(),
                               [](const BatchRow& row) { return row.status == "converged" || row.status == "not_converged"; });
  return any ? 0 : 1;
}

}  // namespace

int batch_verb(const Options& options, const Registry& registry) {
  const auto fitted = fit_batch(options.session, options.studies, registry);
  if (!fitted) return 0;
  if (options.json) {
    print_file(fitted->folder / "batch.json");
  } else {
    print(fitted->batch);
    std::cout << "results: " << fitted->folder.string() << '\n';
  }
  return status_of(fitted->batch);
}

}  // namespace misfit
