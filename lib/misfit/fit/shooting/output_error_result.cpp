#include "misfit/fit/shooting/output_error_result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "misfit/core/display.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/record_residuals.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"

namespace misfit::output_error_parts {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double follows = 0.5;  // of the motion's own size: a model that leaves less explains most of it

/// Predicted − measured of output o, per experiment and sample; NaN where it does not count.
std::vector<std::vector<double>> channel_residuals(const SimulatedRuns& end, std::size_t o) {
  const auto& [shooting, runs, experiments] = end;
  std::vector<std::vector<double>> out;
  for (std::size_t e = 0; e < runs.size(); ++e) {
    out.emplace_back(experiments[e].samples(), std::nan(""));
    for (std::size_t i = 0; i < experiments[e].samples() && runs[e].finite; ++i) {
      if (!shooting.counts(e, i, o)) continue;
      out.back()[i] = runs[e].y(i, o) - experiments[e].measured[o].values[i];
    }
  }
  return out;
}

struct Squares {
  double sum = 0.0, count = 0.0;
  [[nodiscard]] double rms() const { return std::sqrt(sum / std::max(count, 1.0)); }
};

/// Measurements of output o, NaN where they do not count.
std::vector<double> counted_values(const Signals& experiment, std::size_t o) {
  std::vector<double> out = o < experiment.measured.size() ? experiment.measured[o].values : std::vector<double>{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (i < experiment.exclude || experiment.held_out(i)) out[i] = std::nan("");
  }
  return out;
}

/// The motion that output o shows, of all experiments: deviations of the measurements that count from their mean in the experiment.
Squares motion_of(const std::vector<Signals>& experiments, std::size_t o) {
  Squares out;
  for (const Signals& experiment : experiments) {
    const std::vector<double> values = counted_values(experiment, o);
    const auto count = static_cast<double>(count_finite(values));
    out.sum += count * std::pow(standard_deviation(values), 2);
    out.count += count;
  }
  return out;
}

/// White noise of output o, of all experiments in which it counts; NaN where none tells.
double noise_of(const std::vector<Signals>& experiments, std::size_t o) {
  Squares out;
  for (const Signals& experiment : experiments) {
    const auto count = static_cast<double>(count_finite(counted_values(experiment, o)));
    if (count == 0.0) continue;
    const double noise = measurement_noise(experiment.measured[o].values);
    if (!std::isfinite(noise)) continue;
    out.sum += count * noise * noise;
    out.count += count;
  }
  return out.count > 0.0 ? out.rms() : std::nan("");
}

Squares squares_of(const std::vector<std::vector<double>>& residuals) {
  Squares out;
  for (const auto& series : residuals) {
    for (const double r : series) {
      if (std::isfinite(r)) out.sum += r * r, out.count += 1.0;
    }
  }
  return out;
}

/// Residuals of every output.
std::vector<Squares> residuals_of_outputs(const SimulatedRuns& end) {
  std::vector<Squares> out;
  for (std::size_t o = 0; o < end.shooting.sigma().size(); ++o) out.push_back(squares_of(channel_residuals(end, o)));
  return out;
}

/// Noise of every output by its residuals, which lose their share of the parameters; nullopt where they are too few, or 0.
std::vector<std::optional<double>> noise_by_residuals(const std::vector<Squares>& residuals, double edf) {
  double all = 0.0;
  for (const Squares& of : residuals) all += of.count;
  std::vector<std::optional<double>> out;
  for (const auto& [squares, count] : residuals) {
    const double share = edf * count / std::max(all, 1.0);
    const bool enough = count > share + 1.0 && squares > 0.0;
    out.push_back(enough ? std::optional(std::sqrt(squares / (count - share))) : std::nullopt);
  }
  return out;
}

}  // namespace

std::vector<double> channel_sigmas(const SimulatedRuns& end, double edf) {
  std::vector<double> sigma = end.shooting.sigma();
  const std::vector<std::optional<double>> found = noise_by_residuals(residuals_of_outputs(end), edf);
  for (std::size_t o = 0; o < sigma.size(); ++o) {
    if (!end.shooting.model().known_noise[o].fixed) sigma[o] = found[o].value_or(sigma[o]);
  }
  return sigma;
}

void warn_of_unknown_noise(const SimulatedRuns& end, double edf, Fit& fit) {
  const Model& model = end.shooting.model();
  const auto& outputs = model.system->spec().outputs;
  const std::vector<Squares> residuals = residuals_of_outputs(end);
  const std::vector<std::optional<double>> found = noise_by_residuals(residuals, edf);
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    if (model.known_noise[o].fixed || found[o]) continue;
    const auto in_unit = [&](double value) { return in_display_unit(value, outputs[o].unit); };
    fit.warnings.push_back("the noise of " + outputs[o].name +
                           " could not be estimated (measurements that count: " + format_value(residuals[o].count) + ", residual RMS " +
                           in_unit(residuals[o].rms()) + "): it stands at the first guess, " + in_unit(end.shooting.sigma()[o]));
  }
}

/// RMS of a channel's residuals in units of its sigma where that is given, so that only their correlation counts; else 1.
std::vector<double> sizes_where_given(const SimulatedRuns& end) {
  std::vector<double> out;
  for (std::size_t o = 0; o < end.shooting.sigma().size(); ++o) {
    const auto [squares, count] = squares_of(channel_residuals(end, o));
    const bool given = end.shooting.model().known_noise[o].fixed && squares > 0.0;
    out.push_back(given ? std::sqrt(squares / count) / end.shooting.sigma()[o] : 1.0);
  }
  return out;
}

std::vector<ResidualRows> residual_rows(const SimulatedRuns& end) {
  const auto& [shooting, runs, experiments] = end;
  std::vector<ResidualRows> out;
  const std::size_t ny = shooting.model().outputs();
  const std::vector<double> sizes = sizes_where_given(end);
  for (std::size_t e = 0; e < runs.size(); ++e) {
    ResidualRows rows{runs[e].y_rows, Eigen::VectorXd(runs[e].y_rows.rows()), {}};
    for (std::size_t i = 0; i < experiments[e].samples(); ++i) {
      for (std::size_t o = 0; o < ny; ++o) {
        const Eigen::Index at = i * ny + o;
        const bool used = shooting.counts(e, i, o);
        const double weight = used ? 1.0 / shooting.sigma()[o] : 0.0;
        rows.J.row(at) *= weight;
        rows.r[at] = used ? weight / sizes[o] * (runs[e].y(i, o) - experiments[e].measured[o].values[i]) : std::nan("");
      }
    }
    const Eigen::Index n = shooting.model().states(), columns = rows.J.cols() - n;
    for (Eigen::Index c = 0; c < columns; ++c) rows.place.push_back(c);
    for (Eigen::Index j = 0; j < n; ++j) rows.place.push_back(columns + n * static_cast<Eigen::Index>(e) + j);
    out.push_back(std::move(rows));
  }
  return out;
}

void predictions_of(const SimulatedRuns& end, const Eigen::MatrixXd& covariance, Fit& fit) {
  const auto& [shooting, runs, experiments] = end;
  const auto& outputs = shooting.model().system->spec().outputs;
  const Eigen::Index ny = outputs.size();
  const Eigen::Index n = shooting.model().states();
  for (std::size_t e = 0; e < runs.size(); ++e) {
    const Segment& run = runs[e];
    const Eigen::Index columns = run.y_rows.cols() - n;
    const RowMatrix& rows = run.y_rows;
    Eigen::MatrixXd joint(columns + n, columns + n);
    const Eigen::Index at = columns + n * e;
    joint << covariance.topLeftCorner(columns, columns), covariance.block(0, at, columns, n), covariance.block(at, 0, n, columns),
        covariance.block(at, at, n, n);
    const Eigen::VectorXd spread = (rows * joint).cwiseProduct(rows).rowwise().sum();
    for (Eigen::Index o = 0; o < ny; ++o) {
      ChannelPrediction p;
      p.experiment = experiments[e].name;
      p.channel = outputs[o].name;
      p.unit = outputs[o].unit;
      p.t = experiments[e].t;
      p.measured = experiments[e].measured[o].values;
      const double sigma = shooting.sigma()[o];
      for (std::size_t i = 0; i < p.t.size(); ++i) {
        const Eigen::Index row = i;
        p.predicted.push_back(run.y(row, o));
        p.sigma.push_back(std::sqrt(sigma * sigma + std::max(spread[row * ny + o], 0.0)));
        p.held_out.push_back(experiments[e].held_out(i));
      }
      fit.predictions.push_back(std::move(p));
    }
  }
}

void set_noise(const Shooting& shooting, const std::vector<Signals>& experiments, double degrees, Fit& fit) {
  const auto& outputs = shooting.model().system->spec().outputs;
  std::vector<double> measured(outputs.size(), 0.0);
  double all = 0.0;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    for (std::size_t i = 0; i < experiments[e].samples(); ++i) {
      for (std::size_t o = 0; o < outputs.size(); ++o) measured[o] += shooting.counts(e, i, o) ? 1.0 : 0.0;
    }
  }
  for (const double count : measured) all += count;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const double degrees_each = std::max(degrees * measured[o] / std::max(all, 1.0), 1.0);
    const double sigma = shooting.sigma()[o];
    const double sigma_of_it = shooting.model().known_noise[o].fixed ? 0.0 : sigma / std::sqrt(2.0 * degrees_each);
    fit.noise[outputs[o].name] = {sigma, sigma_of_it, outputs[o].unit};
  }
}

namespace {

/// Where the initial state of an experiment that is held out as a whole comes from.
std::string start_in_words(const Shooting& shooting, std::size_t experiment) {
  const Model& model = shooting.model();
  const std::size_t of_system = model.state_specs.size(), states = model.states();
  std::vector<std::string> read;
  for (std::size_t j = 0; j < states; ++j) {
    if (!shooting.read_from_samples(experiment, j)) continue;
    read.push_back(j < of_system ? model.state_specs[j].name : model.own_state_names[j - of_system]);
  }
  if (read.size() == states) return "its initial state is taken from its first samples";
  if (read.empty()) return "its initial state is the one that is fixed, or shared with the others";
  return "of its initial state " + join_words(read) + (read.size() > 1 ? " are" : " is") +
         " taken from its first samples, the rest is fixed or shared with the others";
}

}  // namespace

void set_initial_states(const Shooting& shooting, const std::vector<Signals>& experiments, FittedModel& out) {
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    out.initial_states.push_back(shooting.initial_state(e));
    if (shooting.held_out(e))
      out.fit.facts["held out: " + experiments[e].name] = "all its samples are held out: " + start_in_words(shooting, e);
  }
}

std::string too_few(double count, double unknowns) {
  return format_value(count) + " measurements for " + format_value(std::round(10.0 * unknowns) / 10.0) +
         " unknowns (free parameters and initial states) are too few to estimate the uncertainty of the values: no sigma is given";
}

void show_segments(Shooting& shooting, const std::vector<Signals>& experiments, Fit& fit) {
  const std::vector<RowMatrix> y = shooting.predict_segments();
  const auto& outputs = shooting.model().system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    double squares = 0.0, count = 0.0;
    for (std::size_t e = 0; e < y.size(); ++e) {
      ChannelPrediction p{
          experiments[e].name, outputs[o].name, outputs[o].unit, experiments[e].t, experiments[e].measured[o].values, {}, {}, {}};
      for (std::size_t i = 0; i < p.t.size(); ++i) {
        p.predicted.push_back(y[e](i, o));
        p.held_out.push_back(experiments[e].held_out(i));
        if (!shooting.counts(e, i, o)) continue;
        squares += std::pow(p.measured[i] - p.predicted[i], 2);
        count += 1.0;
      }
      fit.predictions.push_back(std::move(p));
    }
    const double rms = std::sqrt(squares / std::max(count, 1.0));
    fit.rms[outputs[o].name] = {rms, 0.0, outputs[o].unit};
    for (auto& p : fit.predictions) {
      if (p.channel == outputs[o].name) p.sigma.assign(p.t.size(), rms);
    }
  }
}

void errors_of(const std::vector<Signals>& experiments, Fit& fit) {
  double loglik = 0.0, held_out_loglik = 0.0;
  std::map<std::string, std::array<double, 4>> sums;  // squares, count, held-out squares, held-out count
  bool any_held_out = false;
  for (ChannelPrediction& p : fit.predictions) {
    const auto experiment = std::find_if(experiments.begin(), experiments.end(), [&](const Signals& s) { return s.name == p.experiment; });
    auto& s = sums[p.channel];
    const double sigma = fit.noise.at(p.channel).value;
    RecordResiduals record;
    for (std::size_t i = experiment->exclude; i < p.t.size(); ++i) {
      const double r = p.measured[i] - p.predicted[i];
      if (!std::isfinite(r)) continue;
      record.add(p.measured[i], p.predicted[i], p.held_out[i]);
      const double term = -0.5 * r * r / (sigma * sigma) - std::log(sigma) - 0.5 * std::log(2.0 * pi);
      const bool held_out = p.held_out[i];
      any_held_out = any_held_out || held_out;
      (held_out ? held_out_loglik : loglik) += term;
      s[held_out ? 2 : 0] += r * r;
      s[held_out ? 3 : 1] += 1.0;
    }
    record.describe(p, fit);
  }
  fit.loglik = loglik;
  if (any_held_out) fit.validation_loglik = held_out_loglik;
  for (const auto& p : fit.predictions) {
    const auto& s = sums[p.channel];
    if (s[1] > 0.0) fit.rms[p.channel] = {std::sqrt(s[0] / s[1]), 0.0, p.unit};
    if (s[3] > 0.0) fit.validation_rms[p.channel] = {std::sqrt(s[2] / s[3]), 0.0, p.unit};
  }
}

bool segments_follow(Shooting& shooting, const std::vector<Signals>& experiments) {
  constexpr double of_noise = 3.0;  // sigma: what is no larger says nothing against the model, however little an output shows
  const std::vector<RowMatrix> y = shooting.predict_segments();
  for (std::size_t o = 0; o < shooting.sigma().size(); ++o) {
    Squares residuals;
    for (std::size_t e = 0; e < y.size(); ++e) {
      for (std::size_t i = 0; i < experiments[e].samples(); ++i) {
        if (!shooting.counts(e, i, o)) continue;
        residuals.sum += std::pow(y[e](i, o) - experiments[e].measured[o].values[i], 2);
        residuals.count += 1.0;
      }
    }
    const double most = std::max(motion_of(experiments, o).rms(), of_noise * shooting.sigma()[o]);
    if (!(residuals.rms() <= most)) return false;
  }
  return true;
}

double misfit_of(const SimulatedRuns& end) {
  double sum = 0.0;
  for (std::size_t o = 0; o < end.shooting.sigma().size(); ++o) {
    const auto [squares, count] = squares_of(channel_residuals(end, o));
    sum += 0.5 * count * std::log(std::max(squares, 1e-300) / std::max(count, 1.0));
  }
  return sum;
}

std::string why_undetermined(const std::string& which, std::string unsettled, const SimulatedRuns& end) {
  const auto& outputs = end.shooting.model().system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const Squares residuals = squares_of(channel_residuals(end, o));
    const double rms = residuals.rms(), size = motion_of(end.experiments, o).rms();
    if (residuals.count == 0.0 || rms < follows * size) continue;
    unsettled = "the search ended at no fit of " + outputs[o].name + " (residual RMS " + in_display_unit(rms, outputs[o].unit) +
                ", motion RMS " + in_display_unit(size, outputs[o].unit) + ")";
    break;
  }
  if (unsettled.empty()) return which;
  return unsettled + ": there " + which.substr(0, which.find_first_of(":;")) +
         ", which need not be so elsewhere. Begin with other values, or give bounds";
}

namespace {

/// Of a channel's measurements that count in all experiments, on an even grid.
std::vector<double> residuals_of(const std::string& channel, const std::vector<Signals>& experiments, const Fit& fit) {
  std::vector<std::vector<double>> all;
  for (const auto& p : fit.predictions) {
    if (p.channel != channel) continue;
    const std::size_t exclude = experiments[all.size()].exclude;
    std::vector<double> residuals;
    for (std::size_t i = 0; i < p.t.size(); ++i)
      residuals.push_back(i < exclude || p.held_out[i] ? std::nan("") : p.measured[i] - p.predicted[i]);
    all.push_back(on_even_grid(p.t, residuals));
  }
  return joined_series(all);
}

}  // namespace

void warn_of_other_noise(const Model& model, Fit& fit) {
  constexpr double most = 1.5;
  const auto& outputs = model.system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const auto rms = fit.rms.find(outputs[o].name);
    if (!model.known_noise[o].fixed || rms == fit.rms.end()) continue;
    const double ratio = rms->second.value / model.known_noise[o].sigma;
    if (ratio > 1.0 / most && ratio < most) continue;
    fit.warnings.push_back("residuals of " + outputs[o].name + " are " + format_value(ratio) +
                           " times as large as the measurement noise that the study fixes, on which the standard errors rest");
  }
}

void classify_motion(const Model& model, const MotionFacts& motion, Fit& fit) {
  const auto& [setting, experiments, unknowns, driven] = motion;
  const auto& outputs = model.system->spec().outputs;
  const auto shown = std::find_if(outputs.begin(), outputs.end(), [&](const OutputSpec& o) { return fit.rms.contains(o.name); });
  if (shown == outputs.end()) return;
  const std::size_t o = shown - outputs.begin();
  const auto half_period = static_cast<int>(std::min(pi / setting.frequency / setting.step, static_cast<double>(setting.samples)));
  const WhitenessTest test = whiteness(residuals_of(shown->name, experiments, fit), 1, std::max(6, half_period), unknowns);
  const double noise = noise_of(experiments, o), rms = fit.rms.at(shown->name).value, size = motion_of(experiments, o).rms();
  fit.facts["whiteness"] = "residuals of " + shown->name + " at " + in_words(test);
  fit.facts["explained"] = "residual RMS " + in_display_unit(rms, shown->unit) + ", motion RMS " + in_display_unit(size, shown->unit) +
                           ", measurement noise about " + in_display_unit(noise, shown->unit);
  constexpr double clearly_above_noise = 2.0;
  const bool above_noise = rms > clearly_above_noise * noise, coloured = looks_driven(test) && above_noise;
  fit.driven = above_noise && driven.value_or(coloured);
  if (!coloured || rms < follows * size) {
    fit.coloured = clearly_coloured(test);
    if (fit.coloured) {
      fit.warnings.push_back(
          "residuals are not white (" + fit.facts["whiteness"] + "; " + fit.facts["explained"] +
          "): something is missing from the model, or the measurement noise is autocorrelated. Sigmas allow for autocorrelated noise (" +
          "plain_sigma: without it), not for a force that the model lacks");
    }
    return;
  }
  fit.status = FitStatus::declined;
  const std::string why = fit.driven ? "the motion is driven by something this deterministic model does not have: it" : "the model";
  const std::string what_now = fit.driven ? std::string("The method that can estimate such motion is ") + random_force_estimator().name
                                          : "Begin with other values, or add what the model lacks";
  fit.message = why + " cannot follow the measured motion (" + fit.facts["explained"] + "; " + fit.facts["whiteness"] + "). " + what_now +
                ". The search ended: " + fit.message;
  for (const auto& curve : model.curves)
    mark_not_informative(model, curve.name, "the simulated trajectory does not follow the measured motion", fit);
  fit.trim.reset();
}

}  // namespace misfit::output_error_parts
