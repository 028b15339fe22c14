#include "tests/benchmark/hidden_answer.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/discover/discover.h"
#include "misfit/discover/refit.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/inference/curves.h"
#include "tests/benchmark/known_truth.h"

namespace misfit::bench {
namespace {

/// Processor time of all threads: the bench may share its machine.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : "+") + word;
  return out;
}

/// Refitted with the hidden effect, started at what was simulated.
double drop_of(const World& world, const Hidden& hidden, const FilterEstimate& without, const ModelRequest& request, const Registry& truth,
               int threads) {
  const Calibration* calibration = world.calibrated ? &world.calibration : nullptr;
  std::vector<CandidateModel> all = candidate_models(without, request, truth, calibration);
  const auto at = std::find_if(all.begin(), all.end(), [&](const CandidateModel& s) { return s.effect == hidden.effect; });
  if (at == all.end()) throw RunError("no candidate model of " + hidden.effect);
  ScreeningResult screening;
  screening.candidate_model = &*at;
  Eigen::VectorXd strengths(static_cast<Eigen::Index>(at->strengths.size()));
  for (std::size_t i = 0; i < at->strengths.size(); ++i)
    strengths[static_cast<Eigen::Index>(i)] = hidden.values.at(at->model.parameters[static_cast<std::size_t>(at->strengths[i])].name);
  for (const auto& [name, value] : hidden.values) at->request.parameters[name].value = value;
  // Beside curves that were fitted without it the whole effect may be too much to start with.
  for (const double share : {1.0, 0.5, 0.25}) {
    screening.result.amplitude = share * strengths;
    const Refit refitted = refit({without, world.experiments, truth, threads}, screening);
    if (refitted.ok) return refitted.drop;
  }
  return 0.0;
}

void look_at_curves(const World& world, const FilterEstimate& estimate, Row& row) {
  constexpr double per_degree = std::numbers::pi / 180.0;
  const Fit fit = filter_fit(estimate);
  if (fit.trim) {
    row.trim_error = (fit.trim->value - world.trim) / per_degree;
    row.trim_sigma = fit.trim->sigma / per_degree;
  }
  double inside = 0.0, all = 0.0;
  for (const auto& curve : fit.curves) {
    if (curve.name != "C_m") continue;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double error = curve.value[i] - curve_value(world.truth, "C_m", curve.x[i]);
      all += curve.count[i];
      if (std::abs(error) < 1.96 * curve.sigma[i]) inside += curve.count[i];
    }
  }
  row.band_share = all > 0.0 ? inside / all : 0.0;
}

void judge(const World& world, const Discovery& found, Row& row) {
  const auto is_hidden = [&](const std::string& effect) {
    return std::any_of(world.hidden.begin(), world.hidden.end(), [&](const Hidden& h) { return h.known_as == effect; });
  };
  if (!found.candidates.empty()) {
    const Candidate& first = found.candidates.front();
    row.nearest = first.effect;
    if (first.accepted) {
      row.verdict = "named";
      row.named = first.effect;
      row.group = joined(first.group);
      row.named_first = is_hidden(first.effect);
      row.right_group = row.named_first || std::any_of(first.group.begin(), first.group.end(), is_hidden);
    } else if (!found.unexplained_quantity.empty()) {
      row.verdict = "unknown";
      row.quantity = found.unexplained_quantity;
      for (const auto& h : world.hidden)
        row.right_quantity = row.right_quantity || std::find(h.quantities.begin(), h.quantities.end(), row.quantity) != h.quantities.end();
    }
  }
  for (const auto& c : found.candidates) {
    if (!c.actual_drop || !is_hidden(c.effect) || row.actual_drop > 0.0) continue;
    row.predicted_drop = c.predicted_drop;
    row.actual_drop = *c.actual_drop;
  }
}

}  // namespace

Row answer(const World& world, double seconds, const Registry& known, const Registry& truth, int threads) {
  Row row;
  row.kind = world.kind;
  row.number = world.number;
  row.seconds = seconds;
  row.strength = world.strength;
  std::vector<std::string> names, known_as;
  for (const auto& h : world.hidden) {
    names.push_back(h.effect);
    known_as.push_back(h.known_as);
  }
  row.hidden = joined(names);
  row.known_as = joined(known_as);
  constexpr int intervals = 16;
  ModelRequest request = world.request;
  try {
    const double begin = now();
    choose_all_knots(request, known, world.experiments, intervals);
    const Model model = assemble(request, known);
    FilterOptions fitting;
    fitting.threads = threads;
    const FilterEstimate estimate = estimate_filter(model, curve_penalties(model), world.experiments, fitting);
    row.fit_seconds = now() - begin;
    look_at_curves(world, estimate, row);
    DiscoverOptions options;
    options.threads = threads;
    options.calibration = world.calibrated ? &world.calibration : nullptr;
    const double fitted = now();
    const Discovery found = discover({estimate, request, known, world.experiments}, options);
    row.discover_seconds = now() - fitted;
    judge(world, found, row);
    for (const auto& h : world.hidden) row.oracle_drop = std::max(row.oracle_drop, drop_of(world, h, estimate, request, truth, threads));
  } catch (const RunError& error) {
    row.verdict = "failed";
    row.nearest = error.what();
    std::replace(row.nearest.begin(), row.nearest.end(), ',', ';');
  }
  return row;
}

}  // namespace misfit::bench
