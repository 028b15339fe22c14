#include "misfit/discover/refit_sizes.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/units.h"
#include "misfit/core/watch.h"
#include "misfit/discover/operating_range.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// The estimate's last effect with those of its widths that end at their bound bounded by what is resolved there; nullopt: none ends there,
/// or hardly more is resolved.
std::optional<Model> with_narrower_bounds(const FilterEstimate& estimate) {
  constexpr double at_bound = 1.001, clearly = 0.8;
  const BoundEffect& effect = estimate.model.effects.back();
  const std::vector<CoefficientSpec>& coefficients = effect.effect->spec().coefficients;
  std::optional<Model> out;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int at = effect.coefficients[c].parameter;
    if (!coefficients[c].scan.smooths || at < 0) continue;
    const Parameter& width = estimate.model.parameters[at];
    if (!width.free || width.value > at_bound * width.lower) continue;
    const double resolved = OperatingRange(estimate).lower_bound(effect, c);
    if (!(resolved < clearly * width.lower)) continue;
    if (!out) out = estimate.model;
    out->parameters[at].lower = resolved;
  }
  return out;
}

/// The estimate's last effect with its numerical times, which it keeps fixed and of which one number of sampling intervals is looked at,
/// this much shorter; nullopt: it has none.
std::optional<Model> with_shorter_times(const FilterEstimate& estimate, double share) {
  const BoundEffect& effect = estimate.model.effects.back();
  const std::vector<CoefficientSpec>& coefficients = effect.effect->spec().coefficients;
  std::optional<Model> out;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int at = effect.coefficients[c].parameter;
    const bool numerical = is_hardly_seen_between_samples(coefficients[c]) && coefficients[c].scan.count == 1;
    if (!numerical || at < 0 || estimate.model.parameters[at].free) continue;
    if (!out) out = estimate.model;
    Parameter& time = out->parameters[at];
    time.value *= share;
    time.lower = std::min(time.lower, time.value);
  }
  return out;
}

struct GoingOn {
  int most = 1;            ///< searches
  double least = 0.0;      ///< by which each raises the log-likelihood
  bool as_planned = true;  ///< integrated in the steps of the estimate without the effect; else in those that it needs from there
};

/// The estimate goes on from `next(estimate)` as long as there is one.
template <class Next>
void go_on(const RefitWork& work, Refit& out, const GoingOn& how, const Next& next) {
  for (int k = 0; k < how.most && out.estimate.converged; ++k) {
    const std::optional<Model> start = next(out.estimate);
    if (!start) return;
    FilterOptions options = options_like(work.without, work.threads);
    options.noise = out.estimate.noise;
    if (!how.as_planned) options.plans.reset();
    try {
      FilterEstimate there = estimate_filter(*start, penalties_as_of(work.without, *start), work.experiments, options);
      if (there.out_of_time || !there.converged || !(there.objective > out.estimate.objective + how.least)) return;
      out.estimate = std::move(there);
    } catch (const TimeLimitReached&) {  // what was found stays
      return;
    } catch (const RunError&) {
      return;
    }
  }
}

double longest_usual_step(const std::vector<FilterData>& data) {
  double out = 0.0;
  for (const FilterData& d : data) out = std::max(out, usual_step(d.signals->t));
  return out;
}

/// The free strengths of the estimate's last effect that are rates, are over within a sampling interval, and that the data do not
/// determine: parameters of the model.
std::vector<int> instant_strengths(const FilterEstimate& estimate, double step) {
  constexpr double over = 3.0, sigmas = 2.0;
  const BoundEffect& effect = estimate.model.effects.back();
  std::vector<int> out;
  for (const BoundCoefficient& c : effect.coefficients) {
    if (c.parameter < 0) continue;
    const Parameter& p = estimate.model.parameters[c.parameter];
    if (!p.free || p.kind != CoefficientKind::strength || !parse_unit(p.unit).same_dimension(parse_unit("1/s"))) continue;
    const auto sigma = standard_error_of(estimate.model, estimate.covariance, c.parameter);
    if (p.value * step > over && (!sigma || p.value < sigmas * *sigma)) out.push_back(c.parameter);
  }
  return out;
}

}  // namespace

void narrow_smoothings(const RefitWork& work, Refit& out) {
  constexpr int most = 8;
  go_on(work, out, {.most = most}, [](const FilterEstimate& estimate) { return with_narrower_bounds(estimate); });
}

void shorten_numerical_times(const RefitWork& work, Refit& out) {
  constexpr int most = 2;
  constexpr double shorter = 0.1;
  go_on(work, out, {.most = most, .least = 0.5 * tied_drops, .as_planned = false},
        [](const FilterEstimate& estimate) { return with_shorter_times(estimate, shorter); });
}

void fix_instant_strengths(const RefitWork& work, Refit& out) {
  constexpr double at_once = 300.0;  // per sampling interval: above the edge stays a 300th of what flows in during one
  const double step = longest_usual_step(out.estimate.data);
  if (!out.estimate.converged || !(step > 0.0)) return;
  const std::vector<int> instant = instant_strengths(out.estimate, step);
  if (instant.empty()) return;
  Model as_found = out.estimate.model, slower = as_found;
  for (const int strength : instant) {
    as_found.parameters[strength].free = slower.parameters[strength].free = false;
    slower.parameters[strength].value = std::min(slower.parameters[strength].value, at_once / step);
  }
  const double objective = out.estimate.objective;
  for (const Model& start : {slower, as_found}) {
    go_on(work, out, {.most = 1, .least = objective - gain_by_chance - out.estimate.objective, .as_planned = false},
          [&](const FilterEstimate&) { return std::optional(start); });
    if (!out.estimate.model.parameters[instant.front()].free) break;
  }
}

}  // namespace misfit
