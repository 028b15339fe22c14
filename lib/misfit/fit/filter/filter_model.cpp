#include "misfit/fit/filter/filter_model.h"

#include <algorithm>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/units.h"
#include "misfit/model/whole_steps.h"

namespace misfit {
namespace {

/// First-order memory driven by noise; its noise is discretised by the filter (NoiseStep), not by `diffusion`.
struct RandomForce {
  static constexpr const char* formula = "F = z, z' = -z/force_time + noise";
  static constexpr const char* symbols = "z the force [port], force_time correlation time [s]";
  static constexpr const char* valid = "broad-band forcing with one correlation time";
  static constexpr const char* size = "27 N m at the parachute of the paper";
  static constexpr const char* source = "Jazwinski (1970): Ornstein-Uhlenbeck process";
  static constexpr const char* excludes = "lines in the spectrum, dependence on the motion";
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  static constexpr CoefficientSpec coefficients[] = {{.name = "force_time",
                                                      .kind = CoefficientKind::shape,
                                                      .value = 0.1,
                                                      .unit = "s",
                                                      .lower = 1e-6,
                                                      .upper = 1e6,
                                                      .scale = 0.1,
                                                      .doc = "correlation time of the random force"}};
  static constexpr OwnStateSpec states[] = {{.name = "force"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    F[0] = in.z[0];
    drift[0] = -in.z[0] / in.c[0];
  }
  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[0]; }
  static std::vector<Example> examples() {
    return {{.coefficients = {0.1}, .states = {20.0}, .ports = {20.0}, .drifts = {-200.0}, .source = "by hand: 20/0.1"}};
  }
};

std::vector<int> ports_of(const SystemSpec& spec) {
  std::vector<int> ports;
  for (std::size_t p = 0; p < spec.dynamic_ports.size(); ++p) {
    const auto& port = spec.dynamic_ports[p];
    const bool named = std::find(spec.force_ports.begin(), spec.force_ports.end(), port.name) != spec.force_ports.end();
    if (named || (spec.force_ports.empty() && !port.conjugate.empty())) ports.push_back(static_cast<int>(p));
  }
  for (std::size_t p = 0; ports.empty() && p < spec.dynamic_ports.size(); ++p) ports.push_back(static_cast<int>(p));
  return ports;
}

/// Of the last force port: that of an earlier one of its dimension, else a new one.
int group_of(const SystemSpec& spec, const FilterModel& model) {
  const Unit unit = parse_unit(spec.dynamic_ports[model.force_ports.back()].unit);
  for (std::size_t i = 0; i < model.force_group.size(); ++i) {
    if (unit.same_dimension(parse_unit(spec.dynamic_ports[model.force_ports[i]].unit))) return model.force_group[i];
  }
  return model.force_group.empty() ? 0 : 1 + *std::max_element(model.force_group.begin(), model.force_group.end());
}

}  // namespace

int FilterModel::force_groups() const { return force_group.empty() ? 1 : 1 + *std::max_element(force_group.begin(), force_group.end()); }

FilterModel with_random_force(const Model& model) {
  static const EffectOf<RandomForce> effect("random_force");
  FilterModel out;
  out.model = before_whole_steps(model);
  out.steps = steps_of_outputs(model);
  const SystemSpec& spec = model.system->spec();
  out.time_parameter = int_size(out.model.parameters);
  Parameter time{"force_time", "s", "correlation time of the random force", 0.1, 1e-6, 1e6, 0.1};
  out.model.parameters.push_back(time);
  for (int port : ports_of(spec)) {
    BoundEffect bound;
    bound.effect = &effect;
    bound.name = "random_force_" + spec.dynamic_ports[port].name;
    bound.kind = PortKind::dynamic;
    bound.ports = {port};
    bound.coefficients = {{out.time_parameter, -1}};
    bound.first_state = int_size(out.model.own_states);
    out.force_states.push_back(out.model.states());
    out.force_ports.push_back(port);
    out.force_group.push_back(group_of(spec, out));
    out.model.own_states.push_back(effect.spec().states.front());
    out.model.own_state_names.push_back(bound.name + ".force");
    out.model.own_state_units.push_back(spec.dynamic_ports[port].unit);
    out.model.effects.push_back(std::move(bound));
  }
  if (out.model.states() > kMaxStates)
    throw RunError("the model has " + std::to_string(model.states()) + " states; with its random forces the filter can take " +
                   std::to_string(kMaxStates));
  out.kind.assign(out.model.states(), 2);
  for (std::size_t i = 0; i < spec.states.size(); ++i) {
    const bool level =
        std::any_of(spec.states.begin(), spec.states.end(), [&](const StateSpec& s) { return s.rate_of == static_cast<int>(i); });
    if (!level) out.kind[i] = 1;
  }
  for (int f : out.force_states) out.kind[f] = 0;
  return out;
}

Model all_fixed(Model model) {
  for (auto& parameter : model.parameters) parameter.free = false;
  return model;
}

}  // namespace misfit
