#include "misfit/fit/filter/filter_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/ladder.h"
#include "misfit/fit/filter/noise_interval.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/short_record.h"
#include "misfit/inference/whiteness.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// States after the measurements of each sample were taken in; rows from the first used sample on.
RowMatrix filtered_states(const FilterTrace& trace, std::size_t first) {
  const auto n = static_cast<std::size_t>(trace.n);
  RowMatrix x(static_cast<Eigen::Index>(trace.samples - first), trace.n);
  for (std::size_t k = first; k < trace.samples; ++k) {
    for (std::size_t i = 0; i < n; ++i)
      x(static_cast<Eigen::Index>(k - first), static_cast<Eigen::Index>(i)) = trace.predicted[k * n + i] + trace.correction[k * n + i];
  }
  return x;
}

RowMatrix visited_by_filter(const FilterEstimate& estimate) {
  Evaluator evaluator(estimate.forced.model);
  const auto quantities = static_cast<Eigen::Index>(estimate.model.system->spec().quantities.size());
  RowMatrix out(0, quantities);
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    const FilterData& data = estimate.data[e];
    const RowMatrix x = filtered_states(estimate.traces[e], data.first);
    const Eigen::Index before = out.rows();
    out.conservativeResize(before + x.rows(), quantities);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      const std::size_t sample = data.first + static_cast<std::size_t>(k);
      evaluator.quantities(x.row(k).data(), data.inputs.at(sample), data.signals->t[sample], out.row(before + k).data());
    }
  }
  return out;
}

/// Standard deviations of the logarithms of the noise parameters; 0 where a parameter sits at its bound or is not determined.
std::vector<double> noise_sigmas(const FilterEstimate& estimate) {
  const NoiseFit& fit = estimate.noise_fit;
  Eigen::MatrixXd information = fit.information;
  const std::vector<bool> known = pin_unknown(fit, information);
  const Eigen::Index q = information.rows();
  const Eigen::MatrixXd covariance = estimate.joint_covariance.size() > 0
                                         ? Eigen::MatrixXd(estimate.joint_covariance.bottomRightCorner(q, q))
                                         : Eigen::MatrixXd(information.inverse());
  std::vector<double> out;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    out.push_back(known[static_cast<std::size_t>(i)] ? std::sqrt(std::max(covariance(i, i), 0.0)) : 0.0);
  return out;
}

void add_noise(const FilterEstimate& estimate, int threads, Fit& fit) {
  const SystemSpec& spec = estimate.model.system->spec();
  const NoiseVector vector = pack(estimate.noise, spec, estimate.around);
  const std::vector<double> sigmas = noise_sigmas(estimate);
  const auto as_estimate = [&](std::size_t i, const std::string& unit) {
    const double value = std::exp(vector.value[i]);
    return Estimate{value, value * sigmas[i], unit};
  };
  const auto intervals = noise_intervals(estimate, {0, 1}, threads);
  for (int port : estimate.forced.force_ports) {
    const PortSpec& named = spec.dynamic_ports[static_cast<std::size_t>(port)];
    fit.force[named.name] = as_estimate(0, named.unit);
    fit.force[named.name].interval = intervals[0];
  }
  fit.force["correlation_time"] = as_estimate(1, "s");
  fit.force["correlation_time"].interval = intervals[1];
  if (!(sigmas[0] > 0.0)) fit.facts["random_force"] = "the data ask for no random force: the motion is not driven";
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    const std::string& name = spec.outputs[o].name;
    const std::string& unit = spec.outputs[o].unit;
    fit.noise[name] = as_estimate(2 + 4 * o, unit);
    if (!(sigmas[3 + 4 * o] > 0.0)) {
      fit.facts["jitter of " + name] = "none: the measurement noise is white";
      continue;
    }
    fit.noise[name + "_jitter"] = as_estimate(3 + 4 * o, unit);
    fit.noise[name + "_jitter_frequency"] = as_estimate(4 + 4 * o, "Hz");
    fit.noise[name + "_jitter_damping"] = as_estimate(5 + 4 * o, "-");
  }
  fit.driven = sigmas[0] > 0.0;
}

/// Sum of squares of one-step prediction errors, and how many.
struct Squares {
  double sum = 0.0, count = 0.0;
  void add(double error) {
    sum += error * error;
    count += 1.0;
  }
  [[nodiscard]] double root() const { return std::sqrt(sum / count); }
};

/// One channel of one experiment; adds its errors to `fitted` and `held_out`.
ChannelPrediction predict_channel(const FilterData& data, const FilterTrace& trace, const OutputSpec& output, std::size_t o,
                                  Squares& fitted, Squares& held_out) {
  const Signals& signals = *data.signals;
  ChannelPrediction p{signals.name, output.name, output.unit, signals.t, signals.measured[o].values, {}, {}, {}};
  for (std::size_t k = 0; k < signals.samples(); ++k) {
    const std::size_t at = k * static_cast<std::size_t>(trace.ny) + o;
    p.predicted.push_back(trace.y[at]);
    p.sigma.push_back(std::sqrt(trace.y_variance[at]));
    p.held_out.push_back(signals.held_out(k));
    if (data.use[at] == SampleRole::counted) fitted.add(p.measured[k] - trace.y[at]);
    if (data.use[at] == SampleRole::validation) held_out.add(p.measured[k] - trace.y[at]);
  }
  return p;
}

void add_predictions(const FilterEstimate& estimate, Fit& fit) {
  const auto& outputs = estimate.model.system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    Squares fitted, held_out;
    for (std::size_t e = 0; e < estimate.data.size(); ++e)
      fit.predictions.push_back(predict_channel(estimate.data[e], estimate.traces[e], outputs[o], o, fitted, held_out));
    if (fitted.count > 0.0) fit.rms[outputs[o].name] = {fitted.root(), 0.0, outputs[o].unit};
    if (held_out.count > 0.0) fit.validation_rms[outputs[o].name] = {held_out.root(), 0.0, outputs[o].unit};
  }
}

/// Says how much is missing, and whether it is missing where the motion is extreme: then the gaps are not random.
void describe_gaps(const FilterEstimate& estimate, Fit& fit) {
  const auto& outputs = estimate.model.system->spec().outputs;
  const std::size_t ny = outputs.size();
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const Signals& signals = *estimate.data[e].signals;
    std::size_t missing = 0, extreme = 0;
    std::vector<double> lowest(ny), highest(ny);
    for (std::size_t o = 0; o < ny; ++o) {
      std::vector<double> known;
      for (double value : signals.measured[o].values) {
        if (std::isfinite(value)) known.push_back(value);
      }
      std::sort(known.begin(), known.end());
      if (known.size() < 100) return;
      lowest[o] = known[known.size() / 200];
      highest[o] = known[known.size() - 1 - known.size() / 200];
    }
    for (std::size_t k = estimate.data[e].first; k < signals.samples(); ++k) {
      bool gap = false, outside = false;
      for (std::size_t o = 0; o < ny; ++o) {
        if (std::isfinite(signals.measured[o].values[k])) continue;
        gap = true;
        outside = outside || trace.y[k * ny + o] < lowest[o] || trace.y[k * ny + o] > highest[o];
      }
      missing += gap ? 1 : 0;
      extreme += gap && outside ? 1 : 0;
    }
    if (missing == 0) continue;
    const double share = 100.0 * static_cast<double>(missing) / static_cast<double>(signals.samples());
    fit.facts["gaps: " + signals.name] =
        std::to_string(missing) + " samples (" + format_value(share) + " %) are missing; the filter predicts across them";
    constexpr double by_chance = 0.02;
    if (static_cast<double>(extreme) > 5.0 * by_chance * static_cast<double>(missing) && extreme >= 5) {
      fit.warnings.push_back("experiment '" + signals.name + "': the gaps are not random: in " + std::to_string(extreme) + " of " +
                             std::to_string(missing) +
                             " missing samples the motion is predicted beyond 99 % of what was measured (it left the picture): extreme "
                             "motion is under-represented");
    }
  }
}

/// Covariance of the free parameters with what is not known of the roughness. The estimate is a maximum: there the data's slope is minus
/// that of priors and roughness.
Eigen::MatrixXd covariance_of(const FilterEstimate& estimate) {
  const bool joint = estimate.joint_covariance.size() > 0;
  const Eigen::MatrixXd& whole = joint ? estimate.joint_covariance : estimate.covariance;
  const Eigen::Index columns = estimate.covariance.rows(), all = whole.rows();
  NormalEquations problem;
  set_priors(estimate.model, problem);
  problem.prior_precision.conservativeResizeLike(Eigen::VectorXd::Zero(all));
  problem.prior_mean.conservativeResizeLike(Eigen::VectorXd::Zero(all));
  problem.theta = Eigen::VectorXd::Zero(all);
  const std::vector<int> free = estimate.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c)
    problem.theta[static_cast<Eigen::Index>(c)] = estimate.model.parameters[static_cast<std::size_t>(free[c])].value;
  problem.N = Eigen::MatrixXd::Zero(all, all);
  if (joint) {
    problem.N = estimate.joint_information;
    problem.N.diagonal() -= problem.prior_precision;
  } else {
    for (const auto& jacobian : estimate.jacobians) problem.N += jacobian.J.transpose() * jacobian.J;
  }
  problem.g = -problem.prior_precision.cwiseProduct(problem.theta - problem.prior_mean);
  for (const auto& p : estimate.penalties) {
    const auto size = p.omega.rows();
    problem.g.segment(p.first, size) -= p.lambda * (p.omega * problem.theta.segment(p.first, size));
  }
  const Eigen::MatrixXd out = with_uncertain_roughness(problem, estimate.penalties, 1.0);
  return out.size() > 0 ? Eigen::MatrixXd(out.topLeftCorner(columns, columns)) : estimate.covariance;
}

/// Innovations under a right model are white; says where they are not.
void test_innovations(const FilterEstimate& estimate, Fit& fit) {
  const auto& outputs = estimate.model.system->spec().outputs;
  constexpr int last_lag = 20;
  constexpr double improbable = 1e-4, worth_saying = 0.05;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    for (std::size_t e = 0; e < estimate.data.size(); ++e) {
      const FilterTrace& trace = estimate.traces[e];
      std::vector<double> innovations(trace.samples, std::nan(""));
      for (std::size_t k = 0; k < trace.samples; ++k) {
        const std::size_t at = k * static_cast<std::size_t>(trace.ny) + o;
        if (estimate.data[e].use[at] == SampleRole::counted && trace.S[at] > 0.0) innovations[k] = trace.e[at] / std::sqrt(trace.S[at]);
      }
      const WhitenessTest test = whiteness(on_even_grid(estimate.data[e].signals->t, innovations), 1, last_lag);
      if (!(test.p_value < improbable) || std::abs(test.largest) < worth_saying) continue;
      fit.warnings.push_back("the innovations of " + outputs[o].name + " in '" + estimate.data[e].signals->name +
                             "' are not white (Ljung-Box p = " + format_probability(test.p_value) + ", largest autocorrelation " +
                             format_value(std::round(1000.0 * test.largest) / 1000.0) + " at lag " + std::to_string(test.largest_lag) +
                             "): the process or noise model is incomplete; standard errors assume whiteness and may be too small");
    }
  }
}

/// What is estimated beside the free parameters: initial states of the system in every experiment, and the noise.
double unknowns_beside_parameters(const FilterEstimate& estimate) {
  const auto states = static_cast<double>(estimate.model.system_states()) * static_cast<double>(estimate.data.size());
  return states + static_cast<double>(pack(estimate.noise, estimate.model.system->spec(), estimate.around).value.size());
}

/// Readings in the likelihood, and how many of them are left when everything estimated is taken off.
struct Degrees {
  double measurements = 0.0, unknowns = 0.0;
  [[nodiscard]] double left() const { return measurements - unknowns; }
};

Degrees degrees_of(const FilterEstimate& estimate) {
  Degrees out;
  for (const auto& trace : estimate.traces) out.measurements += static_cast<double>(trace.counted);
  out.unknowns = estimate.edf + unknowns_beside_parameters(estimate);
  return out;
}

/// The likelihood takes the noise for what fits best: on a short record its variances are too small by the share of measurements that went
/// into noise and initial states (those that went into parameters are put back by the restricted likelihood).
double short_record_factor(const FilterEstimate& estimate) {
  const Degrees degrees = degrees_of(estimate);
  if (degrees.left() < kFewestDegrees || degrees.left() >= kShortRecord) return 1.0;
  return degrees.measurements / (degrees.measurements - unknowns_beside_parameters(estimate));
}

/// Intervals of a short record, or that it is too short for any.
void allow_for_length(const FilterEstimate& estimate, Fit& fit) {
  const Degrees degrees = degrees_of(estimate);
  if (degrees.left() >= kShortRecord) return;
  if (degrees.left() >= kFewestDegrees) {
    add_student_intervals(degrees.left(), fit);
    return;
  }
  withhold_sigmas(format_value(degrees.measurements) + " measurements for " + format_value(std::round(10.0 * degrees.unknowns) / 10.0) +
                      " unknowns (free parameters, initial states, noise and random force) are too few to tell how far off the values "
                      "are: no sigma is given",
                  fit);
}

}  // namespace

Fit filter_fit(const FilterEstimate& estimate, int threads) {
  Fit fit;
  fit.method = "filter_error";
  fit.status = estimate.converged ? FitStatus::converged : FitStatus::not_converged;
  fit.message = estimate.message;
  fit.loglik = estimate.loglik;
  std::size_t validated = 0;
  for (const auto& trace : estimate.traces) validated += trace.validated;
  if (validated > 0) fit.validation_loglik = estimate.validation_loglik;
  if (estimate.covariance.size() > 0)
    describe(estimate.model, short_record_factor(estimate) * covariance_of(estimate), visited_by_filter(estimate), fit);
  add_noise(estimate, threads, fit);
  add_predictions(estimate, fit);
  describe_gaps(estimate, fit);
  test_innovations(estimate, fit);
  if (!estimate.integration.empty()) fit.facts["integration"] = estimate.integration;
  for (const auto& data : estimate.data) {
    if (!data.inputs.plan.lack.empty()) fit.warnings.push_back(data.signals->name + ": " + data.inputs.plan.lack);
  }
  fit.facts["effective_parameters"] = format_value(estimate.edf);
  fit.facts["left_by_exact_derivatives"] =
      estimate.left ? "one more Newton step on the exact likelihood would raise it by " + format_value(*estimate.left) : "not verified";
  if (!estimate.nonlinear.empty()) {
    const auto [first_at, last_at] = std::minmax_element(estimate.nonlinear.begin(), estimate.nonlinear.end());
    fit.warnings.push_back(std::to_string(estimate.nonlinear.size()) + " measurements between t = " + format_value(*first_at) + " and " +
                           format_value(*last_at) +
                           " s are excluded: the filter is too nonlinear there (a parameter change of 0.05 sigma)");
  }
  if (estimate.outliers > 0)
    fit.warnings.push_back(std::to_string(estimate.outliers) +
                           " measurements more than 5 sigma from their prediction are rejected as outliers");
  const FilterData& first = estimate.data.front();
  const std::vector<std::string> scales =
      scale_uncertainties(estimate.model, first.start.data(), first.inputs.at(first.first), first.signals->t[first.first]);
  fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
  tell_weak_directions(estimate.model, fit.covariance, fit);
  tell_other_trims(fit);
  refuse_runaways(estimate.model, fit.covariance, fit);
  allow_for_length(estimate, fit);
  fit.linearisations = estimate.linearisations;
  return fit;
}

FilterError filter_error(const FittedModel& start, const std::vector<Signals>& experiments, const FilterOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  FilterError out;
  try {
    FilterOptions here = options;
    if (start.integration > 0.0) here.integration = std::min(here.integration, start.integration);
    out.estimate = estimate_filter(start.model, curve_penalties(start.model), experiments, here);
    out.fit = filter_fit(*out.estimate, options.threads);
  } catch (const RunError& error) {
    out.fit.method = "filter_error";
    out.fit.status = FitStatus::declined;
    out.fit.message = error.what();
  }
  out.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace misfit
