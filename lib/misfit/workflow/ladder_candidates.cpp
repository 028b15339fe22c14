#include "misfit/workflow/ladder_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/model/registry.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

std::vector<Candidate> alternatives_to(const Candidate& accepted, const Discovery& discovery) {
  std::vector<Candidate> out;
  constexpr std::size_t most = 3;
  for (const Candidate& c : discovery.candidates) {
    const bool same = c.effect == accepted.effect && c.roles == accepted.roles;
    if (same || !c.actual_drop || !accepted.actual_drop || !(*c.actual_drop > 0.5 * *accepted.actual_drop) || out.size() == most) continue;
    out.push_back(c);
  }
  return out;
}

Candidate without_refit(Candidate candidate) {
  candidate.refit_values.clear();
  candidate.refit_log_noise.clear();
  return candidate;
}

std::string why_undetermined(const Rung& rung) {
  if (parameters_added(rung) != 1) return "";
  const auto estimated = std::find_if(rung.parameters.begin(), rung.parameters.end(), [](const auto& p) { return p.second.sigma > 0.0; });
  if (estimated == rung.parameters.end() || !(estimated->second.sigma > std::abs(estimated->second.value))) return "";
  const auto& [name, e] = *estimated;
  return fmt::format("its {} is not determined: {}", name, in_display_unit(e.value, e.unit, e.sigma));
}

std::vector<double> twice_as_many(const std::vector<double>& knots) {
  constexpr std::size_t most = 65;
  std::vector<double> out;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (i > 0) out.push_back(0.5 * (knots[i - 1] + knots[i]));
    out.push_back(knots[i]);
  }
  if (out.size() > most) out.clear();
  return out;
}

std::optional<Candidate> accepted_candidate(const Discovery& discovery, const Registry& registry) {
  const std::vector<std::string> known = registry.effect_keys();
  for (const auto& candidate : discovery.candidates) {
    if (candidate.accepted && std::find(known.begin(), known.end(), candidate.effect) != known.end()) return candidate;
  }
  return std::nullopt;
}

}  // namespace misfit
