#include "misfit/fit/trajectory_start.h"

#include "misfit/fit/regression/equation_error.h"

namespace misfit {
namespace {

void damping_to_zero(Model& model) {
  const Curve* damping = model.find_curve(model.system->spec().damping_curve);
  if (damping == nullptr) return;
  for (int i = 0; i < damping->spline.size(); ++i) model.parameters[damping->first + i].value = 0.0;
}

FittedModel with_shapes_kept(const Model& asked, const std::vector<Signals>& experiments,
                             const std::function<const FittedModel&()>& whole) {
  Model kept = asked;
  bool any = false;
  for (auto& p : kept.parameters) {
    const bool shape = p.free && p.curve < 0 && p.kind == CoefficientKind::shape;
    if (shape) p.free = false;
    any = any || shape;
  }
  if (!any) return whole ? whole() : equation_error(asked, experiments);
  FittedModel start = equation_error(kept, experiments);
  for (std::size_t i = 0; i < asked.parameters.size(); ++i) start.model.parameters[i].free = asked.parameters[i].free;
  std::vector<Penalty> penalties = curve_penalties(start.model);
  for (std::size_t k = 0; k < penalties.size(); ++k) penalties[k].lambda = start.penalties[k].lambda;
  start.penalties = std::move(penalties);
  return start;
}

}  // namespace

TrajectoryStart trajectory_start(const Model& asked, const std::vector<Signals>& experiments,
                                 const std::function<const FittedModel&()>& whole) {
  TrajectoryStart out{with_shapes_kept(asked, experiments, whole), false};
  const FitStatus status = out.from.fit.status;
  out.regressed = status != FitStatus::declined && status != FitStatus::failed;
  if (out.regressed && out.from.fit.driven) damping_to_zero(out.from.model);
  return out;
}

}  // namespace misfit
