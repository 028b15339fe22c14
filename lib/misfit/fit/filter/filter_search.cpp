#include "misfit/fit/filter/filter_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/fit/filter/free_approach.h"
#include "misfit/fit/filter/noise_survey.h"
#include "misfit/fit/filter/outliers_at_jumps.h"
#include "misfit/fit/filter/runnable_start.h"

namespace misfit {

void FilterSearch::approach(int rounds, Unrunnable unrunnable) {
  make_runnable(unrunnable);
  plan_first();
  set_floor();
  if (!noise_given_) search_noise(at_, options_.threads);
  iterate_first(rounds);
}

void FilterSearch::approach_freely(int rounds) {
  settle_freely(at_);
  plan_first();
  iterate_first(rounds);
}

void FilterSearch::finish() {
  if (!out_.converged && rounds_left_ > 0) at_.iterate(rounds_left_, tolerance());
  if (!options_.noise && !out_.reference.time_is_given) survey_noise();
  if (!options_.noise && options_.verify) weigh_outputs_otherwise(at_, {all_rounds, tolerance(), options_.threads});
  if (!options_.use) reject_outliers();
  begin_memories_anew();
  if (options_.verify) refine_jointly();
  return_to_floor();
  if (options_.verify && !options_.plans) integrate_well();
  conclude();
}

bool FilterSearch::cut_off(const TimeLimitReached& spent) {
  if (!at_.return_to_remembered()) return false;
  out_.newton_decrement.reset();
  out_.joint_covariance.resize(0, 0);
  out_.joint_information.resize(0, 0);
  out_.converged = false;
  conclude();
  out_.out_of_time = true;
  out_.message = in_words(spent, "log-likelihood", out_.loglik);
  return true;
}

FilterOptions FilterSearch::with_noise_of(const FilterStart& start, FilterOptions options) {
  if (start.noise) options.noise = start.noise;
  return options;
}

void FilterSearch::plan_first() {
  at_.remember();
  if (!options_.plans && at_.plan(options_.integration) && !at_.linearise()) throw RunError(at_.failure());
}

void FilterSearch::iterate_first(int rounds) {
  at_.iterate(rounds, tolerance());  // refine_jointly() steps over both blocks at once
  rounds_left_ -= rounds;
}

void FilterSearch::make_runnable(Unrunnable unrunnable) {
  const FilterNoise first_noise = out_.noise;
  if (runs_with_raised_noise() || runs_finely(first_noise)) return;
  const std::string why = at_.failure();
  if (unrunnable == Unrunnable::refused) throw RunError(why);
  for (const RunnableStart& start : runnable_starts(out_.model)) {
    at_.theta = start.model.theta();
    out_.noise = out_.reference;
    out_.forced.set_force_time(out_.noise.force_time);
    noise_given_ = false;
    if (!runs_with_raised_noise()) continue;
    replaced_ = "the model cannot be run from its start (" + why + "); the search began elsewhere: " + start.words;
    return;
  }
  throw RunError(why);
}

bool FilterSearch::runs_with_raised_noise() {
  constexpr int most_raises = 12;
  constexpr double most_variance = 4.0;  // of whitened innovations, which should have 1
  bool runs = at_.linearise();
  for (int k = 0; k < most_raises && !noise_given_; ++k) {
    if (runs && innovation_variance() <= most_variance) break;
    out_.noise.force *= 2.0;
    for (double& force : out_.noise.further_forces) force *= 2.0;
    for (auto& channel : out_.noise.channels) {
      channel.white *= 1.5;
      channel.coloured *= 1.5;
    }
    runs = at_.linearise();
  }
  return runs;
}

bool FilterSearch::runs_finely(const FilterNoise& noise) {
  constexpr double fine = 1e-7;
  if (options_.integration <= fine) return false;
  out_.noise = noise;
  at_.plan_along_measurements(fine);
  if (!runs_with_raised_noise()) return false;
  options_.integration = fine;
  return true;
}

void FilterSearch::set_floor() {
  if (!noise_given_ || !options_.use || any_chosen(out_.penalties)) return;
  floor_.emplace(Floor{at_.theta, pack(out_.noise, out_.model.system->spec(), out_.reference).value, at_.objective});
}

void FilterSearch::return_to_floor() {
  constexpr int most_steps = 5;
  if (!floor_ || at_.objective >= floor_->objective) return;
  const std::vector<FilterData> before = out_.data;
  at_.begin_memories(floor_->theta);
  if (!at_.move_to(floor_->theta, floor_->logs)) {
    out_.data = before;
    at_.linearise();
    return;
  }
  const Eigen::MatrixXd information = out_.noise_fit.information;
  out_.noise_fit = fit_noise(at_.runs(), out_.noise, {out_.reference, options_.threads, 0});
  out_.noise_fit.information = information;
  out_.noise_fit.logs = floor_->logs;
  const Eigen::Index q = std::ssize(floor_->logs);
  restricted_ = {Eigen::VectorXd::Zero(q), Eigen::MatrixXd::Zero(q, q)};
  LikelihoodDerivatives exact;
  for (int k = 0; k < most_steps && options_.verify; ++k) {
    if (!differentiate(false, exact) || !invert_joint(exact)) return;
    if (!at_.joint_step(exact.gradient, out_.joint_covariance, restricted_.slope)) return;
    if (*out_.newton_decrement < kDecrementOfOneSigma) return;
  }
}

double FilterSearch::innovation_variance() const {
  double squares = 0.0, count = 0.0;
  for (const auto& jacobian : out_.jacobians) {
    squares += jacobian.r.squaredNorm();
    count += static_cast<double>(jacobian.r.size());
  }
  return count > 0.0 ? squares / count : 0.0;
}

void FilterSearch::survey_noise() {
  constexpr double clearly_higher = 0.5, nearly = 5.0;  // [log-likelihood]
  const std::vector<NoiseFit> maxima = noise_maxima(at_.runs(), out_.noise, {out_.reference, options_.threads});
  if (maxima.empty()) return;
  const double present = fit_noise(at_.runs(), out_.noise, {out_.reference, options_.threads, 0}).minus_log_density;
  if (maxima.front().minus_log_density < present - clearly_higher && at_.try_noise(maxima.front())) at_.iterate(all_rounds, tolerance());
  for (const NoiseFit& other : maxima) {
    const double below = other.minus_log_density - maxima.front().minus_log_density;
    if (&other == &maxima.front() || below > nearly) continue;
    out_.notes.push_back("the likelihood has another maximum at a correlation time of the random force of about " +
                         format_value(other.noise.force_time) + " s, lower by " + format_value(2.0 * below) + " in 2 log L");
  }
}

void FilterSearch::reject_outliers() {
  constexpr int most_rounds = 4;
  const std::vector<FilterData> all = out_.data;
  std::vector<std::vector<std::size_t>> before(all.size()), now(all.size());
  std::optional<OutliersAtJumps> kept;
  FilterRunner runner(out_.forced, false);
  for (int round = 0; round < most_rounds; ++round) {
    FilterTrace trace;
    runner.set_parameters(at_.values());
    bool runs = true;
    for (std::size_t e = 0; e < all.size(); ++e) runs = runs && runner.run_gated(all[e], out_.noise, trace, now[e]);
    if (!runs) break;
    if (const auto at_jumps = outliers_at_jumps(out_.model.system->spec(), all, now)) kept = at_jumps;
    out_.outliers = 0;
    for (std::size_t e = 0; e < all.size(); ++e) {
      if (kept) now[e] = without_those_at_jumps(all[e], kept->input, std::move(now[e]));
      out_.outliers += int_size(now[e]);
    }
    if (now == before) break;
    for (std::size_t e = 0; e < all.size(); ++e) {
      out_.data[e].use = all[e].use;
      for (std::size_t at : now[e]) out_.data[e].use[at] = SampleRole::none;
    }
    before = now;
    iterate_again();
  }
  if (kept) out_.notes.push_back(in_words(*kept, out_.model.system->spec()));
}

void FilterSearch::begin_memories_anew() {
  constexpr int most = 3;
  constexpr double little = 0.1;  // [log-likelihood]
  if (out_.model.own_states.empty()) return;
  for (int k = 0; k < most; ++k) {
    const std::vector<FilterData> before = out_.data;
    const double objective = at_.objective;
    at_.begin_memories(at_.theta);
    if (!at_.linearise()) {
      out_.data = before;
      at_.linearise();
      return;
    }
    if (std::abs(at_.objective - objective) < little) return;
    at_.iterate(15, tolerance());
  }
}

void FilterSearch::iterate_again() {
  at_.linearise();
  at_.iterate(15, tolerance());
}

void FilterSearch::refine_jointly() {
  constexpr int most_steps = 20, most_axis_steps = 2;
  constexpr double short_step = 8.0, as_promised = 0.2;  // promised gain: of four sigmas of one parameter; share of it
  constexpr double little = 0.1;                         // gain, and share of what was promised
  LikelihoodDerivatives exact;
  bool one_sided = false;
  at_kink_ = false;
  for (int k = 0, axis_steps = 0; k < most_steps; ++k) {
    if (!differentiate(one_sided, exact)) return;
    one_sided = false;
    if (!options_.use && exclude_nonlinear(exact.nonlinear)) {
      iterate_again();
      bfgs_ = {};
      continue;
    }
    restrict_likelihood();
    if (!invert_joint(exact)) return;
    const std::optional<double> gained = step_jointly(exact);
    const double promised = *out_.newton_decrement;
    if (is_hopeless(promised)) return;
    if (promised >= kDecrementOfOneSigma && gained.value_or(0.0) < std::min(little, little * promised)) {
      if (axis_steps++ == most_axis_steps || !step_along_axes()) return;
      continue;
    }
    if (!gained) return;
    if (promised < kDecrementOfOneSigma) {
      out_.newton_decrement = std::abs(promised - *gained);
      return;
    }
    one_sided = promised < short_step && std::abs(*gained - promised) < as_promised * promised;
  }
}

bool FilterSearch::is_hopeless(double promised) const {
  constexpr double exceeded = 3.0, beyond = 5.0;  // of a promise, and of the log-likelihood
  return options_.least && at_.objective + exceeded * promised + beyond < *options_.least;
}

bool FilterSearch::differentiate(bool one_sided, LikelihoodDerivatives& exact) {
  const auto at_theta = [&](const LikelihoodDerivatives* near) { return exact_derivatives(out_, at_.theta, options_.threads, near); };
  exact = at_theta(one_sided ? &exact : nullptr);
  if (one_sided && !exact.failure.empty()) exact = at_theta(nullptr);
  out_.newton_decrement.reset();
  if (exact.failure.empty()) return true;
  unverified_ = exact.failure;
  return false;
}

void FilterSearch::integrate_well() {
  constexpr double enough = 0.1, aim = 0.05, few = 3.0;
  constexpr int most_plans = 3;
  double tolerance = options_.integration;
  for (int plans = 0;; ++plans) {
    const double shift = at_.integration_shift();
    describe_integration(plans, shift);
    if (!(shift > enough) || plans == most_plans || tolerance <= kFinestTolerance) return;
    tolerance = finer_tolerance(plans_of(out_), aim / shift);
    if (!at_.plan(tolerance) || !at_.linearise()) return;
    if (shift > few) at_.iterate(15, this->tolerance());
    bfgs_ = {};
    refine_jointly();
  }
}

void FilterSearch::describe_integration(int plans, double shift) {
  const std::vector<IntegrationPlan> used = plans_of(out_);
  out_.integration = in_words(used, plans) + in_words_of(shift, used.front().tolerance);
}

bool FilterSearch::exclude_nonlinear(const std::vector<std::vector<std::size_t>>& nonlinear) {
  bool any = false;
  for (std::size_t e = 0; e < nonlinear.size(); ++e) {
    for (std::size_t at : nonlinear[e]) {
      out_.data[e].use[at] = SampleRole::update;
      out_.nonlinear.push_back(out_.data[e].signals->t[at / out_.model.outputs()]);
      any = true;
    }
  }
  return any;
}

void FilterSearch::restrict_likelihood() {
  constexpr double least_change = 0.1;
  const std::vector<double>& logs = out_.noise_fit.logs;
  bool moved = restricted_at_.size() != logs.size();
  for (std::size_t i = 0; i < logs.size() && !moved; ++i) moved = std::abs(logs[i] - restricted_at_[i]) > least_change;
  if (!moved) return;
  restricted_ = restricted_likelihood(out_, at_.theta, options_.threads);
  restricted_at_ = logs;
}

bool FilterSearch::invert_joint(const LikelihoodDerivatives& exact) {
  const Eigen::MatrixXd whole = joint_information(out_, exact);
  Eigen::MatrixXd less = whole;
  const Eigen::Index q = restricted_.information_loss.rows();
  less.bottomRightCorner(q, q) -= restricted_.information_loss;
  const PenaltyBasis basis = penalty_eigenbasis(whole.rows(), out_.penalties);
  for (const Eigen::MatrixXd* information : std::array<const Eigen::MatrixXd*, 2>{&less, &whole}) {
    if (!invert_with(*information, basis, out_.joint_covariance)) continue;
    out_.joint_information = *information;
    return true;
  }
  unverified_ = "the information matrix cannot be inverted";
  return false;
}

std::optional<double> FilterSearch::step_jointly(const LikelihoodDerivatives& exact) {
  Eigen::VectorXd gradient = exact.gradient;
  gradient.tail(restricted_.slope.size()) += restricted_.slope;
  bfgs_.update(at_.joint(), gradient);
  std::optional<double> gained = at_.joint_step(gradient, bfgs_.inverse(out_.joint_covariance), restricted_.slope);
  if (gained || !bfgs_.has_updates()) return gained;
  bfgs_ = {};
  return at_.joint_step(gradient, out_.joint_covariance, restricted_.slope);
}

bool FilterSearch::step_along_axes() {
  bfgs_ = {};
  const double gained = at_.axis_step(out_.joint_covariance, restricted_.slope).value_or(0.0);
  at_kink_ = gained < kDecrementOfOneSigma;
  if (at_kink_) out_.newton_decrement = gained;
  return !at_kink_;
}

void FilterSearch::conclude() {
  if (!at_.is_whole() && !at_.linearise_whole()) {
    if (out_.whole_runs || !at_.linearise()) throw RunError(at_.failure());
    throw DivergesWhereHeldOut();
  }
  out_.model.set_theta(at_.theta);
  const std::vector<double> all = at_.values();
  for (std::size_t i = 0; i < all.size(); ++i) out_.forced.model.parameters[i].value = all[i];
  out_.objective = at_.objective;
  if (at_.theta.size() > 0) set_covariance();
  for (const auto& trace : out_.traces) out_.validation_loglik += trace.validation_loglik;
  const std::optional<double>& left = out_.newton_decrement;
  if (options_.verify) out_.converged = left && (*left < kDecrementOfOneSigma || (out_.converged && *left < kDecrementOfTwoSigmas));
  out_.message = how_it_ended();
}

void FilterSearch::set_covariance() {
  std::vector<Penalty> given = with_fixed_weights(out_.penalties);
  const PenalisedFit smoothed = estimate_smoothing(at_.normal_equations(), given, 1.0);
  if (smoothed.ok) {
    out_.covariance = smoothed.covariance;
    out_.edf = smoothed.edf;
  }
  if (out_.joint_covariance.size() > 0) out_.covariance = out_.joint_covariance.topLeftCorner(at_.theta.size(), at_.theta.size());
}

std::string FilterSearch::how_it_ended() const {
  const std::optional<double>& left = out_.newton_decrement;
  constexpr double quadratic = 100.0;  // [log-likelihood] a promise of more is beyond what its derivatives know
  if (left && *left >= quadratic) return "no maximum was reached: the likelihood still rises steeply";
  if (left && *left >= kDecrementOfOneSigma) {
    return "by its exact derivatives the log-likelihood could still rise by " + format_value(*left) +
           (out_.converged ? ", less than a change of one parameter by two sigmas is worth" : "");
  }
  if (out_.converged && at_kink_)
    return "a kink of the likelihood (a corner or a threshold that samples meet): no change of a parameter by a sigma raises it by what "
           "that is worth";
  if (out_.converged) return "the likelihood no longer rises";
  if (options_.verify && !left) return "whether the likelihood is at its maximum could not be verified: " + unverified_;
  return "iteration limit: the likelihood may still rise";
}

}  // namespace misfit
