#include "misfit/discover/whole_strength.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "misfit/core/lists.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// What a step of one input changes.
class InputStep {
 public:
  InputStep(const Model& model, int input, double step) : evaluator_(model), input_(input), step_(step) {}

  /// ∂f/∂u of the rates of all states, by differences on both sides.
  Eigen::VectorXd of_rates(const Eigen::VectorXd& x, const double* u, double t) {
    const auto rates = [&](const std::vector<double>& at) {
      Eigen::VectorXd out(x.size());
      evaluator_.rates(x.data(), at.data(), t, out.data());
      return out;
    };
    return (rates(moved(u, step_)) - rates(moved(u, -step_))) / (2.0 * step_);
  }

  /// So of the outputs.
  Eigen::VectorXd of_outputs(const Eigen::VectorXd& x, const double* u, double t) {
    const auto outputs = [&](const std::vector<double>& at) {
      Eigen::VectorXd out = Eigen::VectorXd::Zero(evaluator_.sensor_ports());
      evaluator_.predict(x.data(), at.data(), t, out.data());
      return out;
    };
    return (outputs(moved(u, step_)) - outputs(moved(u, -step_))) / (2.0 * step_);
  }

 private:
  [[nodiscard]] std::vector<double> moved(const double* u, double by) const {
    std::vector<double> out(u, u + evaluator_.model().system->spec().inputs.size());
    out[input_] += by;
    return out;
  }

  Evaluator evaluator_;
  int input_;
  double step_;
};

/// Force on a port that moves the rates as an input does: b·∂f/∂u / b·b with the port's column b of x' = f + b F.
class InputGain {
 public:
  InputGain(const Model& model, InputStep step, int port)
      : step_(std::move(step)), system_(*model.system), values_(model.values()), port_(port) {}

  double at(const Eigen::VectorXd& x, const double* u, double t) {
    const SystemSpec& spec = system_.spec();
    const Eigen::Index states = spec.states.size();
    const std::vector<double> no_ports(spec.quantity_ports.size() + spec.dynamic_ports.size() + 1, 0.0);
    std::vector<double> dx(spec.states.size()), by_x(spec.states.size() * spec.states.size());
    RowMatrix by_force(states, std::ssize(spec.dynamic_ports));
    system_.linearise_rates({x.data(), u, t, values_.data(), no_ports.data()}, no_ports.data(), dx.data(),
                            {by_x.data(), nullptr, by_force.data(), nullptr});
    const Eigen::VectorXd b = by_force.col(port_);
    return b.dot(step_.of_rates(x, u, t).head(states)) / b.squaredNorm();
  }

 private:
  InputStep step_;
  const System& system_;
  std::vector<double> values_;  // constants first
  int port_;
};

/// A small share of the range of an input over all experiments, or of its size where it never changes.
double small_step(const FilterEstimate& estimate, int input) {
  constexpr double share = 1e-4;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const FilterData& data : estimate.data) {
    for (std::size_t k = data.first; k < data.signals->samples(); ++k) {
      const double u = data.inputs.at(k).values[input];
      if (!std::isfinite(u)) continue;
      low = std::min(low, u);
      high = std::max(high, u);
    }
  }
  if (high > low) return share * (high - low);
  return high == low && high != 0.0 ? share * std::abs(high) : share;
}

/// look(x, u, t) at some samples of every experiment.
template <class Look>
void at_some_samples(const FilterEstimate& estimate, Look look) {
  constexpr std::size_t samples = 100;  // of each experiment
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    const std::size_t stride = std::max<std::size_t>((trace.samples - data.first) / samples, 1);
    for (std::size_t k = data.first; k < trace.samples; k += stride) look(trace.filtered(k), data.inputs.at(k).values, data.signals->t[k]);
  }
}

/// −1: the quantity is no input.
int number_of_input(const Model& model, int quantity) {
  return quantity >= 0 && quantity < int_size(model.system->spec().quantities) ? model.input_of_quantity(quantity) : -1;
}

/// Median over the recording; 0: the quantity is no input, or it does not act there.
double gain_of_input(const FilterEstimate& estimate, const Model& model, int quantity, int port) {
  const int input = port < 0 ? -1 : number_of_input(model, quantity);
  if (input < 0) return 0.0;
  std::vector<double> gains;
  InputGain gain(model, {model, input, small_step(estimate, input)}, port);
  at_some_samples(estimate, [&](const auto& x, const double* u, double t) { gains.push_back(gain.at(x, u, t)); });
  std::erase_if(gains, [](double g) { return !std::isfinite(g); });
  return gains.empty() ? 0.0 : median(gains);
}

/// The model of an estimate, its last effect off.
Model without_last_effect(const FilterEstimate& estimate) {
  Model others = estimate.forced.model;
  const BoundEffect& bound = estimate.model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
    const int parameter = bound.coefficients[c].parameter;
    if (spec.coefficients[c].kind == CoefficientKind::strength && parameter >= 0) others.parameters[parameter].value = 0.0;
  }
  return others;
}

/// The gain of which a strength is a share: by which the input acts on the effect's port; 1 where that is the input itself.
double gain_at_port(const FilterEstimate& estimate, const Model& others, const BoundEffect& bound, int quantity) {
  const int port = bound.ports.front();
  if (bound.kind == PortKind::dynamic) return gain_of_input(estimate, others, quantity, port);
  const SystemSpec& system = others.system->spec();
  const int input = others.input_of_quantity(quantity);
  const bool itself =
      bound.kind == PortKind::quantity && port >= 0 && input >= 0 && system.quantity_ports[port].name == system.inputs[input].name;
  return itself ? 1.0 : 0.0;
}

}  // namespace

std::vector<WholeStrength> whole_strengths(const FilterEstimate& estimate) {
  const Model others = without_last_effect(estimate);
  const BoundEffect& bound = estimate.model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  std::vector<WholeStrength> out;
  for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
    const int parameter = bound.coefficients[c].parameter;
    double value = spec.coefficients[c].whole;
    if (parameter < 0 || value == 0.0) continue;
    const std::string_view of = spec.coefficients[c].whole_of;
    const auto input = std::find_if(spec.quantities.begin(), spec.quantities.end(), [&](const Role& role) { return of == role.name; });
    if (!of.empty()) {
      value *=
          input == spec.quantities.end() ? 0.0 : gain_at_port(estimate, others, bound, bound.quantities[input - spec.quantities.begin()]);
    }
    if (value != 0.0) out.push_back({parameter, value});
  }
  return out;
}

std::optional<std::string> idle_input(const FilterEstimate& estimate) {
  const BoundEffect& bound = estimate.model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  const auto share =
      std::find_if(spec.coefficients.begin(), spec.coefficients.end(), [](const CoefficientSpec& c) { return c.whole_of[0] != '\0'; });
  if (share == spec.coefficients.end()) return std::nullopt;
  const auto role = std::find_if(spec.quantities.begin(), spec.quantities.end(),
                                 [&](const Role& r) { return std::string_view(share->whole_of) == r.name; });
  const Model others = without_last_effect(estimate);
  const int input = role == spec.quantities.end() ? -1 : number_of_input(others, bound.quantities[role - spec.quantities.begin()]);
  if (input < 0) return std::nullopt;
  InputStep step(others, input, small_step(estimate, input));
  const Eigen::Index first_own = estimate.model.system_states() + bound.first_state, own = std::ssize(spec.states);
  bool acts = false;
  at_some_samples(estimate, [&](const auto& x, const double* u, double t) {
    Eigen::VectorXd rates = step.of_rates(x, u, t);
    rates.segment(first_own, own).setZero();
    acts = acts || !rates.isZero(0.0) || !step.of_outputs(x, u, t).isZero(0.0);
  });
  return acts ? std::nullopt : std::optional<std::string>(others.system->spec().inputs[input].name);
}

std::optional<ModelRequest> on_its_input(const Model& model, const ModelRequest& request) {
  const BoundEffect& bound = model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  const SystemSpec& system = model.system->spec();
  const auto of_input = std::find_if(spec.coefficients.begin(), spec.coefficients.end(),
                                     [](const CoefficientSpec& c) { return c.whole != 0.0 && c.whole_of[0] != '\0'; });
  if (of_input == spec.coefficients.end() || spec.ports.size() != 1 || bound.kind != PortKind::dynamic) return std::nullopt;
  const auto role = std::find_if(spec.quantities.begin(), spec.quantities.end(),
                                 [&](const Role& r) { return std::string_view(of_input->whole_of) == r.name; });
  const int quantity = role == spec.quantities.end() ? -1 : bound.quantities[role - spec.quantities.begin()];
  if (quantity < 0 || quantity >= int_size(system.quantities)) return std::nullopt;
  const int number = model.input_of_quantity(quantity);
  if (number < 0 || index_of(system.quantity_ports, system.inputs[number].name) < 0) return std::nullopt;
  const std::string& input = system.inputs[number].name;
  ModelRequest out = request;
  out.effects.back().roles[role->name] = input;
  out.effects.back().roles[spec.ports.front().name] = input;
  return out;
}

}  // namespace misfit
