#include "misfit/fit/shooting/output_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/data/estimators.h"
#include "misfit/fit/shooting/output_error_estimate.h"
#include "misfit/fit/shooting/output_error_integration.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/output_weights.h"

namespace misfit {
namespace {

using namespace output_error_parts;

class Estimator {
 public:
  Estimator(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options)
      : experiments_(experiments),
        options_(options),
        start_driven_(start.fit.driven),
        regression_says_driven_(options.from_regression && !start.fit.method.empty() ? start.fit.says_driven() : std::nullopt),
        setting_(options.keep_roughness ? with_noise(start, setting_of(start.model, experiments, options))
                                        : setting_of(start.model, experiments, options)),
        penalties_(options.keep_roughness ? with_fixed_weights(start.penalties)
                                          : curve_penalties(start.model)),  // not those of a regression, whose noise is another one
        shooting_(start.model, experiments, {setting_.sigma, setting_.state_scale}, start_states(setting_)),
        integration_(shooting_, experiments, start.integration, options.thorough),
        initial_states_(start.initial_states) {}

  FittedModel run() {
    try {
      return run_to_the_end();
    } catch (const TimeLimitReached& spent) {
      const SuspendedTimeLimit writing_up;
      return cut_off(spent);
    }
  }

 private:
  FittedModel run_to_the_end() {
    if (initial_states_.size() == experiments_.size()) {
      const Shooting::State before = shooting_.state();
      const std::vector<Penalty> penalties = penalties_;
      shooting_.begin_at(initial_states_);
      shooting_.run_histories();
      FittedModel out = whole_trajectory({});
      if (out.fit.status == FitStatus::converged) return out;
      shooting_.restore(before);
      penalties_ = penalties;
      shooting_.set_sigma(setting_.sigma);
      shooting_.forget_failure();
    }
    const Start start{shooting_.state(), penalties_};
    FittedModel out = from_segments();
    return stuck_ && options_.thorough ? again_with_short_steps(start, out) : out;
  }

  struct Start {
    Shooting::State at;
    std::vector<Penalty> penalties;
  };

  FittedModel from_segments() {
    integration_.plan();
    ShootingPass pass;
    for (auto& next : short_passes(setting_, options_.from_regression)) {
      pass = next;
      pass.initial_radius = std::min(pass.initial_radius, largest_radius_);
      if (!solve(pass)) return failed(segments_of(pass) + last_.message);
    }
    pass.tolerance = 1e-6;
    integration_.plan_for_whole_runs();
    constexpr int most_lengthenings = 12;
    for (int k = 0; k < most_lengthenings && 6 * pass.length < setting_.samples / 2; ++k) {
      if (!lengthen(pass)) return lost(pass);
      NormalEquations pieces;
      if (any_chosen(penalties_) && shooting_.linearise_segments(pass.length, pieces))
        static_cast<void>(estimate_smoothing(pieces, penalties_));
    }
    return whole_trajectory(pass);
  }

  /// Long steps leap into valleys where a parameter no longer acts: begun again, with short steps.
  FittedModel again_with_short_steps(const Start& start, const FittedModel& first) {
    constexpr double short_steps = 1.0;
    shooting_.restore(start.at);
    shooting_.set_sigma(setting_.sigma);
    shooting_.forget_failure();
    penalties_ = start.penalties;
    is_linearised_ = false;
    first_misfit_ = std::exchange(stuck_, std::nullopt);
    largest_radius_ = short_steps;
    FittedModel second = from_segments();
    return second.fit.usable() || stuck_ ? second : first;
  }

  /// Where the search was when its time was spent: one trajectory from there, or, where the model cannot be run so, what the segments
  /// followed.
  FittedModel cut_off(const TimeLimitReached& spent) {
    shooting_.forget_failure();
    last_.converged = is_linearised_ = false;
    last_.message = in_words(spent);
    if (!linearise_here() || !estimate_.smoothed.ok) return failed(last_.message);
    last_.message = in_words(spent, "sum of squares", estimate_.linearised.rss);
    FittedModel out = finish();
    if (out.fit.status == FitStatus::declined) {  // that it does not follow the motion yet says nothing
      out.fit.status = FitStatus::not_converged;
      out.fit.message = last_.message;
    } else if (out.fit.status == FitStatus::failed) {
      out.fit.message = last_.message + "; " + out.fit.message;
    }
    return out;
  }

  bool solve(const ShootingPass& pass) {
    last_ = shooting_.solve(pass, penalties_);
    if (last_.out_of_time) throw TimeLimitReached(last_.message);
    return last_.usable;
  }

  /// Segments six times as long; by a smaller factor where the simulation from the present initial states fails, or predicts
  /// worse than a constant would.
  bool lengthen(ShootingPass& pass) {
    for (const double factor : {6.0, 3.0, 2.0, 1.5, 1.25}) {
      const Shooting::State before = shooting_.state();
      ShootingPass next = pass;
      next.length = static_cast<std::size_t>(factor * static_cast<double>(pass.length));
      if (solve(next) && segments_follow(shooting_, experiments_)) {
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
    const double seconds = static_cast<double>(pass.length) * setting_.step, digit = std::pow(10.0, std::floor(std::log10(seconds)) - 2.0);
    const std::string span = format_value(std::round(seconds / digit) * digit);
    const std::string stop = "longer segments diverge or predict worse than a constant would";
    shooting_.forget_failure();
    const std::string what =
        "the model follows the measured motion over segments of " + span + " s only: run on, the simulated motion leaves it (" + stop + ")";
    FittedModel out = failed(what);
    out.fit.facts["prediction"] = "restarted every " + span + " s from a fitted state: no single trajectory exists";
    if (out.fit.predictions.empty()) show_segments(shooting_, experiments_, out.fit);
    return out;
  }

  /// One trajectory, integrated so finely that its error moves no estimate.
  FittedModel whole_trajectory(const ShootingPass& lengthened) {
    if (lengthened.length == 0) {
      integration_.plan_for_whole_runs();
    } else {
      integration_.plan();
    }
    bool found = search(lengthened);
    if (found && options_.thorough && !weigh_outputs()) return finish();
    while (found && settled_ && !integration_.negligible_at(estimate_.runs, estimate_.smoothed.covariance))
      found = approach() || search({});
    if (!found) return failed(why_);
    if (settled_ && options_.thorough && !newton_steps() && reach_minimum()) static_cast<void>(newton_steps());
    const SuspendedTimeLimit writing_up;
    return finish();
  }

  /// Whenever the roughness is chosen anew, the last lengthening comes first again: a single trajectory alone would creep along the curved
  /// valley of equal phase.
  bool search(const ShootingPass& lengthened) {
    constexpr int with_roughness = 8, of_noise_alone = 40, most_iterations = 200;
    const int most_rounds = any_chosen(penalties_) ? with_roughness : of_noise_alone;
    const ShootingPass whole{.initial_radius = std::min(1e8, largest_radius_), .max_iterations = most_iterations, .tolerance = 1e-7};
    double before = 0.0;
    settled_ = false;
    for (int round = 0; round < most_rounds && !settled_; ++round) {
      if (round > 0 && any_chosen(penalties_) && lengthened.length > 0 && !solve(lengthened)) return stopped(last_.message);
      if (!solve(whole) && !(integration_.plan_finely() && solve(whole))) return stopped(last_.message);
      if (!shooting_.linearise(estimate_.linearised, &estimate_.runs)) return stopped("");
      estimate_.smoothed = estimate_smoothing(estimate_.linearised, penalties_);
      if (!estimate_.smoothed.ok) return stopped(singular_message(estimate_.linearised));
      const double edf = estimate_.smoothed.edf;
      const std::vector<double> sigma = channel_sigmas({shooting_, estimate_.runs, experiments_}, edf);
      const bool same_roughness = !any_chosen(penalties_) || std::abs(edf - before) < 0.1;
      settled_ = same_roughness && same_noise(sigma);
      before = edf;
      shooting_.set_sigma(sigma);
    }
    is_linearised_ = false;
    return true;
  }

  /// An end of search() to which it is possible to return.
  struct Snapshot {
    Shooting::State at;
    std::vector<Penalty> penalties;
    std::vector<double> sigma;
    LeastSquares::Summary last;
    bool settled;
    double height;
  };

  /// After linearise_here().
  [[nodiscard]] Snapshot snapshot() const {
    return {shooting_.state(), penalties_,
            shooting_.sigma(), last_,
            settled_,          height_of(estimate_, {shooting_, estimate_.runs, experiments_}, penalties_)};
  }

  void return_to(const Snapshot& end) {
    shooting_.restore(end.at);
    shooting_.set_sigma(end.sigma);
    shooting_.forget_failure();
    penalties_ = end.penalties;
    last_ = end.last;
    settled_ = end.settled;
    is_linearised_ = false;
  }

  /// inference/output_weights.h; stands at the highest end, estimate_ of it. False: with the noise found there, the end cannot be run, or
  /// is singular.
  bool weigh_outputs() {
    if (other_weighings(shooting_.model()).empty()) return true;
    if (!linearise_here() || !estimate_.smoothed.ok) return false;
    Snapshot best = snapshot();
    const auto end_from = [&](const Weighing& weighing, const Snapshot& from) {
      return settles_elsewhere(weighing, from) ? std::optional(snapshot()) : std::nullopt;
    };
    try {
      other_maxima_ =
          weigh_outputs_otherwise<Snapshot>(shooting_.model(), best, {end_from, [&](const Snapshot& end) { return_to(best = end); }});
    } catch (const TimeLimitReached&) {  // what there is stands
      return_to(best);
    }
    const SuspendedTimeLimit back;
    return linearise_here() && estimate_.smoothed.ok;
  }

  /// A search that begins with another noise of one output. False: it leads nowhere, or back.
  bool settles_elsewhere(const Weighing& weighing, const Snapshot& from) {
    constexpr double another = 0.1;  // relative change of a noise
    constexpr int few_iterations = 8;
    std::vector<double> sigma = from.sigma;
    sigma[weighing.output] *= weighing.factor;
    shooting_.set_sigma(sigma);
    const double edf = estimate_.smoothed.edf;
    if (!solve({.initial_radius = std::min(1e8, largest_radius_), .max_iterations = few_iterations, .tolerance = 1e-3})) return false;
    const auto led_away = [&] {
      const std::vector<Segment> runs = shooting_.run(false);
      const std::vector<double> now = channel_sigmas({shooting_, runs, experiments_}, edf);
      shooting_.set_sigma(from.sigma);
      const bool away = !same_noise(now, another);
      shooting_.set_sigma(now);
      return away;
    };
    return led_away() && search({}) && settled_ && linearise_here() && estimate_.smoothed.ok && led_away();
  }

  bool stopped(const std::string& why) {
    why_ = why;
    return false;
  }

  /// A search in a long valley ends by its tolerance some way before the minimum: on to it, with noise and roughness as they are. Where
  /// that leads nowhere, everything is as before.
  bool reach_minimum() {
    const Shooting::State before = shooting_.state();
    const LeastSquares::Summary then = last_;
    constexpr double radius = 1e12;  // with a smaller one, directions that the data determine by a millionth of the others creep
    const bool solved = solve({.initial_radius = radius, .max_iterations = 100, .tolerance = 1e-13});
    last_ = then;
    is_linearised_ = false;
    if (solved) return true;
    shooting_.restore(before);
    shooting_.forget_failure();
    return false;
  }

  /// From near the minimum to all its digits, by Gauss–Newton steps that shrink, noise and roughness as they are. Steps that shrink by a
  /// rate along one direction are the terms of a geometric series: its sum is gone at once. False, and everything as at the shortest of
  /// them, if they do not shrink to nothing: far from the minimum, or at a bound. Not for fits by the thousand.
  bool newton_steps() {
    constexpr double negligible = 1e-8, few_digits = 1e-6, near = 0.5, shrinks = 0.8, highest_rate = 0.5;  // steps in sigma
    constexpr int most = 25;
    double before = near / shrinks;
    Eigen::VectorXd last;
    Shooting::State best = shooting_.state();
    for (int k = 0; k < most && linearise_here() && estimate_.smoothed.ok; ++k) {
      const Eigen::VectorXd step = newton_step(estimate_.linearised, penalties_, estimate_.smoothed.covariance);
      const Eigen::VectorXd here = in_sigmas(step, estimate_.smoothed.covariance);
      const double size = here.cwiseAbs().maxCoeff();
      if (!(size < shrinks * before)) break;
      if (size < negligible && !noise_moves()) return true;
      best = shooting_.state();
      before = size;
      const double rate = last.size() > 0 ? std::clamp(here.dot(last) / last.squaredNorm(), -highest_rate, highest_rate) : 0.0;
      last = here;
      if (!shooting_.move_to(estimate_.linearised.theta + step / (1.0 - rate))) break;
      is_linearised_ = false;
    }
    shooting_.restore(best);
    shooting_.forget_failure();
    is_linearised_ = false;
    return before < few_digits;
  }

  /// Noise by the residuals at the end, where no roughness hangs on it. False: it was that already.
  bool noise_moves() {
    constexpr double negligible = 1e-6;  // relative
    if (any_chosen(penalties_)) return false;
    const std::vector<double> sigma = channel_sigmas({shooting_, estimate_.runs, experiments_}, estimate_.smoothed.edf);
    if (same_noise(sigma, negligible)) return false;
    shooting_.set_sigma(sigma);
    is_linearised_ = false;
    return true;
  }

  std::string singular_message(const NormalEquations& linearised) {
    const Model& model = shooting_.model();
    std::string which = linearised.N.size() > 0 ? undetermined(model, linearised) : "";
    if (which.empty() && linearised.N.size() > 0)
      which = undetermined_starts(model, precision_of(linearised, penalties_, 1.0), experiments_);
    return undetermined_message(which.empty() ? "the information matrix is singular: some parameters are not determined by these data"
                                              : which);
  }

  std::string undetermined_message(const std::string& which) {
    constexpr double near = 1.0, alike = 1.0;  // sigma; of a log-likelihood
    const std::vector<Segment> runs = shooting_.run(false);
    const SimulatedRuns end{shooting_, runs, experiments_};
    const double left =
        estimate_.smoothed.ok
            ? largest_in_sigmas(newton_step(estimate_.linearised, penalties_, estimate_.smoothed.covariance), estimate_.smoothed.covariance)
            : 0.0;
    stuck_ = misfit_of(end);
    std::string unsettled;
    if (!last_.converged || left > near) unsettled = "the search ended before it came to a maximum";
    if (first_misfit_ && !(std::abs(*first_misfit_ - *stuck_) < alike))
      unsettled = "two searches from these values ended at different points";
    return why_undetermined(which, unsettled, end);
  }

  /// No deterministic model can follow driven motion: there the method declines, with the reason, instead of failing.
  FittedModel failed(const std::string& why) {
    FittedModel out{{}, shooting_.model(), penalties_, {}};
    out.fit.method = estimators::output_error.name;
    out.fit.status = start_driven_ ? FitStatus::declined : FitStatus::failed;
    out.fit.driven = start_driven_;
    out.fit.message = shooting_.failure().empty() ? why : shooting_.failure() + (why.empty() ? "" : " (" + why + ")");
    if (start_driven_) {
      out.fit.message =
          "the motion is driven by a force that this deterministic model does not have, so it cannot follow it: " + out.fit.message +
          ". The method that can estimate such motion is " + random_force_estimator().name;
      show_segments(shooting_, experiments_, out.fit);
    }
    out.fit.linearisations = shooting_.linearisations();
    return out;
  }

  /// The Gaussian and the runs at the present values, noise and roughness as they are.
  bool linearise_here() {
    if (is_linearised_) return true;
    std::vector<Penalty> penalties = with_fixed_weights(penalties_);
    if (!shooting_.linearise(estimate_.linearised, &estimate_.runs)) return false;
    estimate_.smoothed = estimate_smoothing(estimate_.linearised, penalties, 1.0);
    is_linearised_ = true;
    return true;
  }

  FittedModel finish() {
    FittedModel out{{}, shooting_.model(), penalties_, {}};
    Fit& fit = out.fit;
    fit.method = estimators::output_error.name;
    fit.status = last_.converged && settled_ ? FitStatus::converged : FitStatus::not_converged;
    fit.message = last_.converged && !settled_ ? "noise variances and smoothing parameters have not converged" : last_.message;
    if (!linearise_here()) return failed("");
    if (!estimate_.smoothed.ok) return failed(singular_message(estimate_.linearised));
    if (const std::string which = undetermined(out.model, estimate_.linearised); !which.empty()) return failed(undetermined_message(which));
    integration_.describe(out);
    set_noise(shooting_, experiments_, estimate_.degrees(), fit);
    const Eigen::MatrixXd covariance =
        describe_estimates(estimate_, {shooting_, estimate_.runs, experiments_}, {setting_.states, penalties_, options_.thorough}, out);
    predictions_of({shooting_, estimate_.runs, experiments_}, covariance, fit);
    errors_of(experiments_, fit);
    set_initial_states(shooting_, experiments_, out);
    fit.facts["effective_parameters"] = format_value(estimate_.smoothed.edf);
    add_remarks({estimate_, {shooting_, estimate_.runs, experiments_}, setting_, regression_says_driven_, other_maxima_}, covariance, out);
    fit.linearisations = shooting_.linearisations();
    return out;
  }

  /// From near the estimate to it. False if it is not near, if the noise is another one there, or the way is not found.
  bool approach() {
    constexpr double few = 3.0;  // sigma
    if (!(integration_.shift() < few) || !reach_minimum() || !linearise_here() || !estimate_.smoothed.ok) return false;
    return same_noise(channel_sigmas({shooting_, estimate_.runs, experiments_}, estimate_.smoothed.edf));
  }

  [[nodiscard]] bool same_noise(const std::vector<double>& sigma, double difference = 0.01) const {
    return std::equal(sigma.begin(), sigma.end(), shooting_.sigma().begin(),
                      [difference](double now, double then) { return std::abs(now / then - 1.0) < difference; });
  }

  const std::vector<Signals>& experiments_;
  OutputErrorStart options_;
  bool start_driven_;
  std::optional<bool> regression_says_driven_;
  Setting setting_;
  std::vector<Penalty> penalties_;
  Shooting shooting_;
  OutputErrorIntegration integration_;
  std::vector<Eigen::VectorXd> initial_states_;  ///< where the start is a fit
  LinearisedEstimate estimate_;
  bool is_linearised_ = false;  ///< estimate_ is of the present values, noise and roughness
  LeastSquares::Summary last_;
  double largest_radius_ = std::numeric_limits<double>::infinity();  ///< of trust regions
  std::optional<double> stuck_, first_misfit_;                       ///< misfit where parameters are not determined; in the first search
  std::vector<std::string> other_maxima_;                            ///< in words
  std::string why_;                                                  ///< the search stopped
  bool settled_ = false;                                             ///< noise and roughness agree with the residuals they leave
};

}  // namespace

FittedModel output_error(const FittedModel& start, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
  const Stopwatch clock;
  FittedModel out = Estimator(start, experiments, options).run();
  out.fit.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
