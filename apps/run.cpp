#include <algorithm>
#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/compare/compare.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/shown.h"
#include "misfit/data/estimators.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

/// What a run prints while it goes on: a line per stage, or its tables; nothing where JSON is asked for.
class StageLines {
 public:
  StageLines(const Options& options, const Study& study) : silent_(options.json), tables_(options.verbose) {
    heading_.heading(study.name);
    heading_.paragraph(study.question);
  }

  template <class Result>
  void result(const std::string& stage, const Result& result) {
    if (silent_) return;
    head();
    tables_ ? print(result) : print_stage(stage, line_of(result));
  }
  template <class Result>
  void result(const std::string& stage, const std::string& experiment, const Result& result) {
    if (silent_) return;
    head();
    tables_ ? print(experiment, result) : print_stage(stage, line_of(result));
  }
  /// Name and question of the study, before the first result.
  void head() {
    if (!headed_) print(heading_);
    headed_ = true;
  }

 private:
  bool silent_, tables_, headed_ = false;
  Blocks heading_;
};

/// "track", or with several experiments "track of flight".
std::string stage_of(const char* stage, const Study& study, std::size_t experiment) {
  return study.experiments.size() > 1 ? stage + std::string(" of ") + study.experiments[experiment].name : stage;
}

template <class Results>
void show_stage(StageLines& lines, const char* stage, const Study& study, const Results& results) {
  for (std::size_t e = 0; e < results.size(); ++e) {
    if (results[e]) lines.result(stage_of(stage, study, e), study.experiments[e].name, *results[e]);
  }
}

std::vector<Fit> fits_shown(Session& session, StageLines& lines, const std::vector<std::string>& methods) {
  session.options.listener.fitted = [&lines](const Fit& fit) { lines.result(fit.method, std::vector<Fit>{fit}); };
  std::vector<Fit> fits = fit_stage(session, methods);
  session.options.listener.fitted = {};
  return fits;
}

const Fit* filter_among(const std::vector<Fit>& fits) {
  const auto found = std::find_if(fits.begin(), fits.end(), [](const Fit& fit) { return fit.method == random_force_estimator().name; });
  return found == fits.end() ? nullptr : &*found;
}

/// Can the model be searched? A search that is asked for makes the filter's fit where the study does not name it.
bool can_search(Session& session, StageLines& lines, const std::vector<Fit>& fits, bool asked) {
  const Fit* filter = filter_among(fits);
  if (filter != nullptr || !asked) return filter != nullptr && filter->usable();
  return fits_shown(session, lines, {random_force_estimator().name}).front().usable();
}

}  // namespace

int run_verb(const Options& options, const Registry& registry) {
  ModelLadder ladder(options.session, registry);
  Session& session = ladder.root();
  StageLines lines(options, session.study);
  for (const TrackedMarker& marker : track_stage(session)) {
    const std::string stage =
        session.study.video.markers.empty() ? stage_of("track", session.study, marker.experiment) : "track " + marker.name;
    lines.result(stage, marker.name, marker.facts);
  }
  if (const auto calibration = calibrate_stage(session)) lines.result("calibrate", *calibration);
  show_stage(lines, "attitude", session.study, attitude_stage(session));
  const std::vector<Fit> fits = fits_shown(session, lines, session.methods());
  lines.result("compare", compare_stage(session, fits));
  const bool search = can_search(session, lines, fits, options.automatic);
  if (const auto diagnosis = search ? diagnose_stage(session) : std::nullopt) lines.result("diagnose", *diagnosis);
  if (search && options.automatic) {
    if (!options.json) lines.head();
    extend_ladder(ladder, registry, ladder_listener(ladder, options));
    diagnose_rungs(ladder);
  } else if (const auto discovery = search ? discover_stage(session) : std::nullopt) {
    lines.result("discover", *discovery);
  }
  if (const auto known = known_ladder(session)) lines.result("ladder", *known);
  const auto page = report_stage(session, fits);
  if (options.json) {
    print_file(session.folder.file("compare.json"));
    return status_of(fits);
  }
  print_verdict(verdict_of(session, fits), page);
  if (session.study.uncertainty && !known_uncertainty(session) && !known_resampling(session))
    std::cout << "  [uncertainty] is not part of `run`; start it with: "
              << printable(misfit_command("uncertainty", options.session.study, "", options.session.out)) << '\n';
  return status_of(fits);
}

}  // namespace misfit
