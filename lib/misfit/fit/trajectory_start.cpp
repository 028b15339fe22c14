#include "misfit/fit/trajectory_start.h"

#include "misfit/fit/filter/runnable_start.h"
#include "misfit/fit/regression/equation_error.h"

namespace misfit {
namespace {

/// As far as it is free: what the study fixes stays.
void damping_to_zero(Model& model) {
  const Curve* damping = model.find_curve(model.system->spec().damping_curve);
  if (damping == nullptr) return;
  for (int i = 0; i < damping->spline.size(); ++i) {
    Parameter& p = model.parameters[damping->first + i];
    if (p.free) p.value = 0.0;
  }
}

/// Equation error with the parameters of `kept` fixed where `asked` has them, and free again afterwards.
FittedModel with_kept(const Model& asked, const std::vector<Signals>& experiments, const std::vector<int>& kept) {
  Model with_fixed = asked;
  for (int i : kept) with_fixed.parameters[i].free = false;
  FittedModel start = equation_error(with_fixed, experiments);
  for (std::size_t i = 0; i < asked.parameters.size(); ++i) start.model.parameters[i].free = asked.parameters[i].free;
  std::vector<Penalty> penalties = curve_penalties(start.model);
  for (std::size_t k = 0; k < penalties.size(); ++k) penalties[k].lambda = start.penalties[k].lambda;
  start.penalties = std::move(penalties);
  return start;
}

std::vector<int> free_shapes(const Model& model) {
  std::vector<int> out;
  for (int i : model.free_parameters()) {
    const Parameter& p = model.parameters[i];
    if (p.curve < 0 && p.kind == CoefficientKind::shape) out.push_back(i);
  }
  return out;
}

TrajectoryStart begun_at(FittedModel from) {
  TrajectoryStart out{std::move(from), false};
  const FitStatus status = out.from.fit.status;
  out.regressed = status != FitStatus::declined && status != FitStatus::failed;
  if (out.regressed && out.from.fit.driven) damping_to_zero(out.from.model);
  return out;
}

}  // namespace

TrajectoryStart trajectory_start(const Model& asked, const std::vector<Signals>& experiments,
                                 const std::function<const FittedModel&()>& whole) {
  const std::vector<int> kept = free_shapes(asked);
  if (!kept.empty()) return begun_at(with_kept(asked, experiments, kept));
  return begun_at(whole ? whole() : equation_error(asked, experiments));
}

std::optional<TrajectoryStart> trajectory_start_as_given(const Model& asked, const std::vector<Signals>& experiments) {
  const std::vector<int> strengths = free_strengths(asked);
  if (strengths.empty()) return std::nullopt;
  std::vector<int> kept = free_shapes(asked);
  kept.insert(kept.end(), strengths.begin(), strengths.end());
  return begun_at(with_kept(asked, experiments, kept));
}

}  // namespace misfit
