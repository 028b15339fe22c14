#include "misfit/fit/shooting/output_error_setting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace misfit::output_error_parts {

Setting setting_of(const Model& model, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
  Setting s;
  const auto& spec = model.system->spec();
  s.step = usual_step(experiments.front().t);
  for (const auto& experiment : experiments) {
    s.states.push_back(reconstruct_states(model, experiment));
    s.frequency = std::max(s.frequency, motion_frequency(model, s.states.back()));
    s.samples = std::max(s.samples, experiment.samples());
  }
  if (options.frequency > 0.0) s.frequency = options.frequency;
  if (!(s.frequency > 0.0)) s.frequency = std::max(spec.fastest_rate, 1e-3 / s.step);
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    double sigma = model.known_noise[o].sigma;
    if (!(sigma > 0.0)) sigma = experiments.front().measured[o].sigma;
    if (!(sigma > 0.0)) sigma = measurement_noise(experiments.front().measured[o].values);
    if (!(sigma > 0.0)) sigma = spec.outputs[o].noise > 0.0 ? spec.outputs[o].noise : 1.0;
    s.sigma.push_back(sigma);
  }
  s.state_scale.assign(model.states(), 1.0);
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    if (spec.outputs[o].observes >= 0) s.state_scale[spec.outputs[o].observes] = s.sigma[o];
  }
  for (std::size_t j = 0; j < spec.states.size(); ++j) {
    if (spec.states[j].rate_of >= 0) s.state_scale[j] = s.state_scale[spec.states[j].rate_of] * s.frequency;
  }
  return s;
}

Setting with_noise(const FittedModel& start, Setting setting) {
  const auto& outputs = start.model.system->spec().outputs;
  for (std::size_t o = 0; o < setting.sigma.size(); ++o) {
    const auto known = start.fit.noise.find(outputs[o].name);
    if (known != start.fit.noise.end() && known->second.value > 0.0) setting.sigma[o] = known->second.value;
  }
  return setting;
}

std::vector<RowMatrix> start_states(const Setting& setting) {
  std::vector<RowMatrix> out;
  for (const auto& states : setting.states) {
    RowMatrix x = states.x;
    Eigen::Index known = -1;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (!states.ok[i]) continue;
      for (Eigen::Index k = known + 1; k < i; ++k) {
        const double share = known < 0 ? 1.0 : static_cast<double>(k - known) / static_cast<double>(i - known);
        x.row(k) = known < 0 ? x.row(i).eval() : (x.row(known) + share * (x.row(i) - x.row(known))).eval();
      }
      known = i;
    }
    for (Eigen::Index k = known + 1; known >= 0 && k < x.rows(); ++k) x.row(k) = x.row(known);
    out.push_back(std::move(x));
  }
  return out;
}

std::vector<ShootingPass> short_passes(const Setting& setting, bool from_regression) {
  constexpr double nearly_gauss_newton = 1e8;  // with segments this short the problem is nearly linear: a small region only slows it
  const auto half_period = static_cast<std::size_t>(std::clamp(std::numbers::pi / setting.frequency / setting.step, 5.0, 1000.0));
  std::vector<ShootingPass> list;
  if (!from_regression) {
    list.push_back({.length = 5, .defect_weight = 1.0, .initial_radius = 1e4, .max_iterations = 40, .tolerance = 1e-4});
    list.push_back({.length = 5, .defect_weight = 10.0, .initial_radius = 1e6, .max_iterations = 40, .tolerance = 1e-4});
  }
  list.push_back(
      {.length = half_period, .defect_weight = 10.0, .initial_radius = nearly_gauss_newton, .max_iterations = 30, .tolerance = 1e-4});
  return list;
}

}  // namespace misfit::output_error_parts
