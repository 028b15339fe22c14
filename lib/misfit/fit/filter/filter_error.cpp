#include "misfit/fit/filter/filter_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/core/watch.h"
#include "misfit/data/estimators.h"
#include "misfit/data/ladder.h"
#include "misfit/fit/filter/k_step.h"
#include "misfit/fit/filter/noise_report.h"
#include "misfit/fit/filter/settled.h"
#include "misfit/fit/filter/slow_force.h"
#include "misfit/inference/beyond_record.h"
#include "misfit/inference/curve_freedom.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/record_residuals.h"
#include "misfit/inference/short_record.h"
#include "misfit/math/covariance.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"

namespace misfit {
namespace {

/// Quantities at every filtered state, all experiments one after the other.
RowMatrix visited_by_filter(const FilterEstimate& estimate) {
  Evaluator evaluator(estimate.forced.model);
  Eigen::Index rows = 0;
  for (std::size_t e = 0; e < estimate.data.size(); ++e) rows += estimate.traces[e].samples - estimate.data[e].first;
  RowMatrix out(rows, std::ssize(estimate.model.system->spec().quantities));
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    const FilterData& data = estimate.data[e];
    for (std::size_t k = data.first; k < estimate.traces[e].samples; ++k)
      evaluator.quantities(estimate.traces[e].filtered(k).data(), data.inputs.at(k), data.signals->t[k], out.row(row++).data());
  }
  return out;
}

/// Sum of squares of one-step prediction errors, settled ones (settled.h), and how many.
struct Squares {
  double sum = 0.0, count = 0.0;
  void add(double error) {
    sum += error * error;
    count += 1.0;
  }
  [[nodiscard]] double root() const { return std::sqrt(sum / count); }
};

struct ChannelErrors {
  Squares fitted, held_out;
};

/// Output `o` of one experiment.
struct OfChannel {
  ChannelPrediction prediction;
  RecordResiduals residuals;
};

/// Of one experiment.
struct OneStepPredictions {
  const FilterData& data;
  const FilterTrace& trace;
  SettledPredictions known;
};

/// Adds its errors.
OfChannel predict_channel(const OneStepPredictions& predictions, std::size_t o, const OutputSpec& output, ChannelErrors& errors) {
  const FilterData& data = predictions.data;
  const FilterTrace& trace = predictions.trace;
  const Signals& signals = *data.signals;
  OfChannel out{{signals.name, output.name, output.unit, signals.t, signals.measured[o].values, {}, {}, {}}, {}};
  ChannelPrediction& p = out.prediction;
  for (std::size_t k = 0; k < signals.samples(); ++k) {
    const std::size_t at = trace.place(k, o);
    p.predicted.push_back(trace.y[at]);
    p.sigma.push_back(std::sqrt(trace.y_variance[at]));
    p.held_out.push_back(signals.held_out(k));
    if (!predictions.known.settled(k, o)) continue;
    if (data.use[at] == SampleRole::counted) errors.fitted.add(p.measured[k] - trace.y[at]);
    if (data.use[at] == SampleRole::validation) errors.held_out.add(p.measured[k] - trace.y[at]);
    if (data.use[at] == SampleRole::counted || data.use[at] == SampleRole::validation)
      out.residuals.add(p.measured[k], trace.y[at], data.use[at] == SampleRole::validation);
  }
  return out;
}

void add_predictions(const FilterEstimate& estimate, Fit& fit) {
  const auto& outputs = estimate.model.system->spec().outputs;
  std::vector<OneStepPredictions> predictions;
  std::vector<std::vector<std::vector<double>>> ahead;
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    predictions.push_back({estimate.data[e], estimate.traces[e], {estimate.traces[e], estimate.data[e]}});
    ahead.push_back(predictions_far_ahead(estimate, e));
  }
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    ChannelErrors errors;
    for (std::size_t e = 0; e < predictions.size(); ++e) {
      OfChannel channel = predict_channel(predictions[e], o, outputs[o], errors);
      channel.prediction.ahead = std::move(ahead[e][o]);
      channel.residuals.describe(channel.prediction, fit);
      fit.predictions.push_back(std::move(channel.prediction));
    }
    if (errors.fitted.count > 0.0) fit.rms[outputs[o].name] = {errors.fitted.root(), 0.0, outputs[o].unit};
    if (errors.held_out.count > 0.0) fit.validation_rms[outputs[o].name] = {errors.held_out.root(), 0.0, outputs[o].unit};
  }
}

/// Range of a channel's known values but for the outermost 0.5 % on either side; nullopt of fewer than 100.
std::optional<std::pair<double, double>> usual_range(const std::vector<double>& values) {
  constexpr std::size_t fewest = 100, tail = 200;
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known), [](double value) { return std::isfinite(value); });
  std::sort(known.begin(), known.end());
  if (known.size() < fewest) return std::nullopt;
  return std::pair(known[known.size() / tail], known[known.size() - 1 - known.size() / tail]);
}

struct Gaps {
  std::size_t missing = 0;  ///< samples at which a channel is missing
  std::size_t extreme = 0;  ///< of these, those where the motion is predicted beyond the usual range of a missing channel
};

/// nullopt where a channel has too few values to say what is usual.
std::optional<Gaps> gaps_of(const FilterData& data, const FilterTrace& trace) {
  const Signals& signals = *data.signals;
  std::vector<std::pair<double, double>> ranges;
  for (const Signal& channel : signals.measured) {
    const auto range = usual_range(channel.values);
    if (!range) return std::nullopt;
    ranges.push_back(*range);
  }
  Gaps out;
  for (std::size_t k = data.first; k < signals.samples(); ++k) {
    bool gap = false, outside = false;
    for (int o = 0; o < trace.ny; ++o) {
      if (std::isfinite(signals.measured[o].values[k])) continue;
      const double predicted = trace.y[trace.place(k, o)];
      gap = true;
      outside = outside || predicted < ranges[o].first || predicted > ranges[o].second;
    }
    out.missing += gap ? 1 : 0;
    out.extreme += gap && outside ? 1 : 0;
  }
  return out;
}

/// Says how much is missing, and whether it is missing where the motion is extreme: then the gaps are not random.
void report_gaps(const FilterEstimate& estimate, Fit& fit) {
  constexpr double by_chance = 0.02, clearly_more = 5.0;
  constexpr std::size_t fewest_extreme = 5;
  for (std::size_t e = 0; e < estimate.data.size(); ++e) {
    const Signals& signals = *estimate.data[e].signals;
    const std::optional<Gaps> gaps = gaps_of(estimate.data[e], estimate.traces[e]);
    if (!gaps || gaps->missing == 0) continue;
    const auto missing = static_cast<double>(gaps->missing);
    fit.facts["gaps: " + signals.name] = counted(gaps->missing, "sample (", "samples (") +
                                         format_value(100.0 * missing / static_cast<double>(signals.samples())) +
                                         " %) missing; the filter predicts across them";
    if (gaps->extreme < fewest_extreme || static_cast<double>(gaps->extreme) <= clearly_more * by_chance * missing) continue;
    fit.warnings.push_back("experiment '" + signals.name + "': the gaps are not random: in " + std::to_string(gaps->extreme) + " of " +
                           std::to_string(gaps->missing) +
                           " missing samples the motion is predicted beyond 99 % of what was measured (a sensor at its "
                           "limit, or a marker out of the picture): extreme "
                           "motion is under-represented");
  }
}

/// Of the times of measurements at which the filter's linearisation is not valid.
std::string excluded_in_words(const std::vector<double>& times) {
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  const std::string at = format_value(*first),
                    place = times.size() == 1 ? "at t = " + at + " s is" : "between t = " + at + " s and " + format_value(*last) + " s are";
  return counted(times.size(), "measurement", "measurements") + " " + place +
         " excluded: the filter's linearisation is not valid there (it changes when a parameter moves by 0.05 sigma)";
}

/// Where the study has one initial state for all experiments.
void say_that_starts_are_not_shared(const FilterEstimate& estimate, Fit& fit) {
  std::vector<std::string> shared;
  for (const StateSpec& state : estimate.model.state_specs) {
    if (state.initial == Initial::shared) shared.push_back(state.name);
  }
  const auto begins = [](const FilterData& data) { return !data.signals->after_gap; };
  if (shared.empty() || std::count_if(estimate.data.begin(), estimate.data.end(), begins) < 2) return;
  fit.facts["shared initial states"] = join_words(shared) + ": of each experiment its own here, as uncertain as its motion is wide";
}

/// In the free parameters and, where they are estimated together, the noise. The estimate is a maximum: there the data's slope is minus
/// that of priors and roughness.
NormalEquations linearised(const FilterEstimate& estimate) {
  const bool joint = estimate.joint_covariance.size() > 0;
  const Eigen::Index columns = estimate.covariance.rows(), all = joint ? estimate.joint_covariance.rows() : columns;
  NormalEquations problem;
  problem.theta = Eigen::VectorXd::Zero(all);
  problem.theta.head(columns) = estimate.model.theta();
  problem.prior = parameter_priors(estimate.model).padded(all);
  problem.N = Eigen::MatrixXd::Zero(all, all);
  if (joint) {
    problem.N = estimate.joint_information;
    problem.N.diagonal() -= problem.prior.precision;
  } else {
    for (const auto& jacobian : estimate.jacobians) problem.N += jacobian.J.transpose() * jacobian.J;
    problem.prior = regularised_priors_about(problem.theta, estimate.model, estimate.penalties, problem.N);
  }
  problem.g = GaussianPrior{problem.prior, estimate.penalties}.gradient(problem.theta);
  return problem;
}

/// Of the free parameters with what is not known of the roughness.
Eigen::MatrixXd covariance_of(const FilterEstimate& estimate, const NormalEquations& problem) {
  const Eigen::Index columns = estimate.covariance.rows();
  const Eigen::MatrixXd out = with_uncertain_roughness(problem, estimate.penalties, 1.0);
  return out.size() > 0 ? Eigen::MatrixXd(out.topLeftCorner(columns, columns)) : estimate.covariance;
}

/// Innovations under a right model are white; says where they are not.
void test_innovations(const FilterEstimate& estimate, Fit& fit) {
  const auto& outputs = estimate.model.system->spec().outputs;
  constexpr int last_lag = 20;
  constexpr double improbable = 1e-4, least_correlation = 0.05;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    for (std::size_t e = 0; e < estimate.data.size(); ++e) {
      const FilterTrace& trace = estimate.traces[e];
      std::vector<double> innovations(trace.samples, std::nan(""));
      for (std::size_t k = 0; k < trace.samples; ++k) {
        const std::size_t at = k * static_cast<std::size_t>(trace.ny) + o;
        if (estimate.data[e].use[at] == SampleRole::counted && trace.S[at] > 0.0) innovations[k] = trace.e[at] / std::sqrt(trace.S[at]);
      }
      const WhitenessTest test = whiteness(on_even_grid(estimate.data[e].signals->t, innovations), 1, last_lag);
      if (!(test.p_value < improbable) || std::abs(test.largest) < least_correlation) continue;
      fit.warnings.push_back(
          "the innovations of " + outputs[o].name + " in '" + estimate.data[e].signals->name + "' are not white (Ljung-Box " +
          p_equals(test.p_value) + ", largest autocorrelation " + format_value(std::round(1000.0 * test.largest) / 1000.0) + " at lag " +
          std::to_string(test.largest_lag) +
          "): the process or noise model is incomplete (of waves or hum in an output: frequency of [noise]); standard errors assume "
          "whiteness and may be too small");
    }
  }
}

/// What is estimated beside the free parameters: initial states of the system in every experiment, but for known ones, and the noise. A
/// state of which something is known beforehand counts in full: degrees of freedom are rather too few.
double unknowns_beside_parameters(const FilterEstimate& estimate) {
  double states = 0.0;
  for (const FilterData& data : estimate.data)
    states += static_cast<double>((data.covariance.diagonal().head(estimate.model.system_states()).array() > 0.0).count());
  return states + static_cast<double>(estimate.noise_fit.logs.size());
}

/// Measurements in the likelihood, and how many of them are left when everything estimated is taken off.
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

void describe_estimates(const FilterEstimate& estimate, Fit& fit) {
  const NormalEquations problem = linearised(estimate);
  describe(estimate.model, short_record_factor(estimate) * covariance_of(estimate, problem), visited_by_filter(estimate), fit);
  describe_roughness(estimate.model, roughness_paths(problem, estimate.penalties, 1.0), fit);
  describe_freedom(estimate.model, problem, estimate.penalties, 1.0, fit);
}

/// A search with the weak priors that keep it regular ends with such parameters where it began, or where chance took them. Their sigma
/// would be that of those priors: there is none.
void warn_of_undetermined(const FilterEstimate& estimate, Fit& fit) {
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(estimate.covariance.rows());
  for (const auto& jacobian : estimate.jacobians) measured += jacobian.J.colwise().squaredNorm().transpose();
  const Eigen::VectorXd stated = parameter_priors(estimate.model).padded(estimate.covariance.rows()).precision;
  const std::string idle = without_effect(estimate.model, measured + stated);
  if (!idle.empty()) fit.warnings.push_back(idle);
  for (const int parameter : left_to_wide_priors(estimate.model, measured, fit.covariance)) {
    const Parameter& p = estimate.model.parameters[parameter];
    Estimate& known = fit.parameters.at(p.name);
    known.sigma = 0.0;
    known.interval.reset();
    if (idle.empty())
      fit.add_doubt(p.name + " is not determined by these data",
                    ": beside " + in_display_unit(p.value, p.unit) + " any value serves as well");
  }
}

/// [s] The longest of the recordings.
double longest_of(const FilterEstimate& estimate) {
  double longest = 0.0;
  for (const FilterData& data : estimate.data) longest = std::max(longest, data.signals->seconds());
  return longest;
}

void warn_beyond_recording(const FilterEstimate& estimate, Fit& fit) {
  for (const BoundEffect& effect : estimate.model.effects) {
    if (const auto words = outlasts_recording(estimate.model, effect, longest_of(estimate))) fit.add_doubt(*words);
  }
}

/// Intervals of a short record, or that it is too short for any. What of the noise ended at its bound (a force or a coloured noise that is
/// not there) has taken no degree of freedom from its variance.
void allow_for_length(const FilterEstimate& estimate, Fit& fit) {
  const Degrees degrees = degrees_of(estimate);
  if (degrees.left() >= kShortRecord) return;
  if (degrees.left() >= kFewestDegrees) {
    const auto idle = static_cast<double>(std::count(estimate.noise_fit.at_bound.begin(), estimate.noise_fit.at_bound.end(), true));
    add_student_intervals(degrees.left() + idle, fit);
    return;
  }
  withhold_sigmas(
      format_value(degrees.measurements) + " measurements for " + format_value(std::round(10.0 * degrees.unknowns) / 10.0) +
          " unknowns (free parameters, initial states, noise and random force) are too few to estimate the uncertainty of the values: no "
          "sigma is given",
      fit);
}

}  // namespace

Fit filter_fit(const FilterEstimate& estimate, int threads) {
  Fit fit;
  fit.method = estimators::filter_error.name;
  fit.status = estimate.converged ? FitStatus::converged : FitStatus::not_converged;
  fit.message = estimate.message;
  fit.loglik = estimate.loglik;
  std::size_t validated = 0;
  for (const auto& trace : estimate.traces) validated += trace.validated;
  if (validated > 0) fit.validation_loglik = estimate.validation_loglik;
  if (estimate.covariance.size() > 0) {
    describe_estimates(estimate, fit);
    warn_of_undetermined(estimate, fit);
  }
  warn_of_collinearity(estimate.model, fit.covariance, fit);
  warn_beyond_recording(estimate, fit);
  add_noise(estimate, threads, fit);
  if (const std::string slow = fit.driven ? warning_of_slow_force(estimate) : ""; !slow.empty()) fit.warnings.push_back(slow);
  add_predictions(estimate, fit);
  report_gaps(estimate, fit);
  say_that_starts_are_not_shared(estimate, fit);
  test_innovations(estimate, fit);
  if (!estimate.integration.empty()) fit.facts["integration"] = estimate.integration;
  for (const auto& data : estimate.data) {
    if (!data.inputs.plan.lack.empty()) fit.warnings.push_back("experiment '" + data.signals->name + "': " + data.inputs.plan.lack);
  }
  fit.facts["effective_parameters"] = format_value(estimate.edf);
  fit.facts["newton_decrement"] = estimate.newton_decrement ? "one more Newton step on the exact likelihood would raise it by " +
                                                                  format_value(*estimate.newton_decrement)
                                                            : "not verified";
  fit.warnings.insert(fit.warnings.end(), estimate.notes.begin(), estimate.notes.end());
  if (!estimate.nonlinear.empty()) fit.warnings.push_back(excluded_in_words(estimate.nonlinear));
  if (estimate.outliers > 0) {
    fit.warnings.push_back(counted(static_cast<std::size_t>(estimate.outliers),
                                   "measurement more than 5 sigma from its prediction is rejected as an outlier",
                                   "measurements more than 5 sigma from their prediction are rejected as outliers"));
  }
  const FilterData& first = estimate.data.front();
  const std::vector<std::string> scales =
      scale_uncertainties(estimate.model, first.start.data(), first.inputs.at(first.first), first.signals->t[first.first]);
  fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
  warn_of_other_trims(fit);
  reject_prior_conflicts(estimate.model, fit.covariance, fit);
  warn_of_noise_at_bounds(estimate, threads, fit);
  allow_for_length(estimate, fit);
  fit.linearisations = estimate.linearisations;
  return fit;
}

FilterErrorFit filter_error(const FittedModel& start, const std::vector<Signals>& experiments, const FilterOptions& options) {
  FilterOptions here = options;
  if (start.integration > 0.0) here.integration = std::min(here.integration, start.integration);
  return filter_error(std::vector<FilterStart>{{start.model, curve_penalties(start.model)}}, experiments, here);
}

FilterErrorFit filter_error(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments, const FilterOptions& options) {
  const Stopwatch clock;
  FilterErrorFit out;
  try {
    out.estimate = estimate_filter(starts, experiments, options);
    const SuspendedTimeLimit writing_up;
    out.fit = filter_fit(*out.estimate, options.threads);
  } catch (const RunError& error) {
    out.fit.method = estimators::filter_error.name;
    out.fit.status = FitStatus::declined;
    out.fit.message = error.what();
  } catch (const TimeLimitReached& spent) {
    out.fit.method = estimators::filter_error.name;
    out.fit.message = spent.what();
  }
  out.fit.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
