#include "misfit/fit/filter/filter_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/fit/filter/likelihood_ascent.h"
#include "misfit/fit/filter/likelihood_derivatives.h"
#include "misfit/fit/filter/restricted_likelihood.h"
#include "misfit/math/learned_curvature.h"

namespace misfit {
namespace {

class Estimation {
 public:
  Estimation(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments, const FilterOptions& options)
      : options_(options), at_(start, std::move(penalties), experiments, options) {}

  FilterEstimate run() {
    if (!start_run()) throw RunError(at_.failure());
    if (at_.plan(options_.integration) && !at_.linearise()) throw RunError(at_.failure());
    if (!options_.noise) search_noise();
    at_.iterate(25, tolerance());  // the exact derivatives step over both blocks at once
    if (!options_.use) gate_outliers();
    if (options_.verify) refine_jointly();
    if (options_.verify) integrate_well();
    const bool runs = std::all_of(out_.traces.begin(), out_.traces.end(), [](const FilterTrace& trace) { return trace.finite; });
    if (!runs && !at_.linearise()) throw RunError(at_.failure());
    finish();
    return std::move(out_);
  }

 private:
  /// [log-likelihood] Steps by the exact derivatives, if any, end what is left.
  [[nodiscard]] double tolerance() const { return options_.verify ? 0.2 : 0.02; }

  /// The first run. A filter that is too sure of itself loses the motion: its noise is raised until innovations are as large as it expects
  /// them, within a factor of two.
  bool start_run() {
    constexpr int most = 12;
    bool runs = at_.linearise();
    for (int k = 0; k < most && !options_.noise; ++k) {
      double squares = 0.0, count = 0.0;
      for (const auto& jacobian : out_.jacobians) {
        squares += jacobian.r.squaredNorm();
        count += static_cast<double>(jacobian.r.size());
      }
      constexpr double expected = 4.0;
      if (runs && squares <= expected * count) break;
      out_.noise.force *= 2.0;
      for (auto& channel : out_.noise.channels) {
        channel.white *= 1.5;
        channel.jitter *= 1.5;
      }
      runs = at_.linearise();
    }
    return runs;
  }

  /// First about the curves that fit under the assumed noise; these can be too wild to be run with another, then about the start's.
  void search_noise() {
    const Eigen::VectorXd start = at_.theta;
    at_.gauss_newton_step();
    if (at_.try_noise(best_noise())) return;
    at_.theta = start;
    at_.linearise();
    at_.try_noise(best_noise());
  }

  /// Starts of the jitter's frequency: the likelihood has a maximum per line it could sit on.
  NoiseFit best_noise() const {
    NoiseFit best;
    best.minus_loglik = std::numeric_limits<double>::infinity();
    for (const double share : {0.4, 1.0, 2.0}) {
      FilterNoise start = out_.noise;
      for (std::size_t o = 0; o < start.channels.size(); ++o)
        start.channels[o].jitter_frequency = share * out_.around.channels[o].jitter_frequency;
      const NoiseFit fit = fit_noise(at_.runs(), start, out_.around, options_.threads, 6);
      if (fit.minus_loglik < best.minus_loglik) best = fit;
    }
    return best;
  }

  /// Sets outliers aside and estimates again, until none comes or goes: what was estimated with them in may have called good ones wild.
  void gate_outliers() {
    constexpr int rounds = 4;
    std::vector<FilterData> all = out_.data;
    std::vector<std::vector<std::size_t>> before(all.size()), now(all.size());
    FilterRunner runner(out_.forced, false);
    for (int round = 0; round < rounds; ++round) {
      FilterTrace trace;
      out_.outliers = 0;
      runner.set_parameters(at_.values());
      for (std::size_t e = 0; e < all.size(); ++e) {
        if (!runner.run_gated(all[e], out_.noise, trace, now[e])) return;
        out_.outliers += static_cast<int>(now[e].size());
      }
      if (now == before) return;
      for (std::size_t e = 0; e < all.size(); ++e) {
        out_.data[e].use = all[e].use;
        for (std::size_t at : now[e]) out_.data[e].use[at] = SampleRole::none;
      }
      before = now;
      at_.linearise();
      at_.iterate(15, tolerance());
    }
  }

  /// Steps by the exact derivatives. Readings at which the filter's linearisation breaks still move it, but no longer count.
  void refine_jointly() {
    constexpr int most = 20;
    LikelihoodDerivatives exact;
    bool near = false;  // to where the derivatives were taken, and the step from there gained what they promised
    for (int k = 0; k < most; ++k) {
      exact = exact_derivatives(out_, at_.theta, options_.threads, near ? &exact : nullptr);
      if (near && !exact.failure.empty()) exact = exact_derivatives(out_, at_.theta, options_.threads);
      near = false;
      out_.left.reset();
      if (!exact.failure.empty()) {
        unverified_ = exact.failure;
        return;
      }
      if (!options_.use && exclude_nonlinear(exact.nonlinear)) {
        at_.linearise();
        at_.iterate(15, tolerance());
        learned_ = {};
        continue;
      }
      restrict_likelihood();
      unverified_ = "the information matrix cannot be inverted";
      if (!invert_joint(exact)) return;
      constexpr double enough = 0.02, nearly = 0.5;
      Eigen::VectorXd gradient = exact.gradient;
      gradient.tail(restricted_.slope.size()) += restricted_.slope;
      learned_.look(at_.joint(), gradient);
      std::optional<double> gained = at_.joint_step(gradient, learned_.inverse(out_.joint_covariance), restricted_.slope, enough);
      if (!gained && learned_.anything()) {  // from kinks one learns nonsense
        learned_ = {};
        gained = at_.joint_step(gradient, out_.joint_covariance, restricted_.slope, enough);
      }
      if (!gained) return;
      const double promised = *out_.left;
      // A short step that gains what was promised ends at the maximum; a longer one is looked at again.
      if (promised < nearly) {
        out_.left = std::abs(promised - *gained);
        return;
      }
      constexpr double short_step = 8.0, as_promised = 0.2;  // four sigmas of one parameter
      near = promised < short_step && std::abs(*gained - promised) < as_promised * promised;
    }
  }

  /// −½ log det N is all but straight in the logarithms of the noise: its slope is kept until these have gone some way.
  void restrict_likelihood() {
    constexpr double some_way = 0.1;
    const std::vector<double>& logs = out_.noise_fit.logs;
    bool moved = restricted_at_.size() != logs.size();
    for (std::size_t i = 0; i < logs.size() && !moved; ++i) moved = std::abs(logs[i] - restricted_at_[i]) > some_way;
    if (!moved) return;
    restricted_ = restricted_likelihood(out_, at_.theta, options_.threads);
    restricted_at_ = logs;
  }

  /// Where so little is known of the noise that nothing would be left after what is lost, the loss, an approximation, is not taken off.
  bool invert_joint(const LikelihoodDerivatives& exact) {
    const Eigen::MatrixXd whole = joint_information(out_, exact);
    Eigen::MatrixXd less = whole;
    const Eigen::Index q = restricted_.lost.rows();
    less.bottomRightCorner(q, q) -= restricted_.lost;
    const PenaltyBasis bends = penalty_eigenbasis(whole.rows(), out_.penalties);
    for (const Eigen::MatrixXd* information : std::array<const Eigen::MatrixXd*, 2>{&less, &whole}) {
      if (!invert_with(*information, bends, out_.joint_covariance)) continue;
      out_.joint_information = *information;
      return true;
    }
    return false;
  }

  /// Plans the integration anew where its error moves an estimate by more than a tenth of its sigma, and estimates again.
  void integrate_well() {
    constexpr double enough = 0.1, aim = 0.02;
    constexpr int most_plans = 3;
    double tolerance = options_.integration;
    for (int plans = 0;; ++plans) {
      const double shift = at_.integration_shift();
      tell_integration(plans, shift);
      double worst = 0.0;
      for (const auto& data : out_.data) worst = std::max(worst, data.inputs.plan.error);
      const double next = std::max(std::min(tolerance, worst) * aim / shift, kFinestTolerance);
      if (!(shift > enough) || plans == most_plans || next >= tolerance) return;
      tolerance = next;
      if (!at_.plan(tolerance) || !at_.linearise()) return;
      at_.iterate(15, this->tolerance());
      learned_ = {};
      refine_jointly();
    }
  }

  void tell_integration(int plans, double shift) {
    std::vector<IntegrationPlan> used;
    for (const auto& data : out_.data) used.push_back(data.inputs.plan);
    out_.integration = in_words(used, plans) + in_words_of(shift, used.front().tolerance);
  }

  bool exclude_nonlinear(const std::vector<std::vector<std::size_t>>& nonlinear) {
    bool any = false;
    for (std::size_t e = 0; e < nonlinear.size(); ++e) {
      for (std::size_t at : nonlinear[e]) {
        out_.data[e].use[at] = SampleRole::update;
        out_.nonlinear.push_back(out_.data[e].signals->t[at / static_cast<std::size_t>(out_.model.outputs())]);
        any = true;
      }
    }
    return any;
  }

  void finish() {
    for (std::size_t c = 0; c < at_.free.size(); ++c)
      out_.model.parameters[static_cast<std::size_t>(at_.free[c])].value = at_.theta[static_cast<Eigen::Index>(c)];
    const std::vector<double> all = at_.values();
    for (std::size_t i = 0; i < all.size(); ++i) out_.forced.model.parameters[i].value = all[i];
    out_.objective = at_.objective;
    if (!at_.free.empty()) {
      std::vector<Penalty> kept = out_.penalties;
      for (auto& p : kept) p.chosen = false;
      const PenalisedFit smoothed = estimate_smoothing(at_.normal_equations(), kept, 1.0);
      if (smoothed.ok) {
        out_.covariance = smoothed.covariance;
        out_.edf = smoothed.edf;
      }
      if (out_.joint_covariance.size() > 0) out_.covariance = out_.joint_covariance.topLeftCorner(at_.theta.size(), at_.theta.size());
    }
    for (const auto& trace : out_.traces) out_.validation_loglik += trace.validation_loglik;
    constexpr double near = 0.5, far = 2.0;  // as much as a sigma, two sigmas of one parameter
    if (options_.verify) out_.converged = out_.left && (*out_.left < near || (out_.converged && *out_.left < far));
    if (out_.left && *out_.left >= near) {
      out_.message = "the exact derivatives of the likelihood say that it could still rise by " + format_value(*out_.left) +
                     (out_.converged ? ", less than two sigmas of one parameter would" : "");
    } else if (out_.converged) {
      out_.message = "the likelihood no longer rises";
    } else if (options_.verify && !out_.left) {
      out_.message = "whether the likelihood still rises could not be verified: " + unverified_;
    } else {
      out_.message = "iteration limit: the likelihood may still rise";
    }
  }

  FilterOptions options_;
  LearnedCurvature learned_;
  RestrictedLikelihood restricted_;
  std::vector<double> restricted_at_;  ///< the logarithms where it was taken
  std::string unverified_ = "too many samples where the linearisation of the filter fails";
  LikelihoodAscent at_;
  FilterEstimate& out_ = at_.out;
};

}  // namespace

FilterEstimate estimate_filter(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  return Estimation(start, std::move(penalties), experiments, options).run();
}

double log_prior(const Model& model, const std::vector<Penalty>& penalties) {
  const std::vector<int> free = model.free_parameters();
  Eigen::VectorXd theta(static_cast<Eigen::Index>(free.size()));
  for (std::size_t c = 0; c < free.size(); ++c)
    theta[static_cast<Eigen::Index>(c)] = model.parameters[static_cast<std::size_t>(free[c])].value;
  return log_prior_at(model, penalties, theta);
}

}  // namespace misfit
