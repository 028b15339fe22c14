#include <chrono>

#include "apps/stages.h"
#include "misfit/discover/discover.h"

namespace misfit {

std::optional<Discovery> discover_stage(Session& session) {
  if (filter_declined(session)) return std::nullopt;
  stop_if_interrupted();
  if (auto known = known_discovery(session)) return known;
  const auto inputs = inputs_of_discovery(session);
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const auto work = filter_work(session);
  const auto begin = std::chrono::steady_clock::now();
  DiscoverOptions options;
  options.threads = session.options.threads;
  options.calibration = calibration ? &*calibration : nullptr;
  Discovery discovery = discover(*work->estimate, work->prepared.request, session.registry, work->prepared.experiments, options);
  write_discovery(session.folder.path(), discovery);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  session.folder.record({"discover", session.options.command, inputs, {"candidates.json", "discovery.json"}, seconds, "", ""});
  return discovery;
}

}  // namespace misfit
