#include "misfit/model/whole_steps.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Parameters of the effect's strengths that exist as a whole only, and the whole of each.
template <class Look>
void at_whole_strengths(const BoundEffect& effect, Look look) {
  const std::vector<CoefficientSpec>& coefficients = effect.effect->spec().coefficients;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int parameter = effect.coefficients[c].parameter;
    if (coefficients[c].whole != 0.0 && parameter >= 0) look(parameter, coefficients[c].whole);
  }
}

/// The parameter that the measurements show themselves, −1: the effect has none.
int parameter_of(const BoundEffect& effect, OfMeasurements what) {
  const std::vector<CoefficientSpec>& coefficients = effect.effect->spec().coefficients;
  const auto found =
      std::find_if(coefficients.begin(), coefficients.end(), [&](const CoefficientSpec& c) { return c.measured_as == what; });
  if (found == coefficients.end() || effect.kind != PortKind::sensor) return -1;
  return effect.coefficients[found - coefficients.begin()].parameter;
}

}  // namespace

int step_of_measurements(const BoundEffect& effect) { return parameter_of(effect, OfMeasurements::step); }

bool reads_whole_steps(const Model& model, const BoundEffect& effect) {
  if (step_of_measurements(effect) < 0) return false;
  bool any = false, all = true;
  at_whole_strengths(effect, [&](int parameter, double whole) {
    const Parameter& p = model.parameters[parameter];
    any = true;
    all = all && !p.free && p.value == whole;
  });
  return any && all;
}

std::vector<double> steps_of_outputs(const Model& model) {
  std::vector<double> out;
  for (const BoundEffect& effect : model.effects) {
    if (!reads_whole_steps(model, effect)) continue;
    out.resize(model.outputs(), 0.0);
    out[effect.ports.front()] = std::abs(model.parameters[step_of_measurements(effect)].value);
  }
  return out;
}

double as_read(const Model& model, int output, double value) {
  for (const BoundEffect& effect : model.effects) {
    if (!reads_whole_steps(model, effect) || effect.ports.front() != output) continue;
    const double step = std::abs(model.parameters[step_of_measurements(effect)].value);
    const int of_level = parameter_of(effect, OfMeasurements::level);
    const double level = of_level < 0 ? 0.0 : model.parameters[of_level].value;
    if (step > 0.0) value = level + step * std::round((value - level) / step);
  }
  return value;
}

Model before_whole_steps(Model model) {
  std::vector<int> off;
  for (const BoundEffect& effect : model.effects) {
    if (reads_whole_steps(model, effect)) at_whole_strengths(effect, [&](int parameter, double) { off.push_back(parameter); });
  }
  for (int parameter : off) model.parameters[parameter].value = 0.0;
  return model;
}

}  // namespace misfit
