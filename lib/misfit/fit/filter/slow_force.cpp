#include "misfit/fit/filter/slow_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "misfit/core/display.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// Of one state along the filtered motion of all experiments.
struct Spread {
  double n = 0.0, sum = 0.0, squares = 0.0, rates = 0.0;

  void add(double value, double rate) {
    n += 1.0;
    sum += value;
    squares += value * value;
    rates += rate * rate;
  }
  [[nodiscard]] double variance() const { return n > 2.0 ? squares / n - sum * sum / (n * n) : 0.0; }
};

/// "1.3 s": two digits.
std::string roughly(double value, const std::string& unit) {
  return with_display_unit(fmt::format("{:.2g}", display_value(value, unit)), unit);
}

std::vector<Spread> spreads_of(const FilterEstimate& estimate) {
  const std::size_t states = estimate.model.system->spec().states.size();
  std::vector<Spread> out(states);
  std::vector<double> rates(estimate.forced.model.states());
  Evaluator evaluator(estimate.forced.model);
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    const FilterData& data = estimate.data[e];
    for (std::size_t k = data.first; k < estimate.traces[e].samples; ++k) {
      const Eigen::VectorXd x = estimate.traces[e].filtered(k);
      evaluator.rates(x.data(), data.inputs.at(k), data.signals->t[k], rates.data());
      for (std::size_t j = 0; j < states; ++j) out[j].add(x[j], rates[j]);
    }
  }
  return out;
}

}  // namespace

double shortest_period(const FilterEstimate& estimate) {
  constexpr double hardly_moves = 1e-6;  // of the typical size
  const std::vector<Spread> spreads = spreads_of(estimate);
  const auto& states = estimate.model.system->spec().states;
  double fastest = 0.0;
  for (std::size_t j = 0; j < states.size(); ++j) {
    const double variance = spreads[j].variance(), least = hardly_moves * states[j].scale;
    const auto shown = [&](const FilterData& data) { return data.read && data.read->shown[j]; };
    if (!(variance > least * least) || !std::any_of(estimate.data.begin(), estimate.data.end(), shown)) continue;
    fastest = std::max(fastest, std::sqrt(spreads[j].rates / spreads[j].n / variance));
  }
  return fastest > 0.0 ? 2.0 * std::numbers::pi / fastest : std::numeric_limits<double>::infinity();
}

std::string warning_of_slow_force(const FilterEstimate& estimate) {
  const double time = estimate.noise.force_time, period = shortest_period(estimate);
  if (estimate.reference.time_is_given || !(time > period)) return "";
  const SystemSpec& spec = estimate.model.system->spec();
  std::string strengths;
  for (std::size_t i = 0; i < estimate.forced.force_ports.size(); ++i) {
    const PortSpec& port = spec.dynamic_ports[estimate.forced.force_ports[i]];
    const double strength = estimate.noise.force_of(estimate.forced.force_group[i]);
    strengths += fmt::format("{}{} on {}", i == 0 ? "" : ", ", roughly(strength, port.unit), port.name);
  }
  return fmt::format(
      "the random force is slow: its correlation time is {}, the motion's shortest period {}. What changes as slowly and is no larger ({}) "
      "may be attributed to it: an offset, dry friction or drag may be estimated too small. Compare with output_error, or fix [force] "
      "correlation_time (0: white)",
      roughly(time, "s"), roughly(period, "s"), strengths);
}

}  // namespace misfit
