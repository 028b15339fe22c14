// From a declaration to programs: what names stand for, units, derivatives, and what the rest of misfit wants to know of a system.

#include <algorithm>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/model/declared.h"
#include "misfit/model/declared_system.h"
#include "misfit/model/limits.h"

namespace misfit::declared {
namespace {

using formula::Meaning;
using formula::Op;

class Compiler {
 public:
  /// `varied`: numbers of the constants that are ports, too.
  Compiler(Declaration declaration, std::vector<int> varied)
      : declaration_(std::move(declaration)), out_(std::make_shared<Compiled>()), varied_(std::move(varied)) {}

  std::shared_ptr<const Compiled> run() {
    check_sizes();
    number_leaves();
    build_quantities();
    build_equations();
    build_outputs();
    check_parameters();
    describe_quantities();
    make_tapes(*out_, all_quantity_nodes_, output_nodes_, declaration_.where);
    out_->spec = std::move(declaration_.spec);
    return out_;
  }

  /// Once it has run: numbers of the constants on which an effect acts as no force does. It stands in several equations and outputs; or, in
  /// a small system, what it does depends on states or inputs. As many as there is room for.
  std::vector<int> constants_that_may_vary() {
    std::vector<int> nodes = equation_nodes_, out;
    nodes.insert(nodes.end(), output_nodes_.begin(), output_nodes_.end());
    const std::size_t room = kMaxPorts - out_->spec.quantity_ports.size();
    for (int k = 0; k < out_->leaves.nk && out.size() < room; ++k) {
      const int leaf = out_->leaves.k(k);
      int places = 0;
      bool depends = false;
      for (const int node : nodes) {
        if (!uses(node, leaf)) continue;
        ++places;
        depends = depends || depends_on_motion(graph().derivatives(node, {graph().leaf(leaf)}).front());
      }
      const bool of_output = index_of(out_->spec.outputs, out_->spec.constants[k].name) >= 0;
      if (!of_output && (places > 1 || (depends && out_->spec.states.size() <= states_of_a_small_system))) out.push_back(k);
    }
    return out;
  }

 private:
  formula::Graph& graph() { return out_->graph; }
  SystemSpec& spec() { return declaration_.spec; }

  void check_sizes() {
    const auto limit = [&](std::size_t have, std::size_t most, const char* what) {
      if (have > most)
        throw InputError(declaration_.where, std::to_string(have) + " " + what + "; at most " + std::to_string(most) + " are possible");
    };
    limit(spec().states.size(), kMaxStates, "states");
    limit(spec().inputs.size(), kMaxInputs, "inputs");
    limit(spec().outputs.size(), kMaxOutputs, "outputs");
    limit(spec().constants.size(), kMaxConstants, "parameters");
    limit(spec().dynamic_ports.size() + spec().states.size(), kMaxPorts, "ports and states");
    limit(spec().inputs.size() + spec().quantities.size(), kMaxPorts, "inputs and quantities");
  }

  void number_leaves() {
    Leaves& n = out_->leaves;
    n.nx = int_size(spec().states);
    n.nu = int_size(spec().inputs);
    n.nk = int_size(spec().constants);
    n.np = n.nu + int_size(spec().quantities) + int_size(varied_);
    own_ports_ = int_size(spec().dynamic_ports);
    n.nf = own_ports_ + n.nx;
    for (const auto& state : spec().states) {
      spec().dynamic_ports.push_back({.name = "d" + state.name + "/dt",
                                      .unit = rate_unit(state.unit),
                                      .doc = "added to the rate of " + state.name,
                                      .conjugate = state.name});
    }
    for (int i = 0; i < n.nx; ++i) state_nodes_.push_back(state_node(i));
    for (int i = 0; i < n.nu; ++i) input_nodes_.push_back(graph().add(graph().leaf(n.u(i)), graph().leaf(n.P(i))));
    for (int i = 0; i < n.nk; ++i) {
      const int port = place_of(varied_, i), own = graph().leaf(n.k(i));
      constant_nodes_.push_back(port < 0 ? own : graph().add(own, graph().leaf(n.P(n.np - int_size(varied_) + port))));
    }
    quantity_nodes_.assign(spec().quantities.size(), unbuilt);
    note_names(spec().states);
    note_names(spec().inputs);
    note_names(spec().constants);
    note_names(spec().quantities);
    for (int i = 0; i < own_ports_; ++i) names_.push_back(spec().dynamic_ports[i].name);
    names_.emplace_back("t");
    names_.emplace_back("pi");
  }
  bool depends_on_motion(int node) {
    const std::vector<int> leaves = graph().leaves_of(node);
    return std::any_of(leaves.begin(), leaves.end(), [&](int leaf) { return leaf < out_->leaves.t(); });
  }
  template <class List>
  void note_names(const List& list) {
    for (const auto& item : list) names_.push_back(item.name);
  }

  /// Formulas never see a state outside its range, not even inside a step.
  int state_node(int i) {
    const StateSpec& state = spec().states[i];
    int node = graph().leaf(out_->leaves.x(i));
    if (std::isfinite(state.lower)) node = graph().make(Op::max, node, graph().constant(state.lower));
    if (std::isfinite(state.upper)) node = graph().make(Op::min, node, graph().constant(state.upper));
    return node;
  }

  /// Of those ports that the file declares; −1: none of them.
  int own_port(const std::string& name) {
    const int port = index_of(spec().dynamic_ports, name);
    return port < own_ports_ ? port : -1;
  }

  std::optional<Meaning> find(const std::string& name) {
    const auto at = [](const auto& list, int i) -> const auto& { return list[i]; };
    if (name == "t") return Meaning{graph().leaf(out_->leaves.t()), formula::measure_of("s")};
    if (const int i = index_of(spec().states, name); i >= 0)
      return Meaning{at(state_nodes_, i), formula::measure_of(at(spec().states, i).unit)};
    if (const int i = index_of(spec().inputs, name); i >= 0)
      return Meaning{at(input_nodes_, i), formula::measure_of(at(spec().inputs, i).unit)};
    if (const int i = index_of(spec().constants, name); i >= 0)
      return Meaning{at(constant_nodes_, i), formula::measure_of(at(spec().constants, i).unit)};
    if (const int i = index_of(spec().quantities, name); i >= 0)
      return Meaning{quantity_node(i), formula::measure_of(at(spec().quantities, i).unit)};
    const int port = own_port(name);
    if (port < 0) return std::nullopt;
    return Meaning{graph().leaf(out_->leaves.F(port)), formula::measure_of(at(spec().dynamic_ports, port).unit)};
  }

  int build(const Formula& f, bool in_equation) {
    const formula::Names names{[this](const std::string& name) { return find(name); }, names_,
                               [this, in_equation](const std::string& name) {
                                 const bool port = !in_equation && own_port(name) >= 0;
                                 return port ? "'" + shown(name) + "' is a port: it can stand in equations only" : std::string();
                               }};
    const int origin = next_origin_;
    next_origin_ += int_size(f.syntax.nodes);
    out_->texts.push_back(f.syntax);
    out_->first_origin.push_back(origin);
    const Meaning made = formula::build(f.syntax, names, graph(), origin);
    formula::check_unit(f.syntax, made, f.measure, f.syntax.source.of);
    return made.node;
  }

  /// Built when first asked for, so that quantities may stand in any order.
  int quantity_node(int i) {
    int& node = quantity_nodes_[i];
    if (node == in_work)
      throw InputError(declaration_.quantities[i].syntax.source.where, "quantity " + spec().quantities[i].name + " depends on itself");
    if (node == unbuilt) {
      node = in_work;
      const int own = build(declaration_.quantities[i], false);
      quantity_nodes_[i] = graph().add(own, graph().leaf(out_->leaves.P(out_->leaves.nu + i)));
    }
    return quantity_nodes_[i];
  }
  void build_quantities() {
    for (int i = 0; i < int_size(quantity_nodes_); ++i) static_cast<void>(quantity_node(i));
  }

  void build_equations() {
    const Leaves& n = out_->leaves;
    auto& states = spec().states;
    for (int j = 0; j < int_size(states); ++j) {
      const int node = build(declaration_.equations[j], true);
      const int same = place_of(state_nodes_, node);
      kinematic_.push_back(same >= 0 && same != j);
      if (kinematic_.back() && states[same].rate_of < 0) states[same].rate_of = j;
      equation_nodes_.push_back(node);
      out_->rate_nodes.push_back(graph().add(node, graph().leaf(n.F(own_ports_ + j))));
      note_inputs(node);
    }
    check_rates();
    for (std::size_t j = 0; j < states.size(); ++j) {
      if (!kinematic_[j]) spec().force_ports.push_back("d" + states[j].name + "/dt");
    }
  }

  void check_rates() {
    const auto& states = spec().states;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const int of = states[i].rate_of;
      if (of < 0 || equation_nodes_[of] == state_nodes_[i]) continue;
      throw InputError(declaration_.equations[of].syntax.source.where,
                       "the equation of '" + shown(states[of].name) + "' is not '" + shown(states[i].name) +
                           "', which says that it is its rate: " + "leave the equation out, or take rate_of out of '" +
                           shown(states[i].name) + "'");
    }
  }

  void note_inputs(int node) {
    for (const auto& name : inputs_of(node)) {
      auto& list = spec().equation_inputs;
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    }
  }
  std::vector<std::string> inputs_of(int node) {
    const Leaves& n = out_->leaves;
    std::vector<std::string> names;
    for (int leaf : graph().leaves_of(node)) {
      if (leaf >= n.u(0) && leaf < n.t()) names.push_back(spec().inputs[leaf - n.u(0)].name);
    }
    return names;
  }

  /// Which state an output observes is found without effects: what they add to the quantities is 0.
  void build_outputs() {
    for (int o = 0; o < int_size(declaration_.outputs); ++o) {
      const int node = build(declaration_.outputs[o], false), plain = without_quantity_ports(node);
      if (const int same = place_of(state_nodes_, plain); same >= 0) spec().outputs[o].observes = same;
      output_nodes_.push_back(node);
      note_inputs(plain);
      note_readable(o, plain);
    }
  }

  int without_quantity_ports(int node) {
    const Leaves& n = out_->leaves;
    for (int i = 0; i < n.np; ++i) node = graph().substitute(node, n.P(i), graph().constant(0.0));
    return node;
  }

  /// An output that is a straight line of one state, as theta + offset: the state can be read from it.
  void note_readable(int output, int node) {
    const Leaves& n = out_->leaves;
    if (spec().outputs[output].observes >= 0) return;
    int state = -1;
    for (int leaf : graph().leaves_of(node)) {
      if (leaf >= n.k(0) && leaf < n.P(0)) continue;
      if (state >= 0 || leaf >= n.nx) return;
      state = leaf;
    }
    if (state < 0) return;
    const int slope = graph().derivatives(node, {graph().leaf(state)}).front();
    if (graph().is(slope, 0.0) || uses(slope, state)) return;  // steps of the state, or a curve
    out_->readable.emplace_back(output, state);
    spec().readable_states.push_back(state);
  }

  bool uses(int node, int leaf) {
    const auto all = graph().leaves_of(node);
    return std::find(all.begin(), all.end(), leaf) != all.end();
  }

  void check_parameters() {
    for (int k = 0; k < out_->leaves.nk; ++k) {
      ConstantSpec& constant = spec().constants[k];
      const int leaf = out_->leaves.k(k);
      const auto used_by = [&](const std::vector<int>& nodes) {
        return std::any_of(nodes.begin(), nodes.end(), [&](int node) { return uses(node, leaf); });
      };
      const bool moves = used_by(equation_nodes_) || used_by(quantity_nodes_);
      if (!moves && !used_by(output_nodes_))
        throw InputError(declaration_.where,
                         "nothing depends on parameter '" + shown(constant.name) + "': use it in a formula, or take it out");
      constant.of_sensor = !moves;
      constant.strength = moves;
      for (int node : equation_nodes_) {
        const std::vector<int> slope = graph().derivatives(node, {graph().leaf(leaf)});
        constant.strength = constant.strength && !uses(slope.front(), leaf);
      }
    }
  }

  void describe_quantities() {
    const Leaves& n = out_->leaves;
    std::vector<QuantitySpec> all;
    for (int i = 0; i < n.nx; ++i) {
      const StateSpec& state = spec().states[i];
      add_quantity({.name = state.name, .unit = state.unit, .doc = "state", .carries_sign = true}, state_nodes_[i], all);
    }
    for (int i = 0; i < n.nu; ++i) {
      const InputSpec& input = spec().inputs[i];
      add_quantity({.name = as_recorded(input.name),
                    .unit = input.unit,
                    .doc = "input as recorded",
                    .inputs = {input.name},
                    .carries_sign = true,
                    .explains = false},
                   graph().leaf(n.u(i)), all);
    }
    spec().base_quantities = int_size(all);
    for (int i = 0; i < n.nu; ++i) {
      const InputSpec& input = spec().inputs[i];
      add_quantity({.name = input.name, .unit = input.unit, .doc = "input", .inputs = {input.name}, .carries_sign = true}, input_nodes_[i],
                   all);
      spec().quantity_ports.push_back({.name = input.name, .unit = input.unit, .doc = "added to the input", .conjugate = input.name});
    }
    for (std::size_t i = 0; i < spec().quantities.size(); ++i) {
      QuantitySpec q = spec().quantities[i];
      q.inputs = inputs_of(quantity_nodes_[i]);
      spec().quantity_ports.push_back({.name = q.name, .unit = q.unit, .doc = "added to the quantity", .conjugate = q.name});
      add_quantity(q, quantity_nodes_[i], all);
    }
    for (const int k : varied_) {
      const ConstantSpec& constant = spec().constants[k];
      const Product product = only_product_with(out_->leaves.k(k));
      spec().quantity_ports.push_back({.name = constant.name,
                                       .unit = constant.unit,
                                       .doc = "added to the parameter, wherever it stands",
                                       .conjugate = product.moved,
                                       .multiplies = product.with});
    }
    spec().quantities = std::move(all);
    note_namesakes();
    note_ports_in_outputs();
    if (int_size(spec().quantities) + int_size(spec().outputs) > kMaxQuantities)
      throw InputError(declaration_.where, "states, inputs, quantities and outputs are together too many");
    set_roles(declaration_, own_ports_);
  }
  /// What a parameter multiplies, and the state that the product moves.
  struct Product {
    std::string with, moved;
  };

  /// Of a leaf that does nothing but multiply one state or input, or a function of it, in one equation; `moved` only where it multiplies
  /// that itself, or is a constant; else empty.
  Product only_product_with(int leaf) {
    Product out;
    bool seen = false;
    for (std::size_t j = 0; j < equation_nodes_.size(); ++j) {
      if (!uses(equation_nodes_[j], leaf)) continue;
      if (std::exchange(seen, true)) return {};
      const int slope = graph().derivatives(equation_nodes_[j], {graph().leaf(leaf)}).front();
      std::vector<int> read = graph().leaves_of(slope);
      std::erase_if(read, [&](int other) { return other >= out_->leaves.t(); });
      if (read.size() > 1) return {};
      const int with = read.empty() ? -1 : read.front();
      if (with >= 0) out.with = with < out_->leaves.nx ? spec().states[with].name : spec().inputs[with - out_->leaves.u(0)].name;
      if (with < 0 || !uses(graph().derivatives(slope, {graph().leaf(with)}).front(), with)) out.moved = spec().states[j].name;
    }
    const bool read = std::any_of(output_nodes_.begin(), output_nodes_.end(), [&](int node) { return uses(node, leaf); });
    return read ? Product{} : out;
  }
  void note_namesakes() {
    for (int o = 0; o < int_size(spec().outputs); ++o) {
      OutputSpec& output = spec().outputs[o];
      const int same = index_of(spec().quantities, output.name);
      output.namesake = same >= 0 ? all_quantity_nodes_[same] != output_nodes_[o] : index_of(spec().dynamic_ports, output.name) >= 0;
    }
  }
  void note_ports_in_outputs() {
    for (int i = 0; i < int_size(spec().quantity_ports); ++i) {
      if (std::any_of(output_nodes_.begin(), output_nodes_.end(), [&](int node) { return uses(node, out_->leaves.P(i)); }))
        spec().ports_in_outputs.push_back(spec().quantity_ports[i].name);
    }
  }
  void add_quantity(QuantitySpec q, int node, std::vector<QuantitySpec>& all) {
    all.push_back(std::move(q));
    all_quantity_nodes_.push_back(node);
  }

  static constexpr int unbuilt = -1, in_work = -2;
  Declaration declaration_;
  std::shared_ptr<Compiled> out_;
  std::vector<int> varied_;
  int own_ports_ = 0, next_origin_ = 0;
  std::vector<std::string> names_;
  std::vector<int> state_nodes_, input_nodes_, constant_nodes_, quantity_nodes_, equation_nodes_, output_nodes_, all_quantity_nodes_;
  std::vector<bool> kinematic_;
};

}  // namespace

std::shared_ptr<const Compiled> compile(Declaration declaration) {
  Compiler compiler(declaration, {});
  std::shared_ptr<const Compiled> plain = compiler.run();
  std::vector<int> varied = compiler.constants_that_may_vary();
  if (varied.empty()) return plain;
  try {
    return Compiler(std::move(declaration), std::move(varied)).run();
  } catch (const InputError&) {  // of formulas that are nearly too long: they run, though no parameter may vary
    return plain;
  }
}

}  // namespace misfit::declared
