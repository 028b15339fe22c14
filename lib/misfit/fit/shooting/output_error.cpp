#include "misfit/fit/shooting/output_error.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/fit/shooting/output_error_result.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/short_record.h"

namespace misfit {
namespace {

using namespace output_error_parts;

PenalisedFit smooth_present(Shooting& shooting, std::vector<Penalty>& penalties, NormalEquations& linearised) {
  if (!shooting.linearise(linearised)) return {};
  return estimate_smoothing(linearised, penalties);
}

bool any_chosen(const std::vector<Penalty>& penalties) {
  return std::any_of(penalties.begin(), penalties.end(), [](const Penalty& p) { return p.chosen; });
}

std::vector<Penalty> kept(std::vector<Penalty> penalties) {
  for (auto& p : penalties) p.chosen = false;
  return penalties;
}

/// The noise of an earlier fit instead of a first guess.
Setting with_noise(const FittedModel& start, Setting setting) {
  const auto& outputs = start.model.system->spec().outputs;
  for (std::size_t o = 0; o < setting.sigma.size(); ++o) {
    const auto known = start.fit.noise.find(outputs[o].name);
    if (known != start.fit.noise.end() && known->second.value > 0.0) setting.sigma[o] = known->second.value;
  }
  return setting;
}

class Estimator {
 public:
  Estimator(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options)
      : experiments_(experiments),
        options_(options),
        start_driven_(start.fit.driven),
        setting_(options.keep_roughness ? with_noise(start, look_at(start.model, experiments, options))
                                        : look_at(start.model, experiments, options)),
        penalties_(options.keep_roughness ? kept(start.penalties)
                                          : curve_penalties(start.model)),  // not those of a regression, whose noise is another one
        shooting_(start.model, experiments, setting_.sigma, setting_.state_scale, start_states(setting_)),
        initial_states_(start.initial_states),
        tolerance_(start.integration > 0.0 ? start.integration : kSearchTolerance) {}

  FittedModel run() {
    shooting_.plan(tolerance_);
    if (initial_states_.size() == experiments_.size()) {
      const Shooting::State before = shooting_.state();
      const std::vector<Penalty> penalties = penalties_;
      shooting_.begin_at(initial_states_);
      FittedModel out = whole_trajectory({});
      if (out.fit.status == FitStatus::converged) return out;
      shooting_.restore(before);
      penalties_ = penalties;
      shooting_.set_sigma(setting_.sigma);
      shooting_.forget_failure();
    }
    ShootingPass pass;
    for (const auto& next : short_passes(setting_, options_.from_regression)) {
      pass = next;
      if (!solve(pass)) return failed(segments_of(pass) + last_.message);
    }
    pass.tolerance = 1e-6;
    constexpr int most_lengthenings = 12;
    for (int k = 0; k < most_lengthenings && 6 * pass.length < setting_.samples / 2; ++k) {
      if (!lengthen(pass)) return lost(pass);
      NormalEquations pieces;
      if (any_chosen(penalties_) && shooting_.linearise_segments(pass.length, pieces))
        static_cast<void>(estimate_smoothing(pieces, penalties_));
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
    NormalEquations linearised;
    constexpr int most_rounds = 8, most_iterations = 200;
    double before = 0.0;
    settled_ = false;
    shooting_.plan(tolerance_);
    for (int round = 0; round < most_rounds; ++round) {
      if (round > 0 && any_chosen(penalties_) && lengthened.length > 0 && !solve(lengthened)) return failed(last_.message);
      const ShootingPass whole{0, 10.0, 1e8, most_iterations, 1e-7};
      if (!solve(whole) && !(plan_finely() && solve(whole))) return failed(last_.message);
      const PenalisedFit smoothed = smooth_present(shooting_, penalties_, linearised);
      if (!smoothed.ok) return failed(shooting_.failure().empty() ? singular_message(linearised) : "");
      const std::vector<double> sigma = channel_sigmas(shooting_, shooting_.run(false), experiments_, smoothed.edf);
      const bool same_roughness = !any_chosen(penalties_) || std::abs(smoothed.edf - before) < 0.1;
      settled_ = same_roughness && std::equal(sigma.begin(), sigma.end(), shooting_.sigma().begin(),
                                              [](double now, double then) { return std::abs(now / then - 1.0) < 0.01; });
      before = smoothed.edf;
      shooting_.set_sigma(sigma);
      if (!settled_) continue;
      add_digits(linearised, smoothed);
      break;
    }
    return finish(last_);
  }

  /// A search in a long valley ends by its tolerance some way before the minimum: on to it, if a step of more than 1e-6 sigma is left. Not
  /// for fits by the thousand.
  void add_digits(const NormalEquations& linearised, const PenalisedFit& smoothed) {
    constexpr double enough = 1e-6;
    const Eigen::VectorXd sigma = smoothed.covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
    if ((smoothed.theta - linearised.theta).cwiseQuotient(sigma).cwiseAbs().maxCoeff() < enough || !options_.coloured) return;
    const Shooting::State before = shooting_.state();
    const LeastSquares::Summary then = last_;
    if (solve({0, 10.0, 1e8, 100, 1e-13})) {
      last_ = then;
      return;
    }
    shooting_.restore(before);
    shooting_.forget_failure();
    last_ = then;
  }

  std::string singular_message(const NormalEquations& linearised) {
    const std::string which = linearised.N.size() > 0 ? undetermined(shooting_.model(), linearised) : "";
    return at_the_end(which.empty() ? "the information matrix is singular: some parameters are not determined by these data" : which);
  }

  std::string at_the_end(const std::string& which) {
    return said_of_the_end(which, last_.converged, shooting_, shooting_.run(false), experiments_);
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
    fit.status = summary.converged && settled_ ? FitStatus::converged : FitStatus::not_converged;
    fit.message = summary.converged && !settled_ ? "noise variances and smoothing parameters have not converged" : summary.message;
    NormalEquations linearised;
    if (!shooting_.linearise(linearised)) return failed("");
    std::vector<Penalty> penalties = kept(penalties_);
    const PenalisedFit smoothed = estimate_smoothing(linearised, penalties, 1.0);
    if (!smoothed.ok) return failed(singular_message(linearised));
    if (const std::string which = undetermined(out.model, linearised); !which.empty()) return failed(at_the_end(which));
    const auto columns = static_cast<Eigen::Index>(out.model.free_parameters().size());
    const double degrees = linearised.count - smoothed.edf;
    const std::vector<Segment> runs = shooting_.run(true);
    if (!integrated_well(runs, smoothed.covariance)) return nearly_there_ && polish() ? finish(summary) : whole_trajectory({});
    tell_integration(out);
    const auto& outputs = out.model.system->spec().outputs;
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      const double sigma = shooting_.sigma()[o];
      fit.noise[outputs[o].name] = {sigma, sigma / std::sqrt(2.0 * std::max(degrees / static_cast<double>(outputs.size()), 1.0)),
                                    outputs[o].unit};
    }
    RowMatrix visited = visited_quantities(out.model, experiments_.front(), setting_.states.front());
    for (std::size_t e = 1; e < experiments_.size(); ++e) {
      const RowMatrix more = visited_quantities(out.model, experiments_[e], setting_.states[e]);
      const Eigen::Index old = visited.rows();
      visited.conservativeResize(old + more.rows(), visited.cols());
      visited.bottomRows(more.rows()) = more;
    }
    const Eigen::MatrixXd covariance = allowing_for_memory(linearised, smoothed.covariance, runs, visited, degrees, out);
    predictions_of(shooting_, runs, experiments_, covariance, fit);
    errors_of(experiments_, fit);
    for (std::size_t e = 0; e < experiments_.size(); ++e) out.initial_states.push_back(shooting_.initial_state(e));
    fit.facts["effective_parameters"] = format_value(smoothed.edf);
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      if (shooting_.held_out(e))
        fit.facts["held out: " + experiments_[e].name] = "all its samples are held out: its initial state is taken from its first samples";
    }
    const InputTable inputs = input_table(experiments_.front(), out.model.inputs());
    const std::vector<std::string> scales =
        scale_uncertainties(out.model, out.initial_states.front().data(), inputs.at(0), experiments_.front().t.front());
    fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
    tell_weak_directions(out.model, covariance.topLeftCorner(columns, columns), fit);
    tell_other_trims(fit);
    judge(out.model, setting_, smoothed.edf / static_cast<double>(outputs.size()), fit);
    refuse_runaways(out.model, covariance.topLeftCorner(columns, columns), fit);
    if (degrees < kFewestDegrees) withhold_sigmas(too_few(linearised.count, smoothed.edf), fit);
    fit.linearisations = shooting_.linearisations();
    return out;
  }

  /// Does the integration's error move no estimate by more than a tenth of its sigma? If not, the integration is planned anew so that it
  /// will; where the estimates move by a few sigmas at most, they are moved there. Not for fits by the thousand, which go on with the plan
  /// of the one they are made about.
  bool integrated_well(const std::vector<Segment>& runs, const Eigen::MatrixXd& covariance) {
    constexpr double enough = 0.1, aim = 0.02, few = 3.0;
    constexpr int most_plans = 4;
    if (!options_.coloured) return true;
    const std::optional<Eigen::VectorXd> shift = shooting_.integration_shift(runs, covariance);
    if (!shift) return true;
    shift_ = largest(*shift, covariance);
    double worst = 0.0;
    for (std::size_t e = 0; e < experiments_.size(); ++e) worst = std::max(worst, shooting_.plan_of(e).error);
    const double next = std::max(std::min(tolerance_, worst) * aim / shift_, kFinestTolerance);
    if (!(shift_ > enough) || plans_ == most_plans || next >= tolerance_) return true;
    ++plans_;
    tolerance_ = next;
    nearly_there_ = shift_ < few;
    if (!nearly_there_) return false;
    shooting_.plan(tolerance_);
    shooting_.move_by(*shift);
    return false;
  }

  /// Newton's steps with noise and roughness as they are, for estimates that are all but right. False if they do not end.
  bool polish() {
    constexpr double enough = 1e-3;
    constexpr int most_steps = 5;
    const Shooting::State before = shooting_.state();
    for (int k = 0; k < most_steps; ++k) {
      NormalEquations here;
      std::vector<Penalty> penalties = kept(penalties_);
      if (!shooting_.linearise(here)) break;
      const PenalisedFit there = estimate_smoothing(here, penalties, 1.0);
      if (!there.ok) break;
      if (largest(shooting_.move_by(there.theta - here.theta), there.covariance) < enough) return true;
    }
    shooting_.restore(before);
    shooting_.forget_failure();
    return false;
  }

  /// Of a step of all unknowns [sigma].
  static double largest(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance) {
    constexpr double least = 1e-300;
    return step.cwiseQuotient(covariance.diagonal().cwiseMax(least).cwiseSqrt()).cwiseAbs().maxCoeff();
  }

  /// A motion that the plan of a search cannot follow to the end may be followed by a finer one.
  bool plan_finely() {
    constexpr double fine = 1e-7;
    if (tolerance_ <= fine) return false;
    tolerance_ = fine;
    shooting_.plan(tolerance_);
    return true;
  }

  void tell_integration(FittedModel& out) const {
    out.integration = tolerance_;
    std::vector<IntegrationPlan> used;
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      used.push_back(shooting_.plan_of(e));
      if (!used.back().lack.empty()) out.fit.warnings.push_back(experiments_[e].name + ": " + used.back().lack);
    }
    std::string& fact = out.fit.facts["integration"];
    fact = in_words(used, plans_);
    if (options_.coloured) fact += in_words_of(shift_, tolerance_);
  }

  static std::string too_few(double count, double unknowns) {
    return format_value(count) + " measurements for " + format_value(std::round(10.0 * unknowns) / 10.0) +
           " unknowns (free parameters and initial states) are too few to tell how far off the values are: no sigma is given";
  }

  /// Of all unknowns; tells parameters, curves and trim with it, and what the plain one would give.
  Eigen::MatrixXd allowing_for_memory(const NormalEquations& linearised, const Eigen::MatrixXd& plain, const std::vector<Segment>& runs,
                                      const RowMatrix& visited, double degrees, FittedModel& out) const {
    const auto columns = static_cast<Eigen::Index>(out.model.free_parameters().size());
    if (!options_.coloured) {
      describe(out.model, plain.topLeftCorner(columns, columns), visited, out.fit);
      return plain;
    }
    const std::vector<ResidualRows> rows = residual_rows(shooting_, runs, experiments_);
    const ColouredCovariance coloured =
        memory_of_residuals(residual_rows(shooting_, runs, experiments_), plain, out.model.outputs(), degrees);
    Eigen::MatrixXd covariance = with_uncertain_roughness(linearised, penalties_, 1.0, coloured.excess);
    out.plain_covariance = with_uncertain_roughness(linearised, penalties_, 1.0).topLeftCorner(columns, columns);
    describe_both(out.model, out.plain_covariance, covariance.topLeftCorner(columns, columns), visited, out.fit);
    if (degrees < kShortRecord) add_student_intervals(std::min(degrees, coloured.degrees), out.fit);
    out.fit.facts["covariance"] = in_words(coloured);
    const auto& outputs = out.model.system->spec().outputs;
    for (std::size_t o = 0; o < outputs.size(); ++o)
      out.fit.noise.at(outputs[o].name).sigma *= std::sqrt(coloured.squared_correlations[static_cast<Eigen::Index>(o)]);
    return covariance;
  }

  const std::vector<Signals>& experiments_;
  OutputErrorStart options_;
  bool start_driven_;
  Setting setting_;
  std::vector<Penalty> penalties_;
  Shooting shooting_;
  std::vector<Eigen::VectorXd> initial_states_;  ///< where the start is a fit
  double tolerance_;                             ///< of the integration
  double shift_ = 0.0;                           ///< of an estimate by its error [sigma], the largest
  int plans_ = 0;                                ///< made at estimates
  bool nearly_there_ = false;
  LeastSquares::Summary last_;
  bool settled_ = false;  ///< noise and roughness agree with the residuals they leave
};

}  // namespace

FittedModel output_error(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
  const auto begin = std::chrono::steady_clock::now();
  FittedModel out = Estimator(start, experiments, options).run();
  out.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace misfit
