#include <algorithm>

#include "misfit/compare/compare.h"
#include "misfit/data/estimators.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/stages.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Only the fit with a random force can make motion like the measured one: without it motion dies away.
bool can_be_simulated(const std::vector<Fit>& fits) {
  return std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.method == random_force_estimator().name && fit.usable(); });
}

}  // namespace

std::vector<fs::path> files_of_fits(const Session& session, const std::vector<Fit>& fits) {
  std::vector<fs::path> files;
  for (const auto& fit : fits) {
    const std::vector<fs::path> own = session.files_of_stage("fit/" + fit.method);
    files.insert(files.end(), own.begin(), own.end());
  }
  return files;
}

std::vector<Reference> references(const Session& session) {
  std::vector<Reference> out;
  const ModelRequest& request = session.model.request;
  const SystemSpec spec = session.registry.system(request.system).make(request.options)->spec();
  for (const auto& [curve, file] : session.study.reference)
    out.push_back(read_reference(file, curve, spec.static_curve, spec.folded_angle));
  return out;
}

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
