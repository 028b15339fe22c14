#include "misfit/model/declared_text.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/model/declared_parameter.h"

namespace misfit::declared {
namespace {

using config::Section;

class Reader {
 public:
  Reader(const std::string& text, const std::string& file, const std::string& key) : root_(Section::parse(text, file)), file_(file) {
    out_.spec.key = key;
    out_.where = {file, 0, 0};
  }

  Declaration run() {
    read_head();
    each("states", true, [&](const Section& s, const std::string& name) { read_state(s, name); });
    each("inputs", false, [&](const Section& s, const std::string& name) { read_input(s, name); });
    each("parameters", false, [&](const Section& s, const std::string& name) { read_parameter(s, name); });
    each("quantities", false, [&](const Section& s, const std::string& name) { read_quantity(s, name); });
    each("ports", false, [&](const Section& s, const std::string& name) { read_port(s, name); });
    link_rates();
    read_equations();
    names_.clear();  // an output may be called as a state or quantity
    each("outputs", true, [&](const Section& s, const std::string& name) { read_output(s, name); });
    out_.roles = root_.table("roles");
    root_.finish();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({file_, 0, 0}, message); }

  void read_head() {
    out_.spec.doc = "declared system";
    const auto head = root_.table("system");
    if (!head) return;
    out_.spec.doc = head->text("doc").value_or(out_.spec.doc);
    out_.spec.source = head->text("source").value_or("");
    if (const auto rate = head->number("fastest_rate", "1/s")) {
      if (!(rate->value > 0.0)) head->fail("fastest_rate", "must be above 0");
      out_.spec.fastest_rate = rate->value;
      out_.spec.rate_given = true;
    }
    head->finish();
  }

  template <class Read>
  void each(const char* section_name, bool needed, const Read& read) {
    const auto section = root_.table(section_name);
    if (!section || section->keys().empty()) {
      if (needed) fail(std::string("the section [") + section_name + "] is missing: a system needs at least one of them");
      return;
    }
    for (const std::string& name : section->keys()) {
      if (!formula::is_name(name))
        section->fail(name, "a name has letters, digits and underscores, begins with a letter and is no function of formulas");
      if (!names_.insert(name).second)
        section->fail(name, "the name '" + shown(name) + "' is taken by a state, input, parameter, quantity or port");
      if (!section->is_table(name)) section->fail(name, "a table is expected, as { unit = \"V\" }");
      const Section entry = *section->table(name);
      read(entry, name);
      entry.finish();
    }
    section->finish();
  }

  static double number(const Section& s, const char* key, const std::string& of, double fallback) {
    const auto n = s.number(key, of);
    return n ? n->value : fallback;
  }

  void read_state(const Section& s, const std::string& name) {
    StateSpec state;
    state.name = name;
    state.unit = read_unit(s);
    state.lower = number(s, "min", state.unit, state.lower);
    state.upper = number(s, "max", state.unit, state.upper);
    if (!(state.lower < state.upper)) s.fail("max", "must be above min");
    read_initial(s, state);
    state.scale = number(s, "scale", state.unit, std::isfinite(state.start) && state.start != 0.0 ? std::abs(state.start) : 1.0);
    if (!(state.scale > 0.0)) s.fail("scale", "must be positive");
    if (state.start < state.lower || state.start > state.upper) s.fail("initial", "is outside min to max");
    rate_of_.push_back(s.text("rate_of").value_or(""));
    rate_of_where_.push_back(s.where("rate_of"));
    out_.spec.states.push_back(state);
  }

  static void read_initial(const Section& s, StateSpec& state) {
    if (!s.has("initial")) return;
    if (s.is_table("initial")) {
      const Section table = *s.table("initial");
      const std::string kind = table.choice("kind", {"free", "shared", "fixed"}).value_or("free");
      state.initial = kind == "free" ? Initial::free : kind == "shared" ? Initial::shared : Initial::fixed;
      state.start = number(table, "value", state.unit, state.start);
      if (state.initial == Initial::fixed && !table.has("value")) table.fail("value", "a fixed initial value is missing");
      table.finish();
      return;
    }
    const std::string kind = s.is_text("initial") ? *s.text("initial") : "";
    if (kind == "shared") state.initial = Initial::shared;
    if (kind == "shared" || kind == "free") return;
    state.initial = Initial::fixed;
    state.start = number(s, "initial", state.unit, 0.0);
  }

  void read_input(const Section& s, const std::string& name) {
    InputSpec input;
    input.name = name;
    input.unit = read_unit(s);
    input.doc = s.text("doc").value_or("");
    if (s.choice("hold", {"zero_order", "first_order"}).value_or("first_order") == "zero_order") input.hold = Hold::zero_order;
    input.delay = number(s, "delay", "s", 0.0);
    if (input.delay < 0.0) s.fail("delay", "must not be negative: the system cannot see what has not happened yet");
    out_.spec.inputs.push_back(input);
  }

  void read_parameter(const Section& s, const std::string& name) {
    const ParameterText text = declared::read_parameter(s);
    ConstantSpec p;
    p.name = name;
    p.unit = text.unit;
    p.doc = text.doc;
    p.lower = text.lower;
    p.upper = text.upper;
    p.required = !text.value;
    p.value = text.value.value_or(0.0);
    p.free = text.free.value_or(false);
    p.prior_sigma = text.sigma.value_or(0.0);
    out_.spec.constants.push_back(p);
  }

  Formula formula_of(const Section& s, const char* key, const std::string& of, const std::string& unit_text) const {
    const auto text = s.text(key);
    if (!text) s.fail(key, "a formula in quotes is expected");
    return {formula::parse({*text, of, s.where_text(key)}), formula::measure_of(unit_text)};
  }

  void read_quantity(const Section& s, const std::string& name) {
    QuantitySpec q;
    q.name = name;
    q.unit = read_unit(s);
    q.doc = s.text("doc").value_or("");
    q.carries_sign = true;
    out_.quantities.push_back(formula_of(s, "formula", "quantity " + name, q.unit));
    out_.spec.quantities.push_back(q);
  }

  void read_port(const Section& s, const std::string& name) {
    PortSpec port;
    port.name = name;
    port.unit = read_unit(s);
    port.doc = s.text("doc").value_or("");
    port.conjugate = s.text("rate").value_or("");
    out_.spec.dynamic_ports.push_back(port);
  }

  void link_rates() {
    auto& states = out_.spec.states;
    std::vector<std::string> names;
    for (const auto& state : states) names.push_back(state.name);
    for (std::size_t j = 0; j < states.size(); ++j) {
      if (rate_of_[j].empty()) continue;
      const auto found = std::find(names.begin(), names.end(), rate_of_[j]);
      if (found == names.end())
        throw InputError(rate_of_where_[j], "rate_of: there is no state '" + shown(rate_of_[j]) + "'" + suggest(rate_of_[j], names));
      const auto of = static_cast<std::size_t>(found - names.begin());
      if (of == j) throw InputError(rate_of_where_[j], "a state cannot be its own rate");
      const auto wanted = formula::measure_of(rate_unit(states[of].unit));
      if (!formula::measure_of(states[j].unit).fits(wanted))
        throw InputError(rate_of_where_[j],
                         "the rate of '" + states[of].name + "' has [" + wanted.text() + "], not [" + states[j].unit + "]");
      states[j].rate_of = static_cast<int>(of);
    }
  }

  void read_equations() {
    auto& states = out_.spec.states;
    const auto section = root_.table("equations");
    if (!section) fail("the section [equations] is missing: STATE = \"its time derivative\"");
    std::vector<std::string> names;
    for (const auto& state : states) names.push_back(state.name);
    for (const std::string& key : section->keys()) {
      if (std::find(names.begin(), names.end(), key) == names.end())
        section->fail(key, "there is no state '" + shown(key) + "'" + suggest(key, names));
    }
    for (std::size_t j = 0; j < states.size(); ++j) {
      if (section->has(states[j].name)) {
        out_.equations.push_back(formula_of(*section, states[j].name.c_str(), "equation " + states[j].name, rate_unit(states[j].unit)));
        continue;
      }
      const auto rate = std::find_if(states.begin(), states.end(), [&](const StateSpec& s) { return s.rate_of == static_cast<int>(j); });
      if (rate == states.end()) section->fail(states[j].name, "the equation of state '" + shown(states[j].name) + "' is missing");
      out_.equations.push_back(
          {formula::parse({rate->name, "equation " + states[j].name, out_.where}), formula::measure_of(rate_unit(states[j].unit))});
    }
    section->finish();
  }

  void read_output(const Section& s, const std::string& name) {
    OutputSpec output;
    output.name = name;
    output.unit = read_unit(s);
    output.noise = number(s, "noise", output.unit, 0.0);
    const std::string of = "output " + name;
    out_.outputs.push_back(s.has("formula") ? formula_of(s, "formula", of, output.unit)
                                            : Formula{formula::parse({name, of, s.where()}), formula::measure_of(output.unit)});
    out_.spec.outputs.push_back(output);
  }

  Section root_;
  std::string file_;
  Declaration out_;
  std::set<std::string> names_;
  std::vector<std::string> rate_of_;
  std::vector<Source> rate_of_where_;
};

}  // namespace

Declaration read(const std::string& text, const std::string& file, const std::string& key) { return Reader(text, file, key).run(); }

}  // namespace misfit::declared
