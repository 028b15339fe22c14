#include "misfit/model/declared_text.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/model/declared_keys.h"
#include "misfit/model/declared_parameter.h"

namespace misfit::declared {
namespace {

Hold hold_called(const std::string& name) {
  return name == "zero_order" ? Hold::zero_order : name == "band_limited" ? Hold::band_limited : Hold::first_order;
}

using config::DescribedSection;
using config::Section;

class Reader {
 public:
  Reader(const std::string& text, const std::string& file, const std::string& key) : root_(Section::parse(text, file)), file_(file) {
    out_.spec.key = key;
    out_.where = {file, 0, 0};
  }

  Declaration run() {
    read_head();
    read_display();
    each("states", true, [&](const DescribedSection& s, const std::string& name) { read_state(s, name); });
    each("inputs", false, [&](const DescribedSection& s, const std::string& name) { read_input(s, name); });
    each("parameters", false, [&](const DescribedSection& s, const std::string& name) { read_parameter(s, name); });
    each("quantities", false, [&](const DescribedSection& s, const std::string& name) { read_quantity(s, name); });
    each("ports", false, [&](const DescribedSection& s, const std::string& name) { read_port(s, name); });
    link_rates();
    read_equations();
    names_.clear();  // an output may be called as a state or quantity
    each("outputs", true, [&](const DescribedSection& s, const std::string& name) { read_output(s, name); });
    out_.roles = described(root_, "roles", "roles");
    root_.finish(config::sections_of(system_keys()));
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({file_, 0, 0}, message); }

  void read_head() {
    const DescribedSection head = described(root_, "system", "system");
    out_.spec.doc = *head.text("doc");
    out_.spec.source = *head.text("source");
    out_.spec.fastest_rate = head.value("fastest_rate").value_or(0.0);
    out_.spec.rate_given = out_.spec.fastest_rate > 0.0;
    head.finish();
  }

  void read_display() {
    const DescribedSection display = described(root_, "display", "display");
    out_.spec.angles_in_radians = *display.choice("angle") == "rad";
    for (const std::string& unit : display.texts("units").value_or(std::vector<std::string>{})) read_display_unit(display, unit);
    display.finish();
  }

  /// The inside unit of what is shown in `unit`.
  static std::string shown_in_or_fail(const DescribedSection& display, const std::string& unit) {
    try {
      return shown_in(unit);
    } catch (const InputError& error) {
      display.fail("units", error.what());
    }
  }

  void read_display_unit(const DescribedSection& display, const std::string& unit) {
    const std::string inside = shown_in_or_fail(display, unit);
    const auto symbols = unit_symbols(unit);
    const bool in_degrees = std::any_of(symbols.begin(), symbols.end(), [](const auto& symbol) { return symbol.first == "deg"; });
    if (in_degrees || plain_si(inside) == "rad")
      display.fail("units", "angles and their rates are shown as angle = \"deg\" or \"rad\" says");
    if (plain_si(inside) == "s") display.fail("units", "times are shown in s, not in " + shown(unit));
    const auto same = [&](const std::string& other) { return plain_si(other) == plain_si(inside); };
    if (std::any_of(out_.spec.shown_units.begin(), out_.spec.shown_units.end(), same))
      display.fail("units", shown(unit) + " is a second unit for what is " + plain_si(inside));
    out_.spec.shown_units.push_back(inside);
  }

  [[nodiscard]] std::string unit_of(const DescribedSection& section) const { return shown_unit_of_channel(read_unit(section), out_.spec); }

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
      const DescribedSection entry = described(*section, name, std::string(section_name) + ".NAME");
      read(entry, name);
      entry.finish();
    }
    section->finish();
  }

  void read_state(const DescribedSection& s, const std::string& name) {
    StateSpec state;
    state.name = name;
    state.unit = unit_of(s);
    state.lower = s.value("min", state.unit).value_or(state.lower);
    state.upper = s.value("max", state.unit).value_or(state.upper);
    if (!(state.lower < state.upper)) s.fail("max", "must be above min");
    read_initial(s, state);
    state.scale = s.value("scale", state.unit).value_or(std::isfinite(state.start) && state.start != 0.0 ? std::abs(state.start) : 1.0);
    if (state.start < state.lower || state.start > state.upper) s.fail("initial", "is outside min to max");
    rate_of_.push_back(s.text("rate_of").value_or(""));
    rate_of_where_.push_back(s.where("rate_of"));
    out_.spec.states.push_back(state);
  }

  static void read_initial(const DescribedSection& s, StateSpec& state) {
    if (!s.has("initial")) return;
    if (s.is_table("initial")) {
      const DescribedSection table = described(s, "initial", "states.NAME.initial");
      const std::string kind = *table.choice("kind");
      state.initial = kind == "free" ? Initial::free : kind == "shared" ? Initial::shared : Initial::fixed;
      state.start = table.value("value", state.unit).value_or(state.start);
      if (state.initial == Initial::fixed && !table.has("value")) table.fail("value", "a fixed initial value is missing");
      table.finish();
      return;
    }
    const std::string kind = s.is_text("initial") ? *s.text("initial") : "";
    if (kind == "shared") state.initial = Initial::shared;
    if (kind == "shared" || kind == "free") return;
    state.initial = Initial::fixed;
    state.start = s.value("initial", state.unit).value_or(0.0);
  }

  void read_input(const DescribedSection& s, const std::string& name) {
    InputSpec input;
    input.name = name;
    input.unit = unit_of(s);
    input.doc = *s.text("doc");
    input.hold = hold_called(*s.choice("hold"));
    input.delay = *s.value("delay");
    out_.spec.inputs.push_back(input);
  }

  void read_parameter(const DescribedSection& s, const std::string& name) {
    const ParameterText text = declared::read_parameter(s);
    ConstantSpec p;
    p.name = name;
    p.unit = shown_unit(text.unit, out_.spec);
    p.doc = text.doc;
    p.lower = text.lower;
    p.upper = text.upper;
    p.required = !text.value;
    p.value = text.value.value_or(0.0);
    p.free = text.free;
    p.prior_sigma = text.sigma.value_or(0.0);
    p.scale = text.scale.value_or(0.0);
    out_.spec.constants.push_back(p);
  }

  Formula formula_of(const Section& s, const char* key, const std::string& of, const std::string& unit_text) const {
    const auto text = s.text(key);
    if (!text) s.fail(key, "a formula in quotes is expected");
    return {formula::parse({*text, of, s.where_text(key)}), formula::measure_of(unit_text)};
  }

  void read_quantity(const DescribedSection& s, const std::string& name) {
    QuantitySpec q;
    q.name = name;
    q.unit = unit_of(s);
    q.doc = *s.text("doc");
    q.carries_sign = true;
    out_.quantities.push_back(formula_of(s, "formula", "quantity " + name, q.unit));
    out_.spec.quantities.push_back(q);
  }

  void read_port(const DescribedSection& s, const std::string& name) {
    PortSpec port;
    port.name = name;
    port.unit = unit_of(s);
    port.doc = *s.text("doc");
    port.conjugate = s.text("rate").value_or("");
    out_.spec.dynamic_ports.push_back(port);
  }

  void link_rates() {
    auto& states = out_.spec.states;
    std::vector<std::string> names;
    for (const auto& state : states) names.push_back(state.name);
    for (int j = 0; j < int_size(states); ++j) {
      if (rate_of_[j].empty()) continue;
      const int of = place_of(names, rate_of_[j]);
      if (of < 0)
        throw InputError(rate_of_where_[j], "rate_of: there is no state '" + shown(rate_of_[j]) + "'" + suggest(rate_of_[j], names));
      if (of == j) throw InputError(rate_of_where_[j], "a state cannot be its own rate");
      const auto wanted = formula::measure_of(rate_unit(states[of].unit));
      if (!formula::measure_of(states[j].unit).fits(wanted))
        throw InputError(rate_of_where_[j],
                         "the rate of '" + states[of].name + "' has [" + wanted.text() + "], not [" + plain_si(states[j].unit) + "]");
      states[j].rate_of = of;
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
    for (int j = 0; j < int_size(states); ++j) {
      if (section->has(states[j].name)) {
        out_.equations.push_back(formula_of(*section, states[j].name.c_str(), "equation " + states[j].name, rate_unit(states[j].unit)));
        continue;
      }
      const auto rate = std::find_if(states.begin(), states.end(), [&](const StateSpec& s) { return s.rate_of == j; });
      if (rate == states.end()) section->fail(states[j].name, "the equation of state '" + shown(states[j].name) + "' is missing");
      out_.equations.push_back(
          {formula::parse({rate->name, "equation " + states[j].name, out_.where}), formula::measure_of(rate_unit(states[j].unit))});
    }
    section->finish();
  }

  void read_output(const DescribedSection& s, const std::string& name) {
    OutputSpec output;
    output.name = name;
    output.unit = unit_of(s);
    output.noise = s.value("noise", output.unit).value_or(0.0);
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

void set_hold(Declaration& declaration, const std::string& input, const HoldStudy& study) {
  std::vector<InputSpec>& inputs = declaration.spec.inputs;
  const int i = index_of(inputs, input);
  std::vector<std::string> names;
  for (const InputSpec& known : inputs) names.push_back(known.name);
  if (i < 0) throw InputError(study.where, "[system] hold: the system has no input '" + shown(input) + "'" + suggest(input, names));
  inputs[i].hold = hold_called(study.hold);
}

}  // namespace misfit::declared
