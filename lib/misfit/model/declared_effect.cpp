#include "misfit/model/declared_effect.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/data/study_parts.h"
#include "misfit/formula/build.h"
#include "misfit/formula/program.h"
#include "misfit/model/declared_parameter.h"
#include "misfit/model/rate_port.h"

namespace misfit {
namespace {

using formula::Meaning;
using formula::Program;

/// Registers: what it reads in the order of a linearisation — quantities, coefficients, constants — then the time.
class FormulaEffect final : public Effect {
 public:
  EffectSpec spec_;
  std::deque<std::string> words_;  ///< what the specification points to
  Program value_, slopes_, steep_;
  int conjugate_ = -1;  ///< quantity whose rate the port adds to

  [[nodiscard]] const EffectSpec& spec() const override { return spec_; }
  [[nodiscard]] std::vector<Example> examples() const override { return {}; }

  void evaluate(const Reads<double, double>& in, double* out) const override {
    Registers r;
    fill(in, r);
    value_.run(r.data());
    out[0] = r[value_.place(0)];
  }
  bool trace(const SymbolReads& in, formula::Symbol* out) const override {
    std::vector<formula::Symbol> leaves(in.q, in.q + spec_.quantities.size());
    leaves.insert(leaves.end(), in.c, in.c + spec_.coefficients.size());
    leaves.insert(leaves.end(), in.k, in.k + spec_.constants.size());
    leaves.push_back(in.t);
    out[0] = value_.trace(std::move(leaves)).front();
    return true;
  }
  void linearise(const Reads<double, double>& in, double* out, double* J, bool constants_too) const override {
    Registers r;
    fill(in, r);
    slopes_.run(r.data());
    out[0] = r[slopes_.place(0)];
    const std::size_t width = spec_.quantities.size() + spec_.coefficients.size() + (constants_too ? spec_.constants.size() : 0);
    for (std::size_t i = 0; i < width; ++i) J[i] = r[slopes_.place(i + 1)];
  }
  [[nodiscard]] double fastest_rate(const Reads<double, double>& in, double /*response*/) const override {
    if (conjugate_ < 0) return 0.0;
    Registers r;
    fill(in, r);
    steep_.run(r.data());
    const double rate = std::abs(r[steep_.place(0)]);
    return std::isfinite(rate) ? rate : 0.0;
  }
  void diffusion(const Reads<double, double>& /*in*/, double* /*out*/) const override {}

 private:
  using Registers = std::array<double, formula::kMaxRegisters>;
  void fill(const Reads<double, double>& in, Registers& r) const {
    double* to = r.data();
    to = std::copy_n(in.q, spec_.quantities.size(), to);
    to = std::copy_n(in.c, spec_.coefficients.size(), to);
    to = std::copy_n(in.k, spec_.constants.size(), to);
    *to = in.t;
  }
};

class FormulaEffectBuilder {
 public:
  FormulaEffectBuilder(const EffectStudy& study, const SystemSpec& system) : study_(study), declared_(*study.declared), system_(system) {}

  std::unique_ptr<Effect> run() {
    const formula::Measure port = port_measure();
    read_coefficients();
    const formula::Syntax syntax = formula::parse({declared_.formula, "effect " + study_.name, declared_.where});
    find_names(syntax);
    const formula::Names names{[this](const std::string& name) { return meaning(name); }, all_names()};
    const Meaning made = formula::build(syntax, names, graph_, 0);
    formula::check_unit(syntax, made, port, "port " + declared_.port);
    choose_strengths(made.node);
    check_used(made.node);
    compile(made.node);
    describe();
    return std::move(effect_);
  }

 private:
  EffectSpec& spec() { return effect_->spec_; }
  const char* keep(const std::string& word) { return effect_->words_.emplace_back(word).c_str(); }

  formula::Measure port_measure() {
    std::vector<std::string> names;
    const auto look = [&](const auto& list) -> const std::string* {
      for (const auto& port : list) {
        names.push_back(port.name);
        if (port.name == declared_.port) return &port.unit;
      }
      return nullptr;
    };
    const std::string* unit = look(system_.dynamic_ports);
    if (unit == nullptr) unit = look(system_.quantity_ports);
    on_sensor_ = unit == nullptr;
    if (!on_sensor_) refuse_namesake(declared_.port);
    if (unit == nullptr) unit = look(system_.outputs);
    if (unit == nullptr)
      throw InputError(study_.where, "effect '" + shown(study_.name) + "': system '" + shown(system_.key) + "' has no port '" +
                                         shown(declared_.port) + "'" + suggest(declared_.port, names));
    spec().ports.push_back({keep(declared_.port), keep(*unit)});
    return formula::measure_of(*unit);
  }

  void read_coefficients() {
    if (!declared_.parameters) return;
    for (const std::string& name : declared_.parameters->keys()) {
      if (!formula::is_name(name)) declared_.parameters->fail(name, "a name has letters, digits and underscores and is no function");
      if (find_quantity(name) != nullptr || find_constant(name) != nullptr)
        declared_.parameters->fail(name, "the system has a '" + shown(name) + "' already");
      const config::DescribedSection s = study_parts::described(*declared_.parameters, name, "effects.NAME.parameters.NAME");
      const declared::ParameterText text = declared::read_parameter(s);
      CoefficientSpec c;
      c.name = keep(name);
      c.kind = CoefficientKind::shape;
      c.unit = keep(declared::shown_unit(text.unit, system_));
      c.value = text.value.value_or(std::clamp(0.0, text.lower, text.upper));
      c.lower = text.lower;
      c.upper = text.upper;
      c.scale = text.scale.value_or(c.value != 0.0 ? std::abs(c.value) : text.sigma.value_or(1.0));
      c.fixed = !text.free;
      c.own_sigma = text.sigma.value_or(0.0);
      c.doc = keep(text.doc.empty() ? "declared in the study" : text.doc);
      measures_.push_back(text.measure);
      s.finish();
      spec().coefficients.push_back(c);
    }
    declared_.parameters->finish();
  }

  /// Of an output that has the name of something else nothing says which is meant.
  void refuse_namesake(const std::string& name) const {
    const int output = index_of(system_.outputs, name);
    if (output < 0 || !system_.outputs[output].namesake) return;
    throw InputError(study_.where, "effect '" + shown(study_.name) + "': '" + shown(name) + "' of system '" + shown(system_.key) +
                                       "' is an output with a formula of its own, and something else as well: call the output otherwise");
  }

  const std::string* find_quantity(const std::string& name) const {
    for (const auto& q : system_.quantities) {
      if (q.name == name) return &q.unit;
    }
    for (const auto& o : system_.outputs) {
      if (on_sensor_ && o.name == name) return &o.unit;
    }
    return nullptr;
  }
  const std::string* find_constant(const std::string& name) const {
    for (const auto& k : system_.constants) {
      if (k.name == name) return &k.unit;
    }
    return nullptr;
  }

  /// Roles and constants: what of the system stands in the formula, each once.
  void find_names(const formula::Syntax& syntax) {
    for (const auto& e : syntax.nodes) {
      if (e.kind != formula::Expression::Kind::name) continue;
      const auto same = [&](const Role& role) { return e.text == role.name; };
      auto& roles = spec().quantities;
      auto& constants = spec().constants;
      if (on_sensor_ && index_of(system_.quantities, e.text) >= 0) refuse_namesake(e.text);
      if (const std::string* unit = find_quantity(e.text)) {
        if (std::none_of(roles.begin(), roles.end(), same)) roles.push_back({keep(e.text), keep(*unit)});
      } else if (find_constant(e.text) != nullptr && std::find(constants.begin(), constants.end(), e.text) == constants.end()) {
        constants.push_back(e.text);
      }
    }
    nq_ = int_size(roles());
    nc_ = int_size(spec().coefficients);
    nk_ = int_size(spec().constants);
    if (nq_ + nc_ + nk_ > kMaxWidth)
      throw InputError(study_.where, "effect '" + shown(study_.name) + "' reads more than " + std::to_string(kMaxWidth) + " numbers");
  }
  std::vector<Role>& roles() { return spec().quantities; }

  std::optional<Meaning> meaning(const std::string& name) {
    if (name == "t") return Meaning{graph_.leaf(nq_ + nc_ + nk_), formula::measure_of("s")};
    for (int i = 0; i < nq_; ++i) {
      const Role& role = roles()[i];
      if (name == role.name) return Meaning{graph_.leaf(i), formula::measure_of(role.unit)};
    }
    for (int i = 0; i < nc_; ++i) {
      if (name == spec().coefficients[i].name) return Meaning{graph_.leaf(nq_ + i), measures_[i]};
    }
    for (int i = 0; i < nk_; ++i) {
      if (name == spec().constants[i]) return Meaning{graph_.leaf(nq_ + nc_ + i), formula::measure_of(*find_constant(name))};
    }
    return std::nullopt;
  }

  std::vector<std::string> all_names() const {
    std::vector<std::string> out;
    for (const auto& c : effect_->spec_.coefficients) out.emplace_back(c.name);
    for (const auto& q : system_.quantities) out.push_back(q.name);
    for (const auto& k : system_.constants) out.push_back(k.name);
    out.emplace_back("t");
    return out;
  }

  bool depends(int node, int leaf) const {
    const auto leaves = graph_.leaves_of(node);
    return std::find(leaves.begin(), leaves.end(), leaf) != leaves.end();
  }

  void choose_strengths(int node) {
    auto& coefficients = spec().coefficients;
    std::vector<bool> chosen(coefficients.size(), false);
    if (!declared_.strengths.empty()) {
      std::vector<std::string> names;
      for (const auto& c : coefficients) names.emplace_back(c.name);
      for (const auto& name : declared_.strengths) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
          throw InputError(study_.where,
                           "effect '" + shown(study_.name) + "': strengths: no parameter '" + shown(name) + "'" + suggest(name, names));
        chosen[found - names.begin()] = true;
      }
    } else {
      chosen = linear_strengths(node);
    }
    int off = node;
    bool any = false;
    for (int i = 0; i < int_size(chosen); ++i) {
      if (!chosen[i]) continue;
      coefficients[i].kind = CoefficientKind::strength;
      off = graph_.substitute(off, nq_ + i, graph_.constant(0.0));
      any = true;
    }
    if (!coefficients.empty() && !(any && graph_.is(off, 0.0))) {
      throw InputError(study_.where, "effect '" + shown(study_.name) +
                                         "': no parameter switches it off: a strength must multiply all of it (" +
                                         "name them with strengths = [\"…\"])");
    }
  }

  std::vector<bool> linear_strengths(int node) {
    const int nc = nc_;
    std::vector<bool> linear(nc, false), alone = linear;
    for (int i = 0; i < nc; ++i) {
      const int leaf = nq_ + i;
      const int slope = graph_.derivatives(node, {graph_.leaf(leaf)}).front();
      linear[i] = !depends(slope, leaf);
      alone[i] = linear[i] && graph_.is(graph_.substitute(node, leaf, graph_.constant(0.0)), 0.0);
    }
    return std::find(alone.begin(), alone.end(), true) != alone.end() ? alone : linear;
  }

  void check_used(int node) {
    for (int i = 0; i < nc_; ++i) {
      if (!depends(node, nq_ + i))
        throw InputError(study_.where,
                         "effect '" + shown(study_.name) + "': nothing depends on its parameter '" + spec().coefficients[i].name + "'");
    }
  }

  void compile(int node) {
    const int leaves = nq_ + nc_ + nk_ + 1;
    std::vector<int> inputs;
    for (int i = 0; i + 1 < leaves; ++i) inputs.push_back(graph_.leaf(i));
    std::vector<int> roots{node};
    for (int slope : graph_.derivatives(node, inputs)) roots.push_back(slope);
    effect_->value_ = Program(graph_, {node}, leaves);
    effect_->slopes_ = Program(graph_, roots, leaves);
    for (const auto& port : system_.dynamic_ports) {
      if (port.name != declared_.port || !is_rate_port(port)) continue;
      for (int i = 0; i < nq_; ++i) {
        if (port.conjugate != roles()[i].name) continue;
        effect_->conjugate_ = i;
        effect_->steep_ = Program(graph_, graph_.derivatives(node, {graph_.leaf(i)}, true), leaves);
      }
    }
  }

  void describe() {
    spec().key = study_.name;
    spec().formula = declared_.port + " += " + declared_.formula;
    spec().symbols = "those of the study";
    spec().valid = "where the study says";
    spec().size = "see the fit";
    spec().source = "declared in the study";
    spec().excludes = "nothing known";
  }

  const EffectStudy& study_;
  const FormulaStudy& declared_;
  const SystemSpec& system_;
  std::unique_ptr<FormulaEffect> effect_ = std::make_unique<FormulaEffect>();
  formula::Graph graph_;
  std::vector<formula::Measure> measures_;
  bool on_sensor_ = false;
  int nq_ = 0, nc_ = 0, nk_ = 0;
};

}  // namespace

std::unique_ptr<Effect> declared_effect(const EffectStudy& study, const SystemSpec& system) {
  return FormulaEffectBuilder(study, system).run();
}

}  // namespace misfit
