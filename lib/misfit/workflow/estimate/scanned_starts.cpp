#include "misfit/workflow/estimate/scanned_starts.h"

#include <algorithm>
#include <set>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/discover/scanned_start.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/methods.h"
#include "misfit/workflow/measure/measure.h"

namespace misfit {
namespace {

/// Numbers of its own, by coefficient: −1 where there is none.
std::vector<int> own_parameters(const BoundEffect& effect) {
  const auto& coefficients = effect.effect->spec().coefficients;
  std::vector<int> out;
  for (std::size_t c = 0; c < coefficients.size(); ++c) out.push_back(coefficients[c].shared ? -1 : effect.coefficients[c].parameter);
  return out;
}

bool is_given(const Prepared& prepared, int parameter) {
  const auto asked = prepared.request.parameters.find(prepared.model.parameters[parameter].name);
  return asked != prepared.request.parameters.end() && asked->second.value;
}

/// Has it a free shape to scan that the study gives no start for, and a free strength beside it? Those with curves are left as they are.
bool wants_scan(const Prepared& prepared, const BoundEffect& effect) {
  const auto& coefficients = effect.effect->spec().coefficients;
  const std::vector<int> own = own_parameters(effect);
  bool shape = false, strength = false;
  for (std::size_t c = 0; c < own.size(); ++c) {
    if (coefficients[c].shared) continue;
    if (own[c] < 0) return false;
    const bool free = prepared.model.parameters[own[c]].free;
    strength = strength || (free && coefficients[c].kind == CoefficientKind::strength);
    shape = shape ||
            (free && coefficients[c].kind == CoefficientKind::shape && coefficients[c].scan.is_scanned() && !is_given(prepared, own[c]));
  }
  return shape && strength;
}

/// The request without these effects and what it says of their numbers.
ModelRequest without_effects(const Prepared& prepared, const std::set<std::size_t>& effects) {
  ModelRequest out = prepared.request;
  out.effects.clear();
  for (std::size_t i = 0; i < prepared.request.effects.size(); ++i) {
    if (!effects.contains(i)) {
      out.effects.push_back(prepared.request.effects[i]);
      continue;
    }
    for (const int at : own_parameters(prepared.model.effects[i])) {
      if (at >= 0) out.parameters.erase(prepared.model.parameters[at].name);
    }
  }
  return out;
}

/// Coefficients that the study fixes, and shapes that it gives a start for.
std::map<std::string, double> fixed_coefficients(const Prepared& prepared, const BoundEffect& effect) {
  const auto& coefficients = effect.effect->spec().coefficients;
  const std::vector<int> own = own_parameters(effect);
  std::map<std::string, double> out;
  for (std::size_t c = 0; c < own.size(); ++c) {
    if (own[c] < 0 || coefficients[c].kind != CoefficientKind::shape) continue;
    const Parameter& p = prepared.model.parameters[own[c]];
    if (!p.free || is_given(prepared, own[c])) out[coefficients[c].name] = p.value;
  }
  return out;
}

/// What the study leaves open begins where the scan ended; said of shapes.
void begin_there(const Prepared& prepared, std::size_t effect, const ScannedStart& start, ScannedStudy& out) {
  const BoundEffect& bound = prepared.model.effects[effect];
  const std::vector<int> own = own_parameters(bound);
  std::string shapes;
  for (std::size_t c = 0; c < own.size(); ++c) {
    if (own[c] < 0 || !start.values[c]) continue;
    Parameter& p = out.model.parameters[own[c]];
    if (!p.free || is_given(prepared, own[c])) continue;
    p.value = std::clamp(*start.values[c], p.lower, p.upper);
    if (p.kind == CoefficientKind::shape) shapes += (shapes.empty() ? "" : ", ") + p.name + " = " + in_display_unit(p.value, p.unit, 0.0);
  }
  out.facts["start of " + prepared.request.effects[effect].name] = "where a scan of its shapes found most: " + shapes;
}

}  // namespace

std::optional<ScannedStudy> scanned_study(Session& session, const Prepared& prepared) {
  std::set<std::size_t> wanted;
  for (std::size_t i = 0; i < prepared.request.effects.size(); ++i) {
    if (wants_scan(prepared, prepared.model.effects[i])) wanted.insert(i);
  }
  if (wanted.empty()) return std::nullopt;
  try {
    const ModelRequest request = without_effects(prepared, wanted);
    const Model model = assemble(request, session.registry);
    const Estimation without = estimator(random_force_estimator().name)
                                   .run({.model = model, .experiments = prepared.experiments, .threads = session.options.threads});
    if (!without.filter) return std::nullopt;
    const std::optional<Calibration> calibration = calibrate_stage(session);
    const ScanTask task{
        {*without.filter, request, session.registry, prepared.experiments}, calibration ? &*calibration : nullptr, session.options.threads};
    ScannedStudy out{prepared.model, std::nullopt, {}};
    const ContainedFit contained = contained_fit(*without.filter);
    if (contains(prepared.model, contained)) out.contained = contained;
    for (const std::size_t i : wanted) {
      const std::optional<ScannedStart> start =
          scanned_start(task, prepared.request.effects[i], fixed_coefficients(prepared, prepared.model.effects[i]));
      if (!start) continue;
      begin_there(prepared, i, *start, out);
      if (wanted.size() > 1 || !out.contained || start->refit_values.size() != prepared.model.parameters.size()) continue;
      out.contained->refit_values = start->refit_values;
      out.contained->refit_log_noise = start->refit_log_noise;
    }
    return out;
  } catch (const RunError&) {
    return std::nullopt;  // the fit itself says what is wrong
  } catch (const InputError&) {
    return std::nullopt;  // one of these effects is what another needs
  }
}

}  // namespace misfit
