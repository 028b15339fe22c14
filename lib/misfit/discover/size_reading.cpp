#include "misfit/discover/size_reading.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "misfit/core/lists.h"

namespace misfit {

std::optional<SizeReading> reads_size_alone(const CandidateModel& candidate_model) {
  const Model& model = candidate_model.model;
  const BoundEffect& bound = model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  if (bound.kind != PortKind::sensor || spec.ports.size() != 1 || spec.quantities.size() != 1 || !spec.states.empty()) return std::nullopt;
  SizeReading out{model.system->spec().outputs[bound.ports.front()].name, Eigen::VectorXd::Zero(std::ssize(candidate_model.strengths))};
  std::vector<double> c;
  double widest = 0.0;
  for (std::size_t i = 0; i < spec.coefficients.size(); ++i) {
    const CoefficientSpec& coefficient = spec.coefficients[i];
    const int at = bound.coefficients[i].parameter, strength = place_of(candidate_model.strengths, at);
    c.push_back(at < 0 ? coefficient.value : model.parameters[at].value);
    if (coefficient.kind == CoefficientKind::shape) widest = std::max(widest, std::abs(c.back()));
    if (coefficient.whole != 0.0) c.back() = coefficient.whole;
    if (strength >= 0) out.strengths[strength] = coefficient.whole;
  }
  if (out.strengths.size() == 0 || (out.strengths.array() == 0.0).any()) return std::nullopt;
  constexpr double far_larger = 100.0, alike = 1e-6;
  const double size = widest > 0.0 ? far_larger * widest : 1.0;
  const auto reading = [&](double signal) {
    double added = 0.0;
    bound.effect->evaluate({&signal, c.data(), nullptr, nullptr, 0.0}, &added);
    return signal + added;
  };
  const auto reads_size = [&](double signal) { return std::abs(reading(signal) - size) < alike * size; };
  return reads_size(size) && reads_size(-size) ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace misfit
