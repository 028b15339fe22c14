#include <algorithm>
#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/compare/compare.h"
#include "misfit/data/estimators.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int run_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const auto videos = track_stage(session);
  const auto calibration = calibrate_stage(session);
  const auto attitudes = attitude_stage(session);
  const std::vector<Fit> fits = fit_stage(session);
  const Comparison comparison = compare_stage(session, fits);
  const bool filtered = std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.method == random_force_estimator().name; });
  const auto diagnosis = filtered ? diagnose_stage(session) : std::nullopt;
  const auto discovery = filtered ? discover_stage(session) : std::nullopt;
  const auto page = report_stage(session, fits);
  if (options.json) {
    print_file(session.folder.file("compare.json"));
    return status_of(fits);
  }
  std::cout << session.study.name << '\n' << session.study.question << "\n\n";
  for (std::size_t e = 0; e < videos.size(); ++e) {
    if (videos[e]) print(session.study.experiments[e].name, *videos[e]);
  }
  if (calibration) print(*calibration);
  for (std::size_t e = 0; e < attitudes.size(); ++e) {
    if (attitudes[e]) print(session.study.experiments[e].name, *attitudes[e]);
  }
  print(fits);
  print(comparison);
  if (diagnosis) print(*diagnosis);
  if (discovery) print(*discovery);
  if (const auto ladder = known_ladder(session)) print(*ladder);
  std::cout << "report: " << page.string() << '\n';
  if (session.study.uncertainty && !known_uncertainty(session) && !known_resampling(session))
    std::cout << "[uncertainty] is not part of `run`; start it with: misfit uncertainty " << options.session.study << '\n';
  return status_of(fits);
}

}  // namespace misfit
