#pragma once

// Inside of assemble(): not for other files.

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// Work in progress: the model and what is needed to fill it. Resolving one effect needs every table of names at once, so that this is one
/// class; names, binding and checks stand in files of their own.
class Assembler {
 public:
  Assembler(const ModelRequest& request, const Registry& registry);

  Model run();
  std::map<std::string, std::string> curves_without_knots();
  std::map<std::string, std::string> parameter_units();
  std::map<std::string, std::string> parameter_names();

 private:
  const SystemSpec& system() const { return model_.system->spec(); }
  const Effect& effect(std::size_t i) const { return registry_.effect(request_.effects[i].kind, request_.effects[i].where); }
  void add_states();
  void add_noise();
  void add_constants();
  static void check_bounds(const Parameter& p, const Source& where);
  /// Of that name, or of what else a study may call it; nullptr: nothing is asked.
  const ParameterRequest* parameter_request(const std::string& name) const;
  void apply_request(Parameter& p);
  /// Bare names where unique, EFFECT.NAME where two effects of the model, or an effect and the system, would share one; a system may
  /// rename.
  void name_coefficients();
  /// A study may use another name than the model does: the bare one for the first effect that owns it, so that adding a second effect of a
  /// kind leaves the lines of the first as they are; and EFFECT.NAME where the bare one would do.
  void find_other_names();
  /// Shared coefficients, once all effects are bound: that of the first effect which owns one of the name.
  void share_coefficients();
  std::optional<BoundCoefficient> owned_coefficient(const std::string& name) const;
  /// What the request calls the curve; its name in the model where nothing is requested of it.
  std::string curve_in_request(const std::string& name) const;
  /// What the study asks of a coefficient as a curve, else what its specification says; nullopt: a number.
  std::optional<CurveRequest> curve_request(const std::string& name, const CoefficientSpec& spec, const EffectRequest& by) const;
  void bind(std::size_t i);
  /// Unit of what each role stands for; "-" where an optional role is absent (a wrong name is reported when it is bound).
  std::map<std::string, std::string> role_units(const EffectRequest& request, const EffectSpec& spec) const;
  const std::string& unit_of_quantity(int index) const;
  static void check_roles(const EffectRequest& request, const EffectSpec& spec);
  /// An optional role that completes another is not looked for where the study binds that one alone.
  static bool is_left_out(const EffectRequest& request, const Role& role);
  /// The name a role stands for: as the study binds it, else itself if `exists`, else the system's default for the role. A sensor whose
  /// `output` the study binds reads that same output.
  template <class Exists>
  std::string target_of(const EffectRequest& request, const Role& role, const Exists& exists) const {
    const auto bound = request.roles.find(role.name);
    if (bound != request.roles.end()) return bound->second;
    const auto own_output = request.roles.find("output");
    if (std::string_view(role.name) == "signal" && own_output != request.roles.end()) return own_output->second;
    if (exists(role.name)) return role.name;
    const auto fallback = system().roles.find(role.name);
    return fallback == system().roles.end() ? role.name : fallback->second;
  }
  struct Place {
    PortKind kind;
    int index;
    std::string unit;
  };
  std::optional<Place> find_port(const std::string& name) const;
  /// For a role: those of sensors mean outputs, where an output has the name of something else, too (OutputSpec::namesake).
  std::optional<Place> find_port(const Role& role, const std::string& name) const;
  int namesake_for(const Role& role, const std::string& name) const;
  std::vector<std::string> port_names() const;
  void bind_ports(const EffectRequest& request, const EffectSpec& spec, BoundEffect& bound) const;
  void check_unit(const EffectRequest& request, const Role& role, const std::string& what, const std::string& unit) const;
  int bind_quantity(const EffectRequest& request, const Role& role, PortKind kind) const;
  /// Only the past of inputs is known.
  void check_input(const EffectRequest& request, const std::string& target) const;
  /// Effects on quantity ports read base quantities only; only effects on sensors read predicted outputs
  /// (lib/misfit/README.md, 4.1).
  void check_order(const Source& where, const std::string& who, const std::string& target, int index, PortKind kind) const;
  int find_quantity(const std::string& name) const;
  int find_quantity(const Role& role, const std::string& name) const;
  std::vector<std::string> quantity_names() const;
  int bind_constant(const EffectRequest& request, const std::string& name) const;
  BoundCoefficient bind_coefficient(const std::string& name, const CoefficientSpec& spec, const EffectRequest& request, PortKind kind);
  Parameter as_parameter(const std::string& name, const CoefficientSpec& spec) const;
  /// Does the formula read it divided by the sine of this quantity?
  bool is_over_sine(const CoefficientSpec& spec, int quantity) const;
  int add_curve(const std::string& name, const CoefficientSpec& spec, const CurveRequest& request, const EffectRequest& by, PortKind kind);
  /// One parameter per spline coefficient. What [parameters] says of the curve holds for each: they sum to one, so bounds on them are
  /// bounds on the curve.
  void add_curve_parameters(const Curve& curve, const CoefficientSpec& spec);
  void check_everything_used() const;
  void check_sizes() const;

  const ModelRequest& request_;
  const Registry& registry_;
  Model model_;
  std::vector<std::vector<std::string>> names_;
  std::map<std::string, std::string> other_names_;  // name in the model → what a study may call it as well
  std::set<const ParameterRequest*> used_parameters_;
  std::set<std::string> used_curves_;
  std::map<std::string, std::string> role_units_;  // of the effect being bound
};

}  // namespace misfit
