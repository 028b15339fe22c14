#include "misfit/model/model.h"

#include <algorithm>
#include <set>

#include "misfit/core/lists.h"
#include "misfit/model/role_units.h"

namespace misfit {

std::string roughness_unit(const Curve& curve) {
  return bind_unit("{of} {of} {of}/{curve}/{curve}", {{"of", curve.of_unit}, {"curve", curve.unit}});
}

int Model::input_of_quantity(int quantity) const {
  const SystemSpec& spec = system->spec();
  if (quantity < 0 || quantity >= int_size(spec.quantities)) return -1;
  const std::string& name = spec.quantities[quantity].name;
  const auto input = std::find_if(spec.inputs.begin(), spec.inputs.end(),
                                  [&](const InputSpec& i) { return i.name == name || as_recorded(i.name) == name; });
  return input == spec.inputs.end() ? -1 : static_cast<int>(input - spec.inputs.begin());
}

std::vector<LateInputUse> Model::late_inputs() const {
  std::vector<LateInputUse> out;
  for (int e = 0; e < int_size(effects); ++e) {
    const EffectSpec& spec = effects[e].effect->spec();
    for (int q = 0; q < int_size(spec.quantities); ++q) {
      const int delay = index_of(spec.coefficients, spec.quantities[q].late_by), input = input_of_quantity(effects[e].quantities[q]);
      if (delay >= 0 && input >= 0) out.push_back({e, q, input, effects[e].coefficients[delay].parameter});
    }
  }
  return out;
}

bool Model::noise_is_given() const {
  return std::all_of(known_noise.begin(), known_noise.end(), [](const KnownNoise& noise) { return noise.fixed; });
}

std::vector<double> Model::values() const {
  std::vector<double> out;
  for (const auto& p : parameters) out.push_back(p.value);
  return out;
}

std::vector<int> Model::free_parameters() const {
  std::vector<int> out;
  for (int i = 0; i < int_size(parameters); ++i) {
    if (parameters[i].free) out.push_back(i);
  }
  return out;
}

Eigen::VectorXd Model::theta() const {
  const std::vector<int> free = free_parameters();
  Eigen::VectorXd out(std::ssize(free));
  for (Eigen::Index c = 0; c < out.size(); ++c) out[c] = parameters[free[c]].value;
  return out;
}

void Model::set_theta(const Eigen::VectorXd& theta) {
  const std::vector<int> free = free_parameters();
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) parameters[free[c]].value = theta[c];
}

std::vector<double> Model::values_at(const Eigen::VectorXd& theta) const {
  const std::vector<int> free = free_parameters();
  std::vector<double> out = values();
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) out[free[c]] = theta[c];
  return out;
}

int Model::find_parameter(const std::string& name) const { return index_of(parameters, name); }

const Curve* Model::find_curve(const std::string& name) const {
  for (const auto& curve : curves) {
    if (curve.name == name) return &curve;
  }
  return nullptr;
}

std::vector<std::string> Model::needed_inputs() const {
  const auto& by_equations = system->spec().equation_inputs;
  std::set<std::string> names(by_equations.begin(), by_equations.end());
  const auto& quantities = system->spec().quantities;
  const auto note = [&](int index) {
    if (index < 0 || index >= int_size(quantities)) return;
    for (const auto& input : quantities[index].inputs) names.insert(input);
  };
  for (const auto& effect : effects) {
    for (int index : effect.quantities) note(index);
  }
  for (const auto& curve : curves) note(curve.quantity);
  return {names.begin(), names.end()};
}

}  // namespace misfit
