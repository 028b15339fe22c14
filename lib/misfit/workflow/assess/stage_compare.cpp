#include <algorithm>

#include "misfit/compare/compare.h"
#include "misfit/data/estimators.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/assess/assess.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Only the fit with a random force can make motion like the measured one: without it motion dies away.
bool can_be_simulated(const std::vector<Fit>& fits) {
  return std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.method == random_force_estimator().name && fit.usable(); });
}

}  // namespace

Comparison compare_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  const fs::path file = session.folder.file("compare.json");
  std::vector<fs::path> files = files_of_fits(session, fits);
  for (const auto& [curve, reference] : session.study.reference) files.push_back(reference);
  const auto inputs = session.inputs("seed " + std::to_string(session.study.seed), files);
  session.do_stage("compare", inputs, {"compare.json"}, [&](const fs::path& dir) {
    Comparison comparison = compare(fits, references(session));
    if (can_be_simulated(fits)) {
      const auto work = filter_work(session);
      comparison.motion = simulated_motion(*work, session.study.seed, session.options.threads, session.progress("compare"));
    }
    write_comparison(dir / "compare.json", comparison);
  });
  return read_comparison(file);
}

}  // namespace misfit
