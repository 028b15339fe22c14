#include "misfit/discover/held_parameters.h"

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

/// The model with the random force in which the system's numbers that are held are free, and nothing else.
FilterModel with_held_ones_free(const FilterEstimate& estimate) {
  FilterModel out = estimate.forced;
  for (Parameter& p : out.model.parameters) p.free = false;
  for (const ConstantSpec& constant : out.model.system->spec().constants) {
    const int place = out.model.find_parameter(constant.name);
    if (place >= 0 && !constant.of_sensor) out.model.parameters[place].free = !estimate.forced.model.parameters[place].free;
  }
  return out;
}

std::string in_words(const HeldParameter& held, double p_value) {
  return fmt::format(
      "{0} is fixed at {1}, but these data ask for {2} ({3}drop {4}, family-wise {5}): unless it is known that well, "
      "estimate it (misfit set STUDY parameters.{0}.free=true)",
      held.name, in_display_unit(held.value, held.unit), in_display_unit(held.wanted, held.unit, held.sigma),
      held.actual_drop ? "" : "predicted ", format_value(held.actual_drop.value_or(held.predicted_drop)), p_equals(p_value));
}

}  // namespace

std::vector<HeldParameter> held_parameters(const FilterEstimate& estimate, const ScoreTest& score) {
  std::vector<HeldParameter> out;
  const FilterModel forced = with_held_ones_free(estimate);
  const std::vector<int> places = forced.model.free_parameters();
  if (places.empty()) return out;
  const Eigen::MatrixXd columns = columns_with_gains_held(estimate, forced);
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

void free_and_refit(const RefitWork& work, HeldParameter& held) {
  Model start = work.without.model;
  Parameter& p = start.parameters[start.find_parameter(held.name)];
  p.free = true;
  p.value = std::clamp(held.wanted, std::min(p.lower, held.value), std::max(p.upper, held.value));
  try {
    const auto estimated = [&] {
      return estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options_like(work.without, work.threads));
    };
    FilterEstimate freed = estimated();
    if (!freed.converged || freed.objective < work.without.objective) {  // a start below which no search ends
      p.value = held.value;
      freed = estimated();
    }
    const int place = freed.model.find_parameter(held.name);
    const auto sigma = standard_error_of(freed.model, freed.covariance, place);
    if (!freed.converged || !sigma) return;
    held.wanted = freed.model.parameters[place].value;
    held.sigma = *sigma;
    held.actual_drop = 2.0 * (freed.objective - work.without.objective);
    held.p_value = chi_square_tail(*held.actual_drop, 1.0);
  } catch (const RunError&) {  // what one step says stays
  }
}

std::vector<std::string> held_in_words(const RefitWork& work, const ScoreTest& score, const HeldSearch& search) {
  constexpr double about_as_much = 0.8;
  std::vector<HeldParameter> held = held_parameters(work.without, score);
  const double tests = search.families + static_cast<double>(held.size());
  const auto refused = [&](const HeldParameter& h) { return sidak(h.p_value, tests) >= search.p_accept; };
  std::erase_if(held, [&](const HeldParameter& h) { return refused(h) || h.predicted_drop < about_as_much * search.best_predicted; });
  while (!held.empty()) {
    free_and_refit(work, held.front());
    if (!refused(held.front())) break;
    held.erase(held.begin());
  }
  std::vector<std::string> out;
  for (const HeldParameter& h : held) out.push_back(in_words(h, sidak(h.p_value, tests)));
  return out;
}

}  // namespace misfit
