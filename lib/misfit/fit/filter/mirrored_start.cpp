#include "misfit/fit/filter/mirrored_start.h"

#include <cmath>
#include <optional>

#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// The start with a state and its rates turned.
Eigen::VectorXd turned(Eigen::VectorXd start, const Model& model, int state) {
  start[state] = -start[state];
  for (int other = 0; other < model.system_states(); ++other) {
    if (model.state_specs[other].rate_of == state) start = turned(std::move(start), model, other);
  }
  return start;
}

bool reads_alike(Evaluator& evaluator, const FilterData& data, const Eigen::VectorXd& a, const Eigen::VectorXd& b, double size) {
  constexpr double alike = 1e-6;
  const std::size_t values = evaluator.sensor_ports();
  std::vector<double> of_a(values), of_b(values);
  const double t = data.signals->t[data.first];
  evaluator.predict(a.data(), data.inputs.at(data.first), t, of_a.data());
  evaluator.predict(b.data(), data.inputs.at(data.first), t, of_b.data());
  for (std::size_t i = 0; i < values; ++i) {
    if (!(std::abs(of_a[i] - of_b[i]) <= alike * size)) return false;
  }
  return true;
}

}  // namespace

void choose_mirrored_starts(const FilterModel& model, const std::vector<double>& values, const FilterNoise& noise,
                            std::vector<FilterData>& data) {
  Evaluator evaluator(model.model);
  evaluator.set_parameters(values.data());
  std::optional<FilterRunner> runner;  // hardly any model has such a state
  const auto loglik = [&](const FilterData& from) -> std::optional<double> {
    if (!runner) {
      runner.emplace(model, false);
      runner->set_parameters(values);
    }
    FilterTrace trace;
    return runner->run(from, noise, trace) ? std::optional(trace.loglik) : std::nullopt;
  };
  for (FilterData& from : data) {
    for (int state = 0; state < model.model.system_states(); ++state) {
      const double size = std::abs(from.start[state]);
      if (!(size > 0.0) || !(from.covariance(state, state) > 0.0) || model.model.state_specs[state].rate_of >= 0) continue;
      FilterData mirrored = from;
      mirrored.start = turned(from.start, model.model, state);
      if (!reads_alike(evaluator, from, from.start, mirrored.start, size)) continue;
      const std::optional<double> as_shown = loglik(from), other = loglik(mirrored);
      if (other && (!as_shown || *other > *as_shown)) from = std::move(mirrored);
    }
  }
}

}  // namespace misfit
