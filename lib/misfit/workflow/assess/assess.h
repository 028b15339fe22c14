#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit {

// What fits are worth, and what their model is missing.

/// Statistics of motions that the fitted model of filter_error makes, against the measured one (lib/misfit/README.md, 6.1).
[[nodiscard]] SimulatedMotion simulated_motion(const FilterWork& work, unsigned long seed, int threads, const ProgressFn& progress);
/// compare.json.
[[nodiscard]] Comparison compare_stage(Session& session, const std::vector<Fit>& fits);
/// diagnosis.json and missing_force.csv; nullopt if filter_error declined (its fit says why). Runs that fit where it must.
[[nodiscard]] std::optional<Diagnosis> diagnose_stage(Session& session);
/// The force that is missing comes in pulses (Diagnosis::pulses).
[[nodiscard]] bool lacks_pulses_only(Session& session);
/// candidates.json and discovery.json; nullopt if filter_error declined.
[[nodiscard]] std::optional<Discovery> discover_stage(Session& session);
/// The same; RunError in the fit's words if filter_error declined.
[[nodiscard]] Discovery discovered(Session& session);
/// Where an effect acts, as somebody asks for it: roles and what they are bound to, at least those that tell its places apart.
struct AskedPlace {
  std::map<std::string, std::string> roles;
  bool by_default = false;  ///< where it goes without roles

  [[nodiscard]] bool any() const { return roles.empty() && !by_default; }
};
/// "ROLE=NAME" each, or "default" alone. InputError: neither.
[[nodiscard]] AskedPlace asked_place(const std::vector<std::string>& words);
/// What discovery says of one effect, at the best place that is as asked for: from the whole search where that is on disk, else it alone is
/// screened, and refitted if it may be significant. nullopt if it cannot be screened (it has no strength, or is driven by noise, or stands
/// for another). InputError: it can, but at other places only.
[[nodiscard]] std::optional<Candidate> predict_effect(Session& session, const std::string& effect, const AskedPlace& place = {});
/// What these stages left on disk, where it still belongs to the fit that is there.
[[nodiscard]] std::optional<Diagnosis> known_diagnosis(const Session& session);
[[nodiscard]] std::optional<Discovery> known_discovery(const Session& session);
/// What diagnosis and discovery depend on.
[[nodiscard]] StageInputs inputs_of_diagnosis(const Session& session);
[[nodiscard]] StageInputs inputs_of_discovery(const Session& session);

}  // namespace misfit
