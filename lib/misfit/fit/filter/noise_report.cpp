#include "misfit/fit/filter/noise_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/fit/filter/noise_interval.h"
#include "misfit/math/covariance.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// Standard deviations of the logarithms of the noise parameters; 0 where a parameter sits at its bound or is not determined.
std::vector<double> noise_sigmas(const FilterEstimate& estimate) {
  const NoiseFit& fit = estimate.noise_fit;
  Eigen::MatrixXd information = fit.information;
  const std::vector<bool> known = pin_unknown(fit, information);
  const Eigen::Index q = information.rows();
  const Eigen::MatrixXd covariance =
      estimate.joint_covariance.size() > 0 ? Eigen::MatrixXd(estimate.joint_covariance.bottomRightCorner(q, q)) : inverse(information);
  std::vector<double> out;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    out.push_back(known[i] && !pinned(covariance(i, i)) ? standard_error(covariance, i) : 0.0);
  return out;
}

Estimate noise_estimate(double log_value, double sigma_of_log, const std::string& unit) {
  const double value = std::exp(log_value);
  return {value, value * sigma_of_log, unit};
}

std::map<std::string, Estimate> forces_of(const FilterEstimate& estimate, const NoiseVector& vector, const std::vector<double>& sigmas) {
  const SystemSpec& spec = estimate.model.system->spec();
  std::map<std::string, Estimate> out;
  for (std::size_t i = 0; i < estimate.forced.force_ports.size(); ++i) {
    const PortSpec& named = spec.dynamic_ports[estimate.forced.force_ports[i]];
    const std::size_t at = place_of_force(estimate.forced.force_group[i], spec);
    out[named.name] = noise_estimate(vector.value[at], sigmas[at], named.unit);
  }
  return out;
}

}  // namespace

std::map<std::string, Estimate> estimated_force(const FilterEstimate& estimate) {
  return forces_of(estimate, pack(estimate.noise, estimate.model.system->spec(), estimate.reference), noise_sigmas(estimate));
}

void add_noise(const FilterEstimate& estimate, int threads, Fit& fit) {
  const SystemSpec& spec = estimate.model.system->spec();
  const NoiseVector vector = pack(estimate.noise, spec, estimate.reference);
  const std::vector<double> sigmas = noise_sigmas(estimate);
  const auto as_estimate = [&](std::size_t i, const std::string& unit) { return noise_estimate(vector.value[i], sigmas[i], unit); };
  const auto intervals = noise_intervals(estimate, {place_in_noise::force, place_in_noise::force_time}, threads);
  fit.force = forces_of(estimate, vector, sigmas);
  for (std::size_t i = 0; i < estimate.forced.force_ports.size(); ++i) {
    const PortSpec& named = spec.dynamic_ports[estimate.forced.force_ports[i]];
    const std::size_t at = place_of_force(estimate.forced.force_group[i], spec);
    if (at == place_in_noise::force) fit.force[named.name].interval = intervals[0];
    fit.driven = fit.driven || sigmas[at] > 0.0;
  }
  fit.force["correlation_time"] = as_estimate(place_in_noise::force_time, "s");
  fit.force["correlation_time"].interval = intervals[1];
  if (!fit.driven) fit.facts["random_force"] = "no random force is determined by these data: the motion counts as not driven";
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    const std::string& name = spec.outputs[o].name;
    const std::string& unit = spec.outputs[o].unit;
    fit.noise[name] = as_estimate(place_in_noise::white(o), unit);
    if (!(sigmas[place_in_noise::coloured(o)] > 0.0)) {
      fit.facts["coloured noise of " + name] = "not determined by these data: the measurement noise counts as white";
      continue;
    }
    fit.noise[name + "_coloured"] = as_estimate(place_in_noise::coloured(o), unit);
    fit.noise[name + "_coloured_frequency"] = as_estimate(place_in_noise::coloured_frequency(o), "Hz");
    fit.noise[name + "_coloured_damping"] = as_estimate(place_in_noise::coloured_damping(o), "-");
  }
}

namespace {

/// A part of the noise model in words, and whether its lower bound means that it is not there, which is said elsewhere.
struct NoisePart {
  std::size_t at;  ///< in pack()
  std::string words, unit;
  bool absent_at_lower;
  std::optional<std::size_t> shape_of = {};  ///< the output of whose coloured noise it is the shape
  double rounding = 0.0;                     ///< ChannelNoise::rounding
};

/// Those that the fit has found; `fit`: with noise and force.
std::vector<NoisePart> noise_parts(const FilterEstimate& estimate, const Fit& fit) {
  const SystemSpec& spec = estimate.model.system->spec();
  std::vector<NoisePart> out;
  for (int group = 0; group < estimate.forced.force_groups(); ++group) {
    const auto port = std::find(estimate.forced.force_group.begin(), estimate.forced.force_group.end(), group);
    const PortSpec& named = spec.dynamic_ports[estimate.forced.force_ports[port - estimate.forced.force_group.begin()]];
    out.push_back({place_of_force(group, spec), std::string("the random force on ") + named.name, named.unit, true});
  }
  if (fit.driven) out.push_back({place_in_noise::force_time, "the correlation time of the random force", "s", false});
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    const std::string of = std::string(" noise of ") + spec.outputs[o].name;
    const double rounding = estimate.reference.channels[o].rounding;
    out.push_back({place_in_noise::white(o), "the white" + of, spec.outputs[o].unit, false, {}, rounding});
    out.push_back({place_in_noise::coloured(o), "the coloured" + of, spec.outputs[o].unit, true});
    if (!fit.noise.contains(spec.outputs[o].name + "_coloured")) continue;
    out.push_back({place_in_noise::coloured_frequency(o), "the frequency of the coloured" + of, "Hz", false, o});
    out.push_back({place_in_noise::coloured_damping(o), "the damping of the coloured" + of, "-", false, o});
  }
  return out;
}

/// 2 Δ log L that the coloured noise of an output gains over white noise alone, along the trajectories of the estimate: no less than with
/// the parameters fitted again. Most white noise has as much power as both had, which decides most cases by itself; else all noise is
/// fitted again.
double drop_of_coloured(const FilterEstimate& estimate, std::size_t output, double least, int threads) {
  constexpr int iterations = 4;
  const LinearisedRuns runs{&estimate.forced, &estimate.data, &estimate.traces};
  const double with = fit_noise(runs, estimate.noise, {estimate.reference, threads, 0}).minus_log_density;
  FilterNoise white = estimate.noise, reference = estimate.reference;
  ChannelNoise& channel = white.channels[output];
  reference.channels[output].no_coloured = true;
  channel.white = std::hypot(channel.white, channel.coloured);
  channel.coloured = 1e-3 * reference.channels[output].white;  // its lower bound in pack()
  const auto drop = [&](int most) { return 2.0 * (fit_noise(runs, white, {reference, threads, most}).minus_log_density - with); };
  const double at_once = drop(0);
  return at_once < least ? at_once : drop(iterations);
}

/// Is there coloured noise, or has the search only found the shape in which white noise looks most like it? Where it is not there, neither
/// are its frequency and damping, and their bounds say nothing.
class ColouredNoise {
 public:
  ColouredNoise(const FilterEstimate& estimate, int threads) : estimate_(estimate), threads_(threads) {}

  bool is_there(std::size_t output, Fit& fit) {
    constexpr int parameters = 3;        // strength, frequency, damping
    constexpr double improbable = 1e-4;  // as of innovations that are not white
    constexpr double least_drop = 21.1;  // of about that probability
    const auto [known, first] = there_.emplace(output, true);
    if (!first) return known->second;
    const double drop = drop_of_coloured(estimate_, output, least_drop, threads_);
    known->second = chi_square_tail(drop, parameters) < improbable;
    if (!known->second)
      fit.facts["coloured noise of " + std::string(estimate_.model.system->spec().outputs[output].name)] =
          "hardly more likely than white noise alone (drop " + format_value(std::round(10.0 * drop) / 10.0) + ")";
    return known->second;
  }

 private:
  const FilterEstimate& estimate_;
  int threads_;
  std::map<std::size_t, bool> there_;
};

}  // namespace

void warn_of_noise_at_bounds(const FilterEstimate& estimate, int threads, Fit& fit) {
  constexpr double nearest = 1e-3;  // of the logarithm
  const NoiseVector vector = pack(estimate.noise, estimate.model.system->spec(), estimate.reference);
  ColouredNoise coloured(estimate, threads);
  for (const auto& [at, words, unit, absent_at_lower, shape_of, rounding] : noise_parts(estimate, fit)) {
    if (vector.upper[at] - vector.lower[at] < nearest) continue;  // given by the study
    const bool lower = vector.value[at] - vector.lower[at] < nearest, upper = vector.upper[at] - vector.value[at] < nearest;
    if (!upper && (!lower || absent_at_lower)) continue;
    if (shape_of && !coloured.is_there(*shape_of, fit)) continue;
    if (lower && rounding > 0.0 && std::log(rounding) > vector.lower[at] - nearest) {
      fit.facts[words.substr(4)] =
          "that of its rounding: it is read in whole steps of " + in_display_unit(std::sqrt(12.0) * rounding, unit);
      continue;
    }
    fit.warnings.push_back(words + " is at its " + (lower ? "lower" : "upper") + " bound " +
                           in_display_unit(std::exp(vector.value[at]), unit) +
                           ": the likelihood still rises beyond it, so that this is no estimate");
  }
}

}  // namespace misfit
