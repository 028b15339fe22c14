#include <algorithm>

#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/model/declared_system.h"
#include "misfit/model/rate_unit.h"

namespace misfit::declared {
namespace {

class Roles {
 public:
  explicit Roles(Declaration& declaration) : d_(declaration) {}

  void run(int own_ports) {
    SystemSpec& s = d_.spec;
    std::vector<std::string> quantities, ports, outputs;
    for (const auto& q : s.quantities) quantities.push_back(q.name);
    for (const auto& p : s.dynamic_ports) ports.push_back(p.name);
    for (const auto& o : s.outputs) outputs.push_back(o.name);
    s.force_ports = d_.roles->texts("force_ports").value_or(s.force_ports);
    for (const auto& port : s.force_ports) check_role("force_ports", port, ports);
    s.roles["port"] = role("port", own_ports > 0 ? ports.front() : s.force_ports.empty() ? ports.front() : s.force_ports.front(), ports);
    const auto& port =
        *std::find_if(s.dynamic_ports.begin(), s.dynamic_ports.end(), [&](const PortSpec& p) { return p.name == s.roles["port"]; });
    const auto moving = std::find_if(s.states.begin(), s.states.end(), [](const StateSpec& state) { return state.rate_of >= 0; });
    const std::string by_default = !port.conjugate.empty()    ? port.conjugate
                                   : moving != s.states.end() ? moving->name
                                                              : s.states.front().name;
    set_motion(by_default, quantities);
    s.roles["output"] = s.roles["signal"] = role("output", outputs.front(), outputs);
    s.roles["time_of_output"] = sample_time_of(s.roles["output"]);
    set_other_output();
    set_varying_parameter();
    if (!s.inputs.empty()) s.roles["input"] = role("input", s.inputs.front().name, quantities);
    if (s.inputs.empty() && d_.roles->text("input")) throw InputError(d_.roles->where("input"), "[roles] input: the system has no inputs");
    for (auto& p : s.dynamic_ports) {
      if (p.conjugate.empty()) p.conjugate = by_default;
      if (index_of(s.quantities, p.conjugate) < 0)
        throw InputError(d_.where,
                         "[ports] " + p.name + ": rate = '" + shown(p.conjugate) + "' is no quantity" + suggest(p.conjugate, quantities));
    }
    d_.roles->finish();
  }

 private:
  /// `rate` is a role only where something moves, or the file says so: friction on a level would find itself in every tank.
  void set_motion(const std::string& by_default, const std::vector<std::string>& quantities) {
    SystemSpec& s = d_.spec;
    const std::string moving = role("rate", by_default, quantities);
    const int rate = index_of(s.states, moving);
    const int level = rate < 0 ? -1 : s.states[rate].rate_of;
    if (level >= 0 || d_.roles->has("rate")) s.roles["rate"] = moving;
    s.roles["level"] = role("level", level < 0 ? moving : s.states[level].name, quantities);
    if (level >= 0) s.roles["displacement"] = s.roles["level"];
    if (level < 0 && is_per_time(s.quantities[index_of(s.quantities, moving)].unit)) s.roles["speed"] = moving;
    s.roles["factor"] = moving;
    if (level < 0 || d_.roles->has("content")) s.roles["content"] = role("content", moving, quantities);
    set_other_level();
  }

  /// The first state of the level's unit beside it.
  void set_other_level() {
    SystemSpec& s = d_.spec;
    const int level = index_of(s.quantities, s.roles["level"]);
    const Unit unit = parse_unit(s.quantities[level].unit);
    for (const StateSpec& state : s.states) {
      if (state.name == s.roles["level"] || !parse_unit(state.unit).same_dimension(unit)) continue;
      s.roles["other"] = state.name;
      return;
    }
  }

  /// The first output of the unit of `output` beside it.
  void set_other_output() {
    SystemSpec& s = d_.spec;
    const auto own = std::find_if(s.outputs.begin(), s.outputs.end(), [&](const OutputSpec& o) { return o.name == s.roles["output"]; });
    const auto other = std::find_if(s.outputs.begin(), s.outputs.end(), [&](const OutputSpec& o) {
      return o.name != own->name && parse_unit(o.unit).same_dimension(parse_unit(own->unit));
    });
    if (other != s.outputs.end()) s.roles["other_signal"] = s.roles["other_output"] = other->name;
  }

  /// The first parameter that is a port, with the level.
  void set_varying_parameter() {
    SystemSpec& s = d_.spec;
    const auto varying = std::find_if(s.quantity_ports.begin(), s.quantity_ports.end(),
                                      [&](const PortSpec& p) { return index_of(s.constants, p.name) >= 0; });
    if (varying != s.quantity_ports.end()) s.roles["parameter"] = varying->name, s.roles["with"] = s.roles["level"];
  }

  std::string role(const char* name, const std::string& fallback, const std::vector<std::string>& valid) {
    std::string given = d_.roles->text(name).value_or(fallback);
    check_role(name, given, valid);
    return given;
  }
  void check_role(const char* name, const std::string& given, const std::vector<std::string>& valid) {
    if (std::find(valid.begin(), valid.end(), given) == valid.end())
      throw InputError(d_.roles->where(name),
                       std::string("[roles] ") + name + ": there is no '" + shown(given) + "'" + suggest(given, valid));
  }

  Declaration& d_;
};

}  // namespace

void set_roles(Declaration& declaration, int own_ports) { Roles(declaration).run(own_ports); }

}  // namespace misfit::declared
