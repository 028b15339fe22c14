#include "misfit/core/error.h"
#include "misfit/discover/discover.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/job_queue.h"
#include "misfit/jobs/ranks.h"
#include "misfit/workflow/assess/assess.h"

namespace misfit {
namespace {

constexpr const char* refits = "discover_refits";

/// The search itself; `only`: of one effect, without refits.
Discovery search(Session& session, const std::string& only) {
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const auto work = filter_work(session);
  DiscoverOptions options;
  options.threads = session.options.threads;
  options.calibration = calibration ? &*calibration : nullptr;
  options.only = only;
  options.progress = session.progress("discover");
  if (only.empty()) options.refits = {session.folder.file(refits), digest_of(inputs_of_discovery(session)), 0, session.options.threads};
  options.stop = &interrupted();
  constexpr double refits_of_a_round = 20.0;
  options.refit_limit = session.asked_limit().value_or(usual_limit(session.options, work->fit.seconds));
  options.round_limit = session.round_limit().value_or(refits_of_a_round * options.refit_limit);
  const Watch watch("discover", 0.0, session.options.listener.hearer("discover"));
  try {
    return discover(*work->estimate, work->prepared.request, session.registry, work->prepared.experiments, options);
  } catch (const RunError&) {
    stop_if_interrupted();
    throw;
  }
}

}  // namespace

std::optional<Candidate> predict_effect(Session& session, const std::string& effect) {
  if (filter_declined(session)) refuse_declined(session);
  stop_if_interrupted();
  const auto known = known_discovery(session);
  const Discovery discovery = known ? *known : search(session, effect);
  for (const auto& candidate : discovery.candidates) {
    if (candidate.effect == effect) return candidate;
  }
  return std::nullopt;
}

std::optional<Discovery> discover_stage(Session& session) {
  if (filter_declined(session)) return std::nullopt;
  stop_if_interrupted();
  if (auto known = known_discovery(session)) return known;
  if (!ranks().first()) return search(session, "");
  session.do_stage("discover", inputs_of_discovery(session), {"candidates.json", "discovery.json"},
                   [&](const std::filesystem::path& dir) { write_discovery(dir, search(session, "")); });
  remove_stored_jobs(session.folder.file(refits));  // megabytes each, and all said
  return read_discovery(session.folder.path());
}

Discovery discovered(Session& session) {
  const std::optional<Discovery> discovery = discover_stage(session);
  if (!discovery) refuse_declined(session);
  return *discovery;
}

}  // namespace misfit
