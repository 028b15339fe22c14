#include "misfit/discover/refit_sizes.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/watch.h"
#include "misfit/discover/operating_range.h"
#include "misfit/discover/unknown_curves.h"

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

}  // namespace misfit
