#include "misfit/fit/output_error.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/fit/curves.h"
#include "misfit/fit/shooting.h"
#include "misfit/fit/whiteness.h"

namespace misfit {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Everything a fit needs that does not change while it runs.
struct Setting {
  double step = 0.0;        ///< usual sample interval [s]
  double frequency = 0.0;   ///< [rad/s]
  std::size_t samples = 0;  ///< of the longest experiment
  std::vector<double> sigma, state_scale;
  std::vector<ReconstructedStates> states;
};

Setting look_at(const Model& model, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
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
    double sigma = experiments.front().measured[o].sigma;
    if (!(sigma > 0.0)) sigma = reading_noise(experiments.front().measured[o].values);
    if (!(sigma > 0.0)) sigma = spec.outputs[o].noise > 0.0 ? spec.outputs[o].noise : 1.0;
    s.sigma.push_back(sigma);
  }
  s.state_scale.assign(static_cast<std::size_t>(model.states()), 1.0);
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    if (spec.outputs[o].observes >= 0) s.state_scale[static_cast<std::size_t>(spec.outputs[o].observes)] = s.sigma[o];
  }
  for (std::size_t j = 0; j < spec.states.size(); ++j) {
    if (spec.states[j].rate_of >= 0) s.state_scale[j] = s.state_scale[static_cast<std::size_t>(spec.states[j].rate_of)] * s.frequency;
  }
  return s;
}

/// States at every sample to begin with: read from the measurement, gaps bridged linearly between the known neighbours.
std::vector<RowMatrix> start_states(const Setting& setting) {
  std::vector<RowMatrix> out;
  for (const auto& states : setting.states) {
    RowMatrix x = states.x;
    Eigen::Index known = -1;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (!states.ok[static_cast<std::size_t>(i)]) continue;
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

/// The short segments to begin with; the last is half a period of the motion.
std::vector<ShootingPass> short_passes(const Setting& setting, bool from_regression) {
  constexpr double nearly_gauss_newton =
      1e8;  // with segments this short the problem is nearly linear: a small region only slows it (DESIGN 5)
  const auto half_period = static_cast<std::size_t>(std::clamp(pi / setting.frequency / setting.step, 5.0, 1000.0));
  std::vector<ShootingPass> list;
  if (!from_regression) {
    list.push_back({5, 1.0, 1e4, 40, 1e-4});
    list.push_back({5, 10.0, 1e6, 40, 1e-4});
  }
  list.push_back({half_period, 10.0, nearly_gauss_newton, 30, 1e-4});
  return list;
}

Smoothed smooth_present(Shooting& shooting, std::vector<Penalty>& penalties, Linearised& linearised) {
  if (!shooting.linearise(linearised)) return {};
  return smooth(linearised, penalties);
}

bool any_chosen(const std::vector<Penalty>& penalties) {
  return std::any_of(penalties.begin(), penalties.end(), [](const Penalty& p) { return p.chosen; });
}

/// Per-channel residuals of the estimation part → standard deviations with the effective number of parameters taken off.
std::vector<double> channel_sigmas(const Shooting& shooting, const std::vector<Segment>& runs, const std::vector<Signals>& experiments,
                                   double edf) {
  std::vector<double> sigma = shooting.sigma();
  const double share = edf / static_cast<double>(sigma.size());
  for (std::size_t o = 0; o < sigma.size(); ++o) {
    double squares = 0.0, count = 0.0;
    for (std::size_t e = 0; e < runs.size(); ++e) {
      for (std::size_t i = 0; i < experiments[e].samples(); ++i) {
        if (!shooting.counts(e, i, o)) continue;
        const double r = runs[e].y(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(o)) - experiments[e].measured[o].values[i];
        squares += r * r;
        count += 1.0;
      }
    }
    if (count > share + 1.0 && squares > 0.0) sigma[o] = std::sqrt(squares / (count - share));
  }
  return sigma;
}

void predictions_of(const Shooting& shooting, const std::vector<Segment>& runs, const std::vector<Signals>& experiments,
                    const Eigen::MatrixXd& covariance, Fit& fit) {
  const auto& outputs = shooting.model().system->spec().outputs;
  const auto ny = static_cast<Eigen::Index>(outputs.size());
  const Eigen::Index n = shooting.model().states();
  for (std::size_t e = 0; e < runs.size(); ++e) {
    const Segment& run = runs[e];
    const Eigen::Index columns = run.y_rows.cols() - n;
    const RowMatrix& rows = run.y_rows;
    Eigen::MatrixXd joint(columns + n, columns + n);
    const Eigen::Index at = columns + n * static_cast<Eigen::Index>(e);
    joint << covariance.topLeftCorner(columns, columns), covariance.block(0, at, columns, n), covariance.block(at, 0, n, columns),
        covariance.block(at, at, n, n);
    const Eigen::VectorXd spread = (rows * joint).cwiseProduct(rows).rowwise().sum();
    for (Eigen::Index o = 0; o < ny; ++o) {
      ChannelPrediction p;
      p.experiment = experiments[e].name;
      p.channel = outputs[static_cast<std::size_t>(o)].name;
      p.unit = outputs[static_cast<std::size_t>(o)].unit;
      p.t = experiments[e].t;
      p.measured = experiments[e].measured[static_cast<std::size_t>(o)].values;
      const double sigma = shooting.sigma()[static_cast<std::size_t>(o)];
      for (std::size_t i = 0; i < p.t.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        p.predicted.push_back(run.y(row, o));
        p.sigma.push_back(std::sqrt(sigma * sigma + std::max(spread[row * ny + o], 0.0)));
        p.held_out.push_back(experiments[e].held_out(i));
      }
      fit.predictions.push_back(std::move(p));
    }
  }
}

void errors_of(const std::vector<Signals>& experiments, Fit& fit) {
  double loglik = 0.0, held_loglik = 0.0;
  std::map<std::string, std::array<double, 4>> sums;  // squares, count, held-out squares, held-out count
  bool any_held = false;
  for (const auto& p : fit.predictions) {
    const auto experiment = std::find_if(experiments.begin(), experiments.end(), [&](const Signals& s) { return s.name == p.experiment; });
    auto& s = sums[p.channel];
    const double sigma = fit.noise.at(p.channel).value;
    for (std::size_t i = experiment->exclude; i < p.t.size(); ++i) {
      const double r = p.measured[i] - p.predicted[i];
      if (!std::isfinite(r)) continue;
      const double term = -0.5 * r * r / (sigma * sigma) - std::log(sigma) - 0.5 * std::log(2.0 * pi);
      const bool held = p.held_out[i];
      any_held = any_held || held;
      (held ? held_loglik : loglik) += term;
      s[held ? 2 : 0] += r * r;
      s[held ? 3 : 1] += 1.0;
    }
  }
  fit.loglik = loglik;
  if (any_held) fit.validation_loglik = held_loglik;
  for (const auto& p : fit.predictions) {
    const auto& s = sums[p.channel];
    if (s[1] > 0.0) fit.rms[p.channel] = {std::sqrt(s[0] / s[1]), 0.0, p.unit};
    if (s[3] > 0.0) fit.validation_rms[p.channel] = {std::sqrt(s[2] / s[3]), 0.0, p.unit};
  }
}

double motion_size(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (double v : values) {
    if (std::isfinite(v)) sum += v, squares += v * v, n += 1.0;
  }
  return n > 1.0 ? std::sqrt(std::max(squares / n - sum * sum / (n * n), 0.0)) : 0.0;
}

std::string in_display_unit(double value, const std::string& unit) {
  return unit == "rad" ? format_value(value * 180.0 / pi) + " deg" : format_value(value) + " " + unit;
}

/// Says whether a deterministic model followed the motion, and marks the fit where it did not.
void judge(const Model& model, const Setting& setting, Fit& fit) {
  const ChannelPrediction& p = fit.predictions.front();
  std::vector<double> residuals;
  for (std::size_t i = 0; i < p.t.size(); ++i) residuals.push_back(p.held_out[i] ? std::nan("") : p.measured[i] - p.predicted[i]);
  const int last = std::max(6, static_cast<int>(pi / setting.frequency / setting.step));
  const WhitenessTest test = whiteness(residuals, 1, last);
  const double noise = reading_noise(p.measured), rms = fit.rms.at(p.channel).value, size = motion_size(p.measured);
  fit.facts["whiteness"] = "residuals of " + p.channel + " at lags 1 to " + std::to_string(test.last_lag) +
                           " samples (half a period): largest autocorrelation " + format_value(test.largest) + " at lag " +
                           std::to_string(test.largest_lag) + ", Ljung-Box p = " + format_probability(test.p_value);
  fit.facts["explained"] = "residual RMS " + in_display_unit(rms, p.unit) + ", motion RMS " + in_display_unit(size, p.unit) +
                           ", reading noise about " + in_display_unit(noise, p.unit);
  constexpr double clearly_above_noise = 2.0;
  fit.driven = looks_driven(test) && rms > clearly_above_noise * noise;
  if (!fit.driven) {
    if (test.p_value < 1e-3)
      fit.warnings.push_back("residuals are not white (" + fit.facts["whiteness"] +
                             "): intervals are too narrow and something small is missing");
    return;
  }
  fit.status = FitStatus::declined;
  fit.message = "the motion is driven by something this deterministic model does not have: it cannot follow the measured motion (" +
                fit.facts["explained"] + "; " + fit.facts["whiteness"] +
                "). The method that can estimate such motion is filter_error. Solver: " + fit.message;
  for (const auto& curve : model.curves)
    mark_not_informative(model, curve.name, "driven motion: a deterministic trajectory cannot follow it", fit);
  fit.trim.reset();
}

class Estimator {
 public:
  Estimator(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options)
      : experiments_(experiments),
        options_(options),
        start_driven_(start.fit.driven),
        setting_(look_at(start.model, experiments, options)),
        penalties_(curve_penalties(start.model)),  // not those of a regression, whose noise is another one
        shooting_(start.model, experiments, setting_.sigma, setting_.state_scale, start_states(setting_)) {}

  FittedModel run() {
    ShootingPass pass;
    for (const auto& next : short_passes(setting_, options_.from_regression)) {
      pass = next;
      if (!solve(pass)) return failed(segments_of(pass) + last_.message);
    }
    pass.tolerance = 1e-6;
    constexpr int most_lengthenings = 12;
    for (int k = 0; k < most_lengthenings && 6 * pass.length < setting_.samples / 2; ++k) {
      if (!lengthen(pass)) return lost(pass);
      Linearised pieces;
      if (any_chosen(penalties_) && shooting_.linearise_segments(pass.length, pieces)) static_cast<void>(smooth(pieces, penalties_));
    }
    return whole_trajectory(pass);
  }

 private:
  bool solve(const ShootingPass& pass) {
    last_ = shooting_.solve(pass, penalties_);
    return last_.usable;
  }

  /// Do the segments predict better than a constant would? If not, what the solver reached is no start for longer ones.
  bool follows() {
    const std::vector<RowMatrix> y = shooting_.predict_segments();
    for (std::size_t e = 0; e < y.size(); ++e) {
      for (std::size_t o = 0; o < setting_.sigma.size(); ++o) {
        double squares = 0.0, count = 0.0;
        for (std::size_t i = 0; i < experiments_[e].samples(); ++i) {
          if (!shooting_.counts(e, i, o)) continue;
          squares += std::pow(y[e](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(o)) - experiments_[e].measured[o].values[i], 2);
          count += 1.0;
        }
        if (!(std::sqrt(squares / std::max(count, 1.0)) <= motion_size(experiments_[e].measured[o].values))) return false;
      }
    }
    return true;
  }

  /// Six times as long; less where the states handed over do not carry that far.
  bool lengthen(ShootingPass& pass) {
    for (const double factor : {6.0, 3.0, 2.0, 1.5, 1.25}) {
      const Shooting::State before = shooting_.state();
      ShootingPass next = pass;
      next.length = static_cast<std::size_t>(factor * static_cast<double>(pass.length));
      if (solve(next) && follows()) {
        pass = next;
        return true;
      }
      shooting_.restore(before);
    }
    return false;
  }

  static std::string segments_of(const ShootingPass& pass) { return "segments of " + std::to_string(pass.length) + " samples: "; }

  /// The model follows the motion over short segments only.
  FittedModel lost(const ShootingPass& pass) {
    const std::string span = format_value(std::round(100.0 * static_cast<double>(pass.length) * setting_.step) / 100.0);
    const std::string stop = "longer segments diverge or predict worse than a constant would";
    shooting_.forget_failure();
    const std::string what =
        "the model follows the measured motion over segments of " + span + " s only: run on, the simulated motion leaves it (" + stop + ")";
    FittedModel out = failed(what);
    out.fit.facts["prediction"] = "restarted every " + span + " s from a fitted state: no single trajectory exists";
    if (out.fit.predictions.empty()) show_segments(out.fit);
    return out;
  }

  /// Predictions of the segments, so that a figure can show where they fail; sigma is the residuals' own.
  void show_segments(Fit& fit) {
    const std::vector<RowMatrix> y = shooting_.predict_segments();
    const auto& outputs = shooting_.model().system->spec().outputs;
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      double squares = 0.0, count = 0.0;
      for (std::size_t e = 0; e < y.size(); ++e) {
        ChannelPrediction p{
            experiments_[e].name, outputs[o].name, outputs[o].unit, experiments_[e].t, experiments_[e].measured[o].values, {}, {}, {}};
        for (std::size_t i = 0; i < p.t.size(); ++i) {
          p.predicted.push_back(y[e](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(o)));
          p.held_out.push_back(experiments_[e].held_out(i));
          if (!shooting_.counts(e, i, o)) continue;
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

  /// One trajectory. Whenever the roughness is chosen anew, the last lengthening comes first again: a single trajectory alone would creep
  /// along the curved valley of equal phase.
  FittedModel whole_trajectory(const ShootingPass& lengthened) {
    Linearised linearised;
    constexpr int most_rounds = 8;
    double before = 0.0;
    for (int round = 0; round < most_rounds; ++round) {
      if (round > 0 && lengthened.length > 0 && !solve(lengthened)) return failed(last_.message);
      if (!solve({0, 10.0, 1e8, 60, 1e-7})) return failed(last_.message);
      const Smoothed smoothed = smooth_present(shooting_, penalties_, linearised);
      if (!smoothed.ok)
        return failed(shooting_.failure().empty() ? "the information matrix is singular: some parameters are not determined by these data"
                                                  : "");
      const std::vector<double> sigma = channel_sigmas(shooting_, shooting_.run(false), experiments_, smoothed.edf);
      const bool same_roughness = !any_chosen(penalties_) || std::abs(smoothed.edf - before) < 0.1;
      const bool settled = same_roughness && std::abs(sigma.front() / shooting_.sigma().front() - 1.0) < 0.01;
      before = smoothed.edf;
      shooting_.set_sigma(sigma);
      if (settled) break;
    }
    return finish(last_);
  }

  /// On motion that is driven a failure to simulate is what had to be expected: then the method declines, in words.
  FittedModel failed(const std::string& why) {
    FittedModel out{{}, shooting_.model(), penalties_, {}};
    out.fit.method = "output_error";
    out.fit.status = start_driven_ ? FitStatus::declined : FitStatus::failed;
    out.fit.driven = start_driven_;
    out.fit.message = shooting_.failure().empty() ? why : shooting_.failure() + (why.empty() ? "" : " (" + why + ")");
    if (start_driven_) {
      out.fit.message =
          "the motion is driven by something this deterministic model does not have, and it cannot follow it: " + out.fit.message +
          ". The method that can estimate such motion is filter_error";
      show_segments(out.fit);
    }
    out.fit.linearisations = shooting_.linearisations();
    return out;
  }

  FittedModel finish(const LeastSquares::Summary& summary) {
    FittedModel out{{}, shooting_.model(), penalties_, {}};
    Fit& fit = out.fit;
    fit.method = "output_error";
    fit.status = summary.converged ? FitStatus::converged : FitStatus::not_converged;
    fit.message = summary.message;
    Linearised linearised;
    if (!shooting_.linearise(linearised)) return failed("");
    std::vector<Penalty> kept = penalties_;
    for (auto& p : kept) p.chosen = false;
    const Smoothed smoothed = smooth(linearised, kept, 1.0);
    if (!smoothed.ok) return failed("the information matrix is singular: some parameters are not determined by these data");
    const auto columns = static_cast<Eigen::Index>(out.model.free_parameters().size());
    const std::vector<Segment> runs = shooting_.run(true);
    const auto& outputs = out.model.system->spec().outputs;
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      const double sigma = shooting_.sigma()[o];
      fit.noise[outputs[o].name] = {sigma, sigma / std::sqrt(2.0 * std::max(linearised.count / static_cast<double>(outputs.size()), 1.0)),
                                    outputs[o].unit};
    }
    RowMatrix visited = visited_quantities(out.model, experiments_.front(), setting_.states.front());
    for (std::size_t e = 1; e < experiments_.size(); ++e) {
      const RowMatrix more = visited_quantities(out.model, experiments_[e], setting_.states[e]);
      const Eigen::Index old = visited.rows();
      visited.conservativeResize(old + more.rows(), visited.cols());
      visited.bottomRows(more.rows()) = more;
    }
    describe(out.model, smoothed.covariance.topLeftCorner(columns, columns), visited, fit);
    predictions_of(shooting_, runs, experiments_, smoothed.covariance, fit);
    errors_of(experiments_, fit);
    for (std::size_t e = 0; e < experiments_.size(); ++e) out.initial_states.push_back(shooting_.initial_state(e));
    fit.facts["effective_parameters"] = format_value(smoothed.edf);
    const InputTable inputs = input_table(experiments_.front(), out.model.inputs());
    const std::vector<std::string> scales =
        scale_uncertainties(out.model, out.initial_states.front().data(), inputs.at(0), experiments_.front().t.front());
    fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
    judge(out.model, setting_, fit);
    fit.linearisations = shooting_.linearisations();
    return out;
  }

  const std::vector<Signals>& experiments_;
  OutputErrorStart options_;
  bool start_driven_;
  Setting setting_;
  std::vector<Penalty> penalties_;
  Shooting shooting_;
  LeastSquares::Summary last_;
};

}  // namespace

FittedModel output_error(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
  const auto begin = std::chrono::steady_clock::now();
  FittedModel out = Estimator(start, experiments, options).run();
  out.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace misfit
