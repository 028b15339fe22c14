#include "misfit/discover/fixed_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// The model with the random force in which the system's numbers that are fixed are free, and nothing else.
FilterModel with_fixed_ones_free(const FilterEstimate& estimate) {
  FilterModel out = estimate.forced;
  for (Parameter& p : out.model.parameters) p.free = false;
  for (const ConstantSpec& constant : out.model.system->spec().constants) {
    const int place = out.model.find_parameter(constant.name);
    if (place >= 0 && !constant.of_sensor) out.model.parameters[place].free = !estimate.forced.model.parameters[place].free;
  }
  return out;
}

std::string in_words(const FixedParameter& fixed, double p_value) {
  return fmt::format(
      "{0} is fixed at {1}, but these data ask for {2} ({3}drop {4}, family-wise {5}): unless it is known that well, "
      "estimate it (parameters.{0}.free = true in the study)",
      fixed.name, in_display_unit(fixed.value, fixed.unit), in_display_unit(fixed.wanted, fixed.unit, fixed.sigma),
      fixed.actual_drop ? "" : "predicted ", format_value(fixed.actual_drop.value_or(fixed.predicted_drop)), p_equals(p_value));
}

}  // namespace

std::vector<FixedParameter> fixed_parameters(const FilterEstimate& estimate, const ScoreTest& score) {
  std::vector<FixedParameter> out;
  const FilterModel forced = with_fixed_ones_free(estimate);
  const std::vector<int> places = forced.model.free_parameters();
  if (places.empty()) return out;
  const Eigen::MatrixXd columns = columns_with_fixed_gains(estimate, forced);
  constexpr double described = 0.01;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const ScoreResult result = score.test(columns.col(c));
    if (result.dof == 0 || result.independent < described) continue;
    const Parameter& p = forced.model.parameters[places[c]];
    out.push_back(
        {p.name, p.unit, p.value, p.value + result.amplitude[0], result.sigma[0], result.chi2, chi_square_tail(result.chi2, 1.0)});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.predicted_drop > b.predicted_drop; });
  return out;
}

void free_and_refit(const RefitWork& work, FixedParameter& fixed) {
  Model start = work.without.model;
  Parameter& p = start.parameters[start.find_parameter(fixed.name)];
  p.free = true;
  p.value = std::clamp(fixed.wanted, std::min(p.lower, fixed.value), std::max(p.upper, fixed.value));
  try {
    const auto estimated = [&] {
      return estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options_like(work.without, work.threads));
    };
    FilterEstimate freed = estimated();
    if (!freed.converged || freed.objective < work.without.objective) {  // a start below which no search ends
      p.value = fixed.value;
      freed = estimated();
    }
    const int place = freed.model.find_parameter(fixed.name);
    const auto sigma = standard_error_of(freed.model, freed.covariance, place);
    if (!freed.converged || !sigma) return;
    fixed.wanted = freed.model.parameters[place].value;
    fixed.sigma = *sigma;
    fixed.actual_drop = 2.0 * (freed.objective - work.without.objective);
    fixed.p_value = chi_square_tail(*fixed.actual_drop, 1.0);
  } catch (const RunError&) {  // what one step says stays
  }
}

std::vector<std::string> fixed_parameters_in_words(const RefitWork& work, const ScoreTest& score, const FixedSearch& search) {
  constexpr double about_as_much = 0.8;
  std::vector<FixedParameter> fixed = fixed_parameters(work.without, score);
  const double tests = search.families + static_cast<double>(fixed.size());
  const auto refused = [&](const FixedParameter& h) { return sidak(h.p_value, tests) >= search.p_accept; };
  std::erase_if(fixed, [&](const FixedParameter& h) { return refused(h) || h.predicted_drop < about_as_much * search.best_predicted; });
  while (!fixed.empty()) {
    free_and_refit(work, fixed.front());
    if (!refused(fixed.front())) break;
    fixed.erase(fixed.begin());
  }
  std::vector<std::string> out;
  for (const FixedParameter& h : fixed) out.push_back(in_words(h, sidak(h.p_value, tests)));
  return out;
}

}  // namespace misfit
