#include "misfit/model/declared_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/model/declared.h"
#include "misfit/model/limits.h"

namespace misfit::declared {
namespace {

using Registers = std::array<double, formula::kMaxRegisters>;  // not initialised: the program fills what it reads

constexpr std::array<double, kMaxPorts> no_forces{};

class DeclaredSystem final : public System {
 public:
  explicit DeclaredSystem(std::shared_ptr<const Compiled> compiled) : c_(std::move(compiled)) {
    constexpr int with_own_bit = 63;
    const int plain = int_size(c_->spec.states) + 2 * int_size(c_->spec.inputs);
    for (int i = 0; i < std::min(plain, with_own_bit); ++i) plain_ |= needed_bit(i);
    spec_ = c_->spec;
    if (!(spec_.fastest_rate > 0.0)) spec_.fastest_rate = nominal_rate();
    find_rates_of_quantities();
  }

  [[nodiscard]] const SystemSpec& spec() const override { return spec_; }

  void quantities(const Point& at, std::uint64_t needed, double* q) const override {
    if ((needed & ~plain_) == 0U) return plain(at, needed, q);
    Registers r;
    run(c_->quantities, at, no_forces.data(), r);
    write(c_->quantities.value, r, q);
  }

  void linearise_quantities(const Point& at, std::uint64_t needed, double* q, const QuantityDerivatives& d) const override {
    if (needed == 0U) return;
    const Tape& tape = d.P != nullptr ? c_->quantities_all : d.k != nullptr ? c_->quantities_k : c_->quantities_x;
    const std::size_t rows = spec_.quantities.size();
    Registers r;
    run(tape, at, no_forces.data(), r);
    write(tape.value, r, q);
    block(tape.by_x, r, rows * spec_.states.size(), d.x);
    block(tape.by_P, r, rows * spec_.quantity_ports.size(), d.P);
    block(tape.by_k, r, rows * spec_.constants.size(), d.k);
  }

  void rates(const Point& at, const double* F, double* dx) const override {
    Registers r;
    run(c_->rates, at, F, r);
    write(c_->rates.value, r, dx);
  }

  void linearise_rates(const Point& at, const double* F, double* dx, const RateDerivatives& d) const override {
    const Tape& tape = d.P != nullptr ? c_->rates_all : d.k != nullptr ? c_->rates_k : c_->rates_x;
    const std::size_t rows = spec_.states.size();
    Registers r;
    run(tape, at, F, r);
    write(tape.value, r, dx);
    block(tape.by_x, r, rows * rows, d.x);
    block(tape.by_F, r, rows * spec_.dynamic_ports.size(), d.F);
    block(tape.by_P, r, rows * spec_.quantity_ports.size(), d.P);
    block(tape.by_k, r, rows * spec_.constants.size(), d.k);
  }

  void outputs(const Point& at, double* y) const override {
    Registers r;
    run(c_->outputs, with_ports(at), no_forces.data(), r);
    write(c_->outputs.value, r, y);
  }

  void linearise_outputs(const Point& at, double* y, const OutputDerivatives& d) const override {
    const Tape& tape = d.P != nullptr ? c_->outputs_all : d.k != nullptr ? c_->outputs_k : c_->outputs_x;
    const std::size_t rows = spec_.outputs.size();
    Registers r;
    run(tape, with_ports(at), no_forces.data(), r);
    write(tape.value, r, y);
    block(tape.by_x, r, rows * spec_.states.size(), d.x);
    block(tape.by_P, r, rows * spec_.quantity_ports.size(), d.P);
    block(tape.by_k, r, rows * spec_.constants.size(), d.k);
  }

  [[nodiscard]] bool traceable() const override { return true; }
  void trace_quantities(const SymbolPoint& at, formula::Symbol* q) const override { trace(c_->quantities, leaves_of(at, nullptr), q); }
  void trace_rates(const SymbolPoint& at, const formula::Symbol* F, formula::Symbol* dx) const override {
    trace(c_->rates, leaves_of(at, F), dx);
  }
  void trace_outputs(const SymbolPoint& at, formula::Symbol* y) const override { trace(c_->outputs, leaves_of(at, nullptr), y); }

  bool read_states(const double* y, const double* k, double* x) const override {
    const std::array<double, kMaxStates> zero{};
    std::array<double, kMaxOutputs> y0{};
    std::array<double, std::size_t{kMaxOutputs} * kMaxStates> slope{};
    linearise_outputs({zero.data(), zero.data(), 0.0, k}, y0.data(), {.x = slope.data()});
    bool known = true;
    for (const auto& [output, state] : c_->readable) {
      const double by = slope[output * spec_.states.size() + state];
      known = known && by != 0.0;
      x[state] = known ? (y[output] - y0[output]) / by : 0.0;
    }
    return known && !c_->readable.empty();
  }

  /// From the Jacobian, every smoothed jump at its steepest: the largest |J_ii| and sqrt|J_ij J_ji|. A state near a bound is taken a
  /// twentieth of its scale inside, where a root has a slope.
  [[nodiscard]] double fastest_rate(const Point& at) const override {
    const int n = int_size(spec_.states);
    std::array<double, kMaxStates> x{}, dx{};
    for (std::size_t i = 0; i < spec_.states.size(); ++i) {
      const StateSpec& state = spec_.states[i];
      constexpr double inside = 0.05;
      x[i] = std::isfinite(at.x[i]) ? at.x[i] : 0.0;
      if (std::isfinite(state.lower)) x[i] = std::max(x[i], state.lower + inside * state.scale);
      if (std::isfinite(state.upper)) x[i] = std::min(x[i], state.upper - inside * state.scale);
    }
    Registers r;
    std::array<double, std::size_t{kMaxStates} * kMaxStates> J;
    run(c_->rates_steep, without_ports({x.data(), at.u, at.t, at.k}), no_forces.data(), r);
    write(c_->rates_steep.value, r, dx.data());
    block(c_->rates_steep.by_x, r, spec_.states.size() * spec_.states.size(), J.data());
    double fastest = c_->spec.fastest_rate;
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) {
        const double both = std::sqrt(std::abs(J[i * n + j] * J[j * n + i]));
        if (std::isfinite(both)) fastest = std::max(fastest, both);
      }
    }
    return fastest;
  }

  [[nodiscard]] std::string explain(const Point& at, const double* F) const override {
    Registers r;
    run(c_->rates, at, F, r);
    for (std::size_t row = 0; row < spec_.states.size(); ++row) {
      const formula::Program::Step* step = c_->rates.program.culprit(row, r.data());
      if (step == nullptr) continue;
      const std::string part = text_of(c_->graph.node(step->node).origin);
      if (part.empty()) continue;
      return values_of(step->node, at, false) + ": " + part + " is not finite there, in equation " + spec_.states[row].name +
             (values_of(c_->rate_nodes[row], at, true).empty() ? "" : "; with " + values_of(c_->rate_nodes[row], at, true));
    }
    return {};
  }

 private:
  static Point without_ports(const Point& at) { return {at.x, at.u, at.t, at.k, no_forces.data()}; }
  static Point with_ports(const Point& at) { return at.P == nullptr ? without_ports(at) : at; }
  void run(const Tape& tape, const Point& at, const double* F, Registers& r) const {
    const Leaves& n = c_->leaves;
    double* to = r.data();
    for (int i = 0; i < n.nx; ++i) *to++ = at.x[i];
    for (int i = 0; i < n.nu; ++i) *to++ = at.u[i];
    *to++ = at.t;
    for (int i = 0; i < n.nk; ++i) *to++ = at.k[i];
    for (int i = 0; i < n.np; ++i) *to++ = at.P[i];
    for (int i = 0; i < n.nf; ++i) *to++ = F[i];
    tape.program.run(r.data());
  }
  /// Ports that are not given are 0.
  [[nodiscard]] std::vector<formula::Symbol> leaves_of(const SymbolPoint& at, const formula::Symbol* F) const {
    const Leaves& n = c_->leaves;
    std::vector<formula::Symbol> all(at.x, at.x + n.nx);
    all.insert(all.end(), at.u, at.u + n.nu);
    all.push_back(at.t);
    all.insert(all.end(), at.k, at.k + n.nk);
    const auto add = [&all](const formula::Symbol* ports, int count) {
      for (int i = 0; i < count; ++i) all.push_back(ports == nullptr ? formula::Symbol() : ports[i]);
    };
    add(at.P, n.np);
    add(F, n.nf);
    return all;
  }
  static void trace(const Tape& tape, std::vector<formula::Symbol> leaves, formula::Symbol* to) {
    const std::vector<formula::Symbol> roots = tape.program.trace(std::move(leaves));
    std::copy_n(roots.begin(), tape.value.size(), to);
  }
  static void write(const std::vector<Tape::Entry>& entries, const Registers& r, double* to) {
    for (const Tape::Entry& e : entries) to[e.place] = r[e.from];
  }
  static void block(const std::vector<Tape::Entry>& entries, const Registers& r, std::size_t size, double* to) {
    if (to == nullptr) return;
    std::fill_n(to, size, 0.0);
    write(entries, r, to);
  }

  /// States and inputs alone, without a program.
  void plain(const Point& at, std::uint64_t needed, double* q) const {
    if (needed == 0U) return;
    const Leaves& n = c_->leaves;
    for (int i = 0; i < n.nx; ++i) {
      const StateSpec& state = spec_.states[i];
      q[i] = std::min(std::max(at.x[i], state.lower), state.upper);
    }
    for (int i = 0; i < n.nu; ++i) {
      q[n.nx + i] = at.u[i];
      q[n.nx + n.nu + i] = at.u[i] + at.P[i];
    }
  }

  /// At the initial values, or the scales, with the nominal parameters and inputs of size 1.
  double nominal_rate() const {
    std::vector<double> x, u(spec_.inputs.size() + 1, 1.0), k;
    for (const auto& state : spec_.states) {
      const double offset = std::isfinite(state.lower) ? state.lower : 0.0;
      x.push_back(std::isfinite(state.start) ? state.start : std::min(offset + state.scale, state.upper));
    }
    for (const auto& constant : spec_.constants) k.push_back(constant.required ? 1.0 : constant.value);
    k.push_back(0.0);
    return fastest_rate({x.data(), u.data(), 0.0, k.data()});
  }

  /// States, inputs and parameters near their sizes, another for each `number`.
  struct Place {
    std::vector<double> x, u, k;
  };
  Place some_place(unsigned number) const {
    std::mt19937 random(number);
    const auto share = [&random] { return 0.1 + 0.8 * std::generate_canonical<double, 53>(random); };
    Place out;
    for (const auto& state : spec_.states) {
      const double low = std::isfinite(state.lower) ? state.lower : std::isfinite(state.start) ? state.start : 0.0;
      out.x.push_back(std::min(low + share() * state.scale, state.upper));
    }
    for (std::size_t i = 0; i < spec_.inputs.size(); ++i) out.u.push_back(share());
    for (const auto& constant : spec_.constants) out.k.push_back(constant.required || constant.value == 0.0 ? share() : constant.value);
    out.u.push_back(0.0);
    out.k.push_back(0.0);
    return out;
  }

  /// Which quantities are rates of others, as the equations say: dq/dt = q_x x' at some places, forces off.
  void find_rates_of_quantities() {
    constexpr unsigned places = 3;
    constexpr double rounding = 1e-9;
    const std::size_t first = spec_.states.size() + 2 * spec_.inputs.size(), count = spec_.quantities.size(), states = spec_.states.size();
    std::vector<std::vector<bool>> is_rate(count, std::vector<bool>(count, true));  // of [rate][moved]
    for (unsigned number = 0; number < places; ++number) {
      const Place place = some_place(number);
      const Point at{place.x.data(), place.u.data(), 0.0, place.k.data(), no_forces.data()};
      std::vector<double> q(count), slope(count * states), dx(states);
      linearise_quantities(at, ~std::uint64_t{0}, q.data(), {slope.data(), nullptr, nullptr});
      rates(at, no_forces.data(), dx.data());
      for (std::size_t moved = 0; moved < count; ++moved) {
        double rate = 0.0, size = 0.0;
        for (std::size_t j = 0; j < states; ++j) {
          rate += slope[moved * states + j] * dx[j];
          size += std::abs(slope[moved * states + j] * dx[j]);
        }
        for (std::size_t i = first; i < count; ++i)
          is_rate[i][moved] = is_rate[i][moved] && size > 0.0 && std::abs(q[i] - rate) < rounding * size;
      }
    }
    for (std::size_t i = first; i < count; ++i) {
      const auto moved = std::find(is_rate[i].begin(), is_rate[i].end(), true);
      if (moved != is_rate[i].end()) spec_.quantities[i].rate_of = spec_.quantities[moved - is_rate[i].begin()].name;
    }
  }

  /// The part of a formula that made a node.
  std::string text_of(int origin) const {
    if (origin < 0) return {};
    const auto next = std::upper_bound(c_->first_origin.begin(), c_->first_origin.end(), origin);
    const auto which = next - c_->first_origin.begin() - 1;
    const formula::Syntax& syntax = c_->texts[which];
    const auto& e = syntax.nodes[origin - c_->first_origin[which]];
    return syntax.source.text.substr(e.begin, e.end - e.begin);
  }

  /// "x1 is -0.2 V, u is 3 V", or "k1 = 0.05 V^0.5/s": what a node depends on.
  std::string values_of(int node, const Point& at, bool constants) const {
    const Leaves& n = c_->leaves;
    std::vector<int> leaves = c_->graph.leaves_of(node);
    std::sort(leaves.begin(), leaves.end());
    std::string out;
    const auto say = [&](const std::string& name, const char* is, double value, const std::string& unit) {
      out += (out.empty() ? "" : ", ") + name + is + format_value(value) + (unit == "-" ? "" : " " + plain_si(unit));
    };
    for (int leaf : leaves) {
      if (!constants && leaf < n.u(0)) {
        const StateSpec& state = spec_.states[leaf];
        say(state.name, " is ", at.x[leaf], state.unit);
      } else if (!constants && leaf < n.t()) {
        const InputSpec& input = spec_.inputs[leaf - n.u(0)];
        say(input.name, " is ", at.u[leaf - n.u(0)], input.unit);
      } else if (leaf >= n.k(0) && leaf < n.P(0) && constants) {
        const ConstantSpec& constant = spec_.constants[leaf - n.k(0)];
        say(constant.name, " = ", at.k[leaf - n.k(0)], constant.unit);
      }
    }
    return out;
  }

  std::shared_ptr<const Compiled> c_;
  SystemSpec spec_;
  std::uint64_t plain_ = 0;
};

}  // namespace

std::unique_ptr<System> make_system(std::shared_ptr<const Compiled> compiled) {
  return std::make_unique<DeclaredSystem>(std::move(compiled));
}

}  // namespace misfit::declared

namespace misfit {

SystemType declared_system(const std::string& text, const std::string& file, const std::string& key,
                           const std::map<std::string, HoldStudy>& holds) {
  declared::Declaration declaration = declared::read(text, file, key);
  for (const auto& [name, study] : holds) declared::set_hold(declaration, name, study);
  const auto compiled = declared::compile(std::move(declaration));
  return {key, {}, [compiled](const SystemOptions&) { return declared::make_system(compiled); }};
}

void register_declared(Registry& registry, const char* key, const char* text) {
  registry.add(declared_system(text, std::string(key) + ".toml", key));
}

}  // namespace misfit
