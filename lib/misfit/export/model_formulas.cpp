#include "misfit/export/model_formulas.h"

#include <algorithm>

#include "misfit/core/lists.h"
#include "misfit/formula/symbol.h"

namespace misfit {
namespace {

using formula::Symbol;
using Symbols = std::vector<Symbol>;
using Nodes = std::vector<int>;

Symbols symbols_of(const Nodes& nodes) {
  Symbols out;
  for (const int node : nodes) out.push_back(Symbol::of_node(node));
  return out;
}

class Builder {
 public:
  explicit Builder(const Model& model) : model_(model), system_(*model.system) {
    out_.states = model.states();
    out_.late = model.late_inputs();
    out_.inputs = model.inputs() + int_size(out_.late);
    out_.parameters = int_size(model.parameters);
  }

  ModelFormulas run() {
    out_.lack = lack();
    if (!out_.lack.empty()) return std::move(out_);
    find_quantities();
    const Nodes forces = add_effects(PortKind::dynamic, zeros(system_.spec().dynamic_ports.size()));
    out_.rates = trace(model_.system_states(), [&](Symbol* dx) { system_.trace_rates(point(), symbols_of(forces).data(), dx); });
    find_outputs();
    out_.rates.insert(out_.rates.end(), drifts_.begin(), drifts_.end());
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string lack() const {
    if (!system_.traceable())
      return "the equations of system '" + system_.spec().key +
             "', as the study sets it up, are compiled C++ that cannot be read back as formulas";
    for (const BoundEffect& bound : model_.effects) {
      if (!traceable(*bound.effect)) return "effect '" + bound.name + "' is compiled C++ that cannot be read back as a formula";
    }
    return {};
  }
  static bool traceable(const Effect& effect) {
    const EffectSpec& spec = effect.spec();
    formula::Graph graph;
    bool can = false;
    const Symbols reads(spec.quantities.size() + spec.coefficients.size() + spec.states.size() + spec.constants.size(), 1.0);
    const std::size_t results = spec.ports.size() + spec.states.size();
    static_cast<void>(formula::trace(graph, results, [&](Symbol* out) {
      can = effect.trace({reads.data(), reads.data(), reads.data(), reads.data(), 1.0}, out);
    }));
    return can;
  }

  Nodes trace(std::size_t count, const std::function<void(Symbol*)>& formula) { return formula::trace(out_.graph, count, formula); }
  Nodes zeros(std::size_t count) { return Nodes(count, out_.graph.constant(0.0)); }
  Nodes leaves(int first, int count) {
    Nodes out;
    for (int i = 0; i < count; ++i) out.push_back(out_.graph.leaf(first + i));
    return out;
  }

  /// Where the system is evaluated: kept alive by the members.
  SymbolPoint point() {
    x_ = symbols_of(leaves(0, model_.system_states()));
    u_ = symbols_of(leaves(out_.input(0), out_.inputs));
    k_ = symbols_of(leaves(out_.parameter(0), int_size(system_.spec().constants)));
    P_ = symbols_of(quantity_ports_);
    return {x_.data(), u_.data(), Symbol::of_node(out_.graph.leaf(out_.time())), k_.data(), P_.data()};
  }

  /// Base quantities, what effects add to quantity ports, then all quantities.
  void find_quantities() {
    drifts_ = zeros(model_.own_states.size());
    quantity_ports_ = zeros(system_.spec().quantity_ports.size());
    quantities_ = quantities();
    quantity_ports_ = add_effects(PortKind::quantity, quantity_ports_);
    quantities_ = quantities();
    // Memory of these effects sees all quantities, as in Evaluator::own_drifts.
    static_cast<void>(add_effects(PortKind::quantity, quantity_ports_));
  }
  Nodes quantities() {
    return trace(system_.spec().quantities.size(), [&](Symbol* q) { system_.trace_quantities(point(), q); });
  }

  void find_outputs() {
    Nodes outputs = trace(model_.outputs(), [&](Symbol* y) { system_.trace_outputs(point(), y); });
    quantities_.insert(quantities_.end(), outputs.begin(), outputs.end());
    const std::vector<OutputSpec>& specs = system_.spec().outputs;
    outputs.resize(2 * specs.size() + 1, out_.graph.constant(0.0));
    outputs = add_effects(PortKind::sensor, outputs);
    for (std::size_t i = specs.size(); i < outputs.size(); ++i) {
      if (out_.graph.is(outputs[i], 0.0)) continue;
      const std::string name = i == specs.size() ? all_sample_times : sample_time_of(specs[i - specs.size() - 1].name);
      out_.sample_times.emplace_back(name, outputs[i]);
    }
    outputs.resize(specs.size());
    out_.outputs = std::move(outputs);
  }

  /// `targets` with what the effects of that kind add; their memory's drifts are kept.
  Nodes add_effects(PortKind kind, Nodes targets) {
    for (const BoundEffect& bound : model_.effects) {
      if (bound.kind != kind) continue;
      const Nodes results = results_of(bound);
      for (int i = 0; i < int_size(bound.ports); ++i) {
        if (bound.ports[i] >= 0) targets[bound.ports[i]] = out_.graph.add(targets[bound.ports[i]], results[i]);
      }
      for (int i = 0; i < int_size(bound.effect->spec().states); ++i) drifts_[bound.first_state + i] = results[bound.ports.size() + i];
    }
    return targets;
  }

  /// Ports first, then drifts of own states.
  Nodes results_of(const BoundEffect& bound) {
    Nodes q, c, k;
    for (const int quantity : bound.quantities) q.push_back(quantity < 0 ? out_.graph.constant(0.0) : quantities_[quantity]);
    for (const BoundCoefficient& coefficient : bound.coefficients)
      c.push_back(coefficient.curve < 0 ? out_.graph.leaf(out_.parameter(coefficient.parameter)) : curve_leaf(coefficient.curve));
    const Nodes z = leaves(model_.system_states() + bound.first_state, int_size(bound.effect->spec().states));
    for (const int constant : bound.constants) k.push_back(out_.graph.leaf(out_.parameter(constant)));
    const int time = out_.graph.leaf(out_.time());
    return trace(bound.ports.size() + z.size(), [&](Symbol* out) {
      const Symbols reads_q = symbols_of(q), reads_c = symbols_of(c), reads_z = symbols_of(z), reads_k = symbols_of(k);
      const Symbols late = late_or_now(bound, reads_q);
      static_cast<void>(bound.effect->trace(
          {reads_q.data(), reads_c.data(), reads_z.data(), reads_k.data(), Symbol::of_node(time), {nullptr, nullptr, late.data()}}, out));
    });
  }

  /// Of what an effect reads: the input that stands for its past, else what it is.
  Symbols late_or_now(const BoundEffect& bound, Symbols out) {
    for (int i = 0; i < int_size(out_.late); ++i) {
      const LateInputUse& use = out_.late[i];
      if (&model_.effects[use.effect] == &bound) out[use.quantity] = Symbol::of_node(out_.graph.leaf(out_.input(model_.inputs() + i)));
    }
    return out;
  }

  int curve_leaf(int curve) {
    const int argument = quantities_[model_.curves[curve].quantity];
    auto& uses = out_.curve_uses;
    const auto known = std::find_if(uses.begin(), uses.end(),
                                    [&](const ModelFormulas::CurveUse& use) { return use.curve == curve && use.argument == argument; });
    const auto place = static_cast<int>(known - uses.begin());
    if (known == uses.end()) uses.push_back({curve, argument});
    return out_.graph.leaf(out_.first_curve() + place);
  }

  const Model& model_;
  const System& system_;
  ModelFormulas out_;
  Nodes quantities_, quantity_ports_, drifts_;
  Symbols x_, u_, k_, P_;
};

}  // namespace

ModelFormulas model_formulas(const Model& model) { return Builder(model).run(); }

}  // namespace misfit
