#include "misfit/fit/filter/filter_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace misfit {
namespace {

struct Bounds {
  double lower, upper;
};

void push(NoiseVector& out, const std::string& name, double value, const Bounds& bounds) {
  out.names.push_back(name);
  out.lower.push_back(std::log(bounds.lower));
  out.upper.push_back(std::log(bounds.upper));
  out.value.push_back(std::clamp(std::log(std::max(value, 1e-300)), out.lower.back(), out.upper.back()));
}

/// Response of (force, rate, level) a time s after a unit kick of the force, up to constants that cancel.
std::array<double, 3> response(double s, double tau) {
  const double decayed = std::exp(-s / tau);
  const double rate = -tau * std::expm1(-s / tau);
  return {decayed, rate, tau * (s - rate)};
}

NoiseStep::Coloured coloured_step(const ChannelNoise& noise, double h) {
  const double omega = 2.0 * std::numbers::pi * noise.coloured_frequency;
  const double zeta = std::min(noise.coloured_damping, 0.999);
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  const double decay = std::exp(-zeta * omega * h);
  const double c = std::cos(damped * h), s = std::sin(damped * h);
  const double a = zeta * omega / damped, b = omega / damped;
  NoiseStep::Coloured out;
  out.phi = {decay * (c + a * s), decay * b * s, -decay * b * s, decay * (c - a * s)};
  const auto& p = out.phi;
  const double variance = noise.coloured * noise.coloured;
  out.q = {variance * (1.0 - p[0] * p[0] - p[1] * p[1]), variance * (-p[0] * p[2] - p[1] * p[3]),
           variance * (1.0 - p[2] * p[2] - p[3] * p[3])};
  return out;
}

}  // namespace

NoiseVector pack(const FilterNoise& noise, const SystemSpec& spec, const FilterNoise& reference) {
  constexpr double shortest_memory = 0.15;  // of the usual correlation time: shorter than a sample is white
  NoiseVector out;
  push(out, "force", noise.force, {1e-3 * reference.force, 1e3 * reference.force});
  const Bounds memory{(reference.time_is_given ? 1.0 : shortest_memory) * reference.force_time,
                      (reference.time_is_given ? 1.0 : 1e2) * reference.force_time};
  push(out, "force_time", noise.force_time, memory);
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    const ChannelNoise& channel = noise.channels[o];
    const ChannelNoise& usual = reference.channels[o];
    const std::string& name = spec.outputs[o].name;
    const double reach = usual.given ? 1.0 : 1e2;
    push(out, name, channel.white, {std::max(usual.white / reach, usual.rounding), usual.white * reach});
    push(out, name + "_coloured", channel.coloured, {1e-3 * usual.white, (usual.given || usual.no_coloured ? 1e-3 : 1e2) * usual.white});
    push(out, name + "_coloured_frequency", channel.coloured_frequency, {0.5 * usual.coloured_frequency, 3.3 * usual.coloured_frequency});
    push(out, name + "_coloured_damping", channel.coloured_damping, {0.01, 0.99});
  }
  for (std::size_t g = 0; g < noise.further_forces.size(); ++g) {
    const double usual = reference.further_forces[g];
    push(out, "force_" + std::to_string(g + 2), noise.further_forces[g], {1e-3 * usual, 1e3 * usual});
  }
  out.prior = ColumnPriors{}.padded(std::ssize(out.value));
  if (reference.prior.group < 0) return out;
  const auto place = static_cast<Eigen::Index>(place_of_force(reference.prior.group, spec));
  out.prior.mean[place] = std::log(reference.prior.median);
  out.prior.precision[place] = 1.0 / (reference.prior.log_sigma * reference.prior.log_sigma);
  return out;
}

double log_prior(const FilterNoise& noise, const SystemSpec& spec, const FilterNoise& reference) {
  if (reference.prior.group < 0) return 0.0;
  const NoiseVector vector = pack(noise, spec, reference);
  return vector.prior.log_density(Eigen::Map<const Eigen::VectorXd>(vector.value.data(), std::ssize(vector.value)));
}

std::size_t place_of_force(int group, const SystemSpec& spec) {
  return group == 0 ? place_in_noise::force : place_in_noise::white(spec.outputs.size()) + group - 1;
}

FilterNoise unpack(const std::vector<double>& logs, const SystemSpec& spec) {
  FilterNoise out;
  out.force = std::exp(logs[place_in_noise::force]);
  out.force_time = std::exp(logs[place_in_noise::force_time]);
  const std::size_t channels_end = place_of_force(1, spec);
  for (std::size_t i = channels_end; i < logs.size(); ++i) out.further_forces.push_back(std::exp(logs[i]));
  for (std::size_t i = place_in_noise::white(0); i < channels_end; i += place_in_noise::per_channel)
    out.channels.push_back({std::exp(logs[i]), std::exp(logs[i + 1]), std::exp(logs[i + 2]), std::exp(logs[i + 3])});
  return out;
}

NoiseStep discretise(const FilterNoise& noise, double h) {
  // Eight-point Gauss–Legendre over the step: relative error below 1e-9 up to h = 2 tau, 2e-8 at 5 tau.
  static constexpr std::array<double, 8> node = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
                                                 0.1834346424956498,  0.5255324099163290,  0.7966664774136267,  0.9602898564975363};
  static constexpr std::array<double, 8> weight = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
                                                   0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  NoiseStep out;
  const double intensity = 2.0 * noise.force * noise.force / noise.force_time;
  std::array<double, 3> whole = response(h, noise.force_time);
  whole[0] = 1.0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    std::array<double, 3> g = response(0.5 * h * (1.0 + node[k]), noise.force_time);
    for (std::size_t i = 0; i < 3; ++i) g[i] /= whole[i];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) out.m[i][j] += 0.5 * h * weight[k] * intensity * g[i] * g[j];
    }
  }
  out.variance_ratio = {1.0};
  for (const double further : noise.further_forces) out.variance_ratio.push_back(further * further / (noise.force * noise.force));
  for (const auto& channel : noise.channels) out.coloured.push_back(coloured_step(channel, h));
  return out;
}

FilterNoise hardly_forced(FilterNoise noise, const FilterNoise& reference) {
  constexpr double nearly_nothing = 1e-3;
  noise.force = nearly_nothing * reference.force;
  for (std::size_t g = 0; g < noise.further_forces.size(); ++g) noise.further_forces[g] = nearly_nothing * reference.further_forces[g];
  for (ChannelNoise& channel : noise.channels) {
    channel.white = std::hypot(channel.white, channel.coloured);
    channel.coloured = nearly_nothing * channel.white;
  }
  return noise;
}

}  // namespace misfit
