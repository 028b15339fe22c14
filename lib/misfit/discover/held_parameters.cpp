#include "misfit/discover/held_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// Places of the system's numbers that are held, in the model with the random force.
std::vector<int> held_places(const FilterModel& forced) {
  const std::vector<ConstantSpec>& constants = forced.model.system->spec().constants;
  std::vector<int> out;
  for (const ConstantSpec& constant : constants) {
    const int place = forced.model.find_parameter(constant.name);
    if (place >= 0 && !forced.model.parameters[place].free && !constant.of_sensor) out.push_back(place);
  }
  return out;
}

/// ∂(predicted − measured)/√S by these parameters, gains held; empty where the filter cannot be run.
Eigen::MatrixXd columns_of(const FilterEstimate& estimate, const std::vector<int>& places) {
  FilterModel forced = estimate.forced;
  for (Parameter& p : forced.model.parameters) p.free = false;
  for (const int place : places) forced.model.parameters[place].free = true;
  FilterRunner runner(forced, true);
  runner.set_parameters(forced.model.values());
  Eigen::MatrixXd out(counted_rows(estimate), std::ssize(places));
  Eigen::Index at = 0;
  FilterTrace trace;
  FilterJacobian jacobian;
  for (const FilterData& data : estimate.data) {
    if (!runner.run(data, estimate.noise, trace, {&jacobian})) return {};
    out.middleRows(at, jacobian.r.size()) = jacobian.J;
    at += jacobian.r.size();
  }
  return out;
}

}  // namespace

std::vector<HeldParameter> held_parameters(const FilterEstimate& estimate, const ScoreTest& score) {
  std::vector<HeldParameter> out;
  const std::vector<int> places = held_places(estimate.forced);
  if (places.empty()) return out;
  const Eigen::MatrixXd columns = columns_of(estimate, places);
  constexpr double described = 0.01;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const ScoreResult result = score.test(columns.col(c));
    if (result.dof == 0 || result.independent < described) continue;
    const Parameter& p = estimate.forced.model.parameters[places[static_cast<std::size_t>(c)]];
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
    const FilterEstimate freed =
        estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options_like(work.without, work.threads));
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

std::string held_in_words(const HeldParameter& held, double p_value) {
  return fmt::format("{} is held at {}, and these data want {} ({}drop {}, family-wise {}): free it, unless it is known that well",
                     held.name, in_display_unit(held.value, held.unit), in_display_unit(held.wanted, held.unit, held.sigma),
                     held.actual_drop ? "" : "predicted ", format_value(held.actual_drop.value_or(held.predicted_drop)), p_equals(p_value));
}

}  // namespace misfit
