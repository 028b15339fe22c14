#include <chrono>

#include "apps/stages.h"
#include "misfit/core/error.h"
#include "misfit/core/progress.h"
#include "misfit/core/ranks.h"
#include "misfit/discover/discover.h"

namespace misfit {
namespace {

constexpr const char* refits = "discover_refits";

/// The search itself, with its progress on a terminal; `only`: of one effect, without refits.
Discovery search(Session& session, const std::string& only) {
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const auto work = filter_work(session);
  Progress progress("discover", session.options.quiet);
  DiscoverOptions options;
  options.threads = session.options.threads;
  options.calibration = calibration ? &*calibration : nullptr;
  options.only = only;
  options.progress = [&](std::size_t done, std::size_t total) { progress.update(done, total); };
  if (only.empty()) options.refits = {session.folder.file(refits), digest_of(inputs_of_discovery(session)), 0, session.options.threads};
  options.stop = &interrupted();
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
  const auto inputs = inputs_of_discovery(session);
  const auto begin = std::chrono::steady_clock::now();
  Discovery discovery = search(session, "");
  if (!ranks().first()) return discovery;
  write_discovery(session.folder.path(), discovery);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  session.folder.record({"discover", session.options.command, inputs, {"candidates.json", "discovery.json"}, seconds, "", ""});
  std::filesystem::remove_all(session.folder.file(refits));  // megabytes each, and all said
  return discovery;
}

}  // namespace misfit
