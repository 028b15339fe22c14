#include "misfit/discover/scanned_start.h"

#include <algorithm>

#include "misfit/discover/refit.h"
#include "misfit/discover/unknown_curves.h"

namespace misfit {
namespace {

/// Name of the coefficient whose parameter this is; empty: of another effect.
std::string coefficient_of(const BoundEffect& effect, int parameter) {
  const auto& coefficients = effect.effect->spec().coefficients;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    if (!coefficients[c].shared && effect.coefficients[c].parameter == parameter) return coefficients[c].name;
  }
  return {};
}

/// Shapes that are fixed have one value in all cells.
void fix_shapes(const std::map<std::string, double>& fixed, CandidateModel& out) {
  const BoundEffect& effect = out.model.effects.back();
  const auto fixed_value = [&](int parameter) {
    const auto found = fixed.find(coefficient_of(effect, parameter));
    return found == fixed.end() ? std::optional<double>() : found->second;
  };
  for (auto& cell : out.cells) {
    for (std::size_t i = 0; i < out.shapes.size(); ++i) cell[i] = fixed_value(out.shapes[i]).value_or(cell[i]);
  }
  std::sort(out.cells.begin(), out.cells.end());
  out.cells.erase(std::unique(out.cells.begin(), out.cells.end()), out.cells.end());
  if (out.frequency >= 0 && fixed_value(out.frequency)) out.frequency = -1;
  for (const auto& coefficient : effect.coefficients) {
    if (coefficient.parameter < 0) continue;
    if (const auto value = fixed_value(coefficient.parameter)) out.model.parameters[coefficient.parameter].value = *value;
  }
}

}  // namespace

std::optional<ScannedStart> scanned_start(const ScanTask& task, const EffectRequest& effect, const std::map<std::string, double>& fixed) {
  constexpr double least_chi2 = 10.0;
  std::optional<CandidateModel> model = candidate_model_of(task.without, effect, task.calibration);
  if (!model) return std::nullopt;
  fix_shapes(fixed, *model);
  const ScoreTest score(task.without.estimate);
  const ForceSensitivity force = sensitivity_of_forces_and_parameters(task.without.estimate);
  const std::vector<CandidateModel> alone = {std::move(*model)};
  const std::vector<ScreeningResult> screened = screen({.estimate = task.without.estimate,
                                                        .score = score,
                                                        .force = force,
                                                        .threads = task.threads,
                                                        .calibrated = task.calibration != nullptr},
                                                       alone);
  if (screened.empty() || !screened.front().runs || !(screened.front().result.chi2 >= least_chi2)) return std::nullopt;
  const RefitWork work{.without = task.without.estimate,
                       .experiments = task.without.experiments,
                       .registry = task.without.registry,
                       .threads = task.threads};
  const Refit found = refit(work, screened.front(), one_step(work, score, screened.front()));
  if (!found.ok) return std::nullopt;
  ScannedStart out;
  const BoundEffect& bound = found.estimate.model.effects.back();
  for (const auto& coefficient : bound.coefficients) {
    const bool own = coefficient.parameter >= 0;
    out.values.push_back(own ? std::optional(found.estimate.model.parameters[coefficient.parameter].value) : std::nullopt);
  }
  out.refit_values = found.estimate.model.values();
  out.refit_log_noise = pack(found.estimate.noise, found.estimate.model.system->spec(), found.estimate.reference).value;
  return out;
}

}  // namespace misfit
