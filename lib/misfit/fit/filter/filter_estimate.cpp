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
    if (!begin()) begin_finely();
    if (at_.plan(options_.integration) && !at_.linearise()) throw RunError(at_.failure());
    if (!options_.noise) search_noise();
    at_.iterate(25, tolerance());  // refine_jointly() steps over both blocks at once
    if (!options_.use) reject_outliers();
    if (options_.verify) refine_jointly();
    if (options_.verify) integrate_well();
    conclude();
    return std::move(out_);
  }

 private:
  /// [log-likelihood] Coarse where refine_jointly() follows.
  [[nodiscard]] double tolerance() const { return options_.verify ? 0.2 : 0.02; }

  /// A filter that is too sure of itself loses the motion: its noise is raised until innovations are as large as it expects them, within a
  /// factor of two. False if the model cannot be run.
  bool begin() {
    constexpr int most_raises = 12;
    constexpr double most_variance = 4.0;  // of whitened innovations, which should have 1
    bool runs = at_.linearise();
    for (int k = 0; k < most_raises && !options_.noise; ++k) {
      if (runs && innovation_variance() <= most_variance) break;
      out_.noise.force *= 2.0;
      for (auto& channel : out_.noise.channels) {
        channel.white *= 1.5;
        channel.jitter *= 1.5;
      }
      runs = at_.linearise();
    }
    return runs;
  }

  /// A motion that steps for a search lose may be followed in finer ones.
  void begin_finely() {
    constexpr double fine = 1e-7;
    if (options_.integration <= fine) throw RunError(at_.failure());
    options_.integration = fine;
    out_.noise = options_.noise.value_or(out_.around);
    at_.plan_along_readings(fine);
    if (!begin()) throw RunError(at_.failure());
  }

  [[nodiscard]] double innovation_variance() const {
    double squares = 0.0, count = 0.0;
    for (const auto& jacobian : out_.jacobians) {
      squares += jacobian.r.squaredNorm();
      count += static_cast<double>(jacobian.r.size());
    }
    return count > 0.0 ? squares / count : 0.0;
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

  /// From three frequencies of the resonance: the likelihood has a maximum per line it could sit on.
  NoiseFit best_noise() const {
    constexpr int iterations = 6;
    NoiseFit best;
    best.minus_loglik = std::numeric_limits<double>::infinity();
    for (const double share : {0.4, 1.0, 2.0}) {
      FilterNoise start = out_.noise;
      for (std::size_t o = 0; o < start.channels.size(); ++o)
        start.channels[o].jitter_frequency = share * out_.around.channels[o].jitter_frequency;
      const NoiseFit fit = fit_noise(at_.runs(), start, {out_.around, options_.threads, iterations});
      if (fit.minus_loglik < best.minus_loglik) best = fit;
    }
    return best;
  }

  /// What was estimated with outliers among the data may have called good measurements wild: again, until none comes or goes.
  void reject_outliers() {
    constexpr int most_rounds = 4;
    const std::vector<FilterData> all = out_.data;
    std::vector<std::vector<std::size_t>> before(all.size()), now(all.size());
    FilterRunner runner(out_.forced, false);
    for (int round = 0; round < most_rounds; ++round) {
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
      iterate_again();
    }
  }

  /// After a change of which measurements count.
  void iterate_again() {
    at_.linearise();
    at_.iterate(15, tolerance());
  }

  /// Newton steps over parameters and log noise together, each in these steps:
  ///   1. `differentiate`: first derivatives and information of the exact likelihood; to one side only after a short step that gained what
  ///      it promised.
  ///   2. `exclude_nonlinear` (no use given): measurements at which the filter's linearisation breaks still move it, but no longer count;
  ///      iterate and begin again.
  ///   3. `restrict_likelihood`: what the parameters' being estimated does to slope and information of the noise.
  ///   4. `invert_joint`: covariance of parameters and noise with roughness and priors.
  ///   5. `step_jointly`: a Newton step inside the bounds that raises the exact objective.
  /// Ends when no step rises, or after a step of less than a sigma.
  void refine_jointly() {
    constexpr int most_steps = 20;
    constexpr double short_step = 8.0, as_promised = 0.2;  // promised gain: of four sigmas of one parameter; share of it
    LikelihoodDerivatives exact;
    bool one_sided = false;
    for (int k = 0; k < most_steps; ++k) {
      if (!differentiate(one_sided, exact)) return;
      one_sided = false;
      if (!options_.use && exclude_nonlinear(exact.nonlinear)) {
        iterate_again();
        learned_ = {};
        continue;
      }
      restrict_likelihood();
      if (!invert_joint(exact)) return;
      const std::optional<double> gained = step_jointly(exact);
      if (!gained) return;
      const double promised = *out_.newton_decrement;
      if (promised < kDecrementOfOneSigma) {
        out_.newton_decrement = std::abs(promised - *gained);
        return;
      }
      one_sided = promised < short_step && std::abs(*gained - promised) < as_promised * promised;
    }
  }

  bool differentiate(bool one_sided, LikelihoodDerivatives& exact) {
    const auto at_theta = [&](const LikelihoodDerivatives* near) { return exact_derivatives(out_, at_.theta, options_.threads, near); };
    exact = at_theta(one_sided ? &exact : nullptr);
    if (one_sided && !exact.failure.empty()) exact = at_theta(nullptr);
    out_.newton_decrement.reset();
    if (exact.failure.empty()) return true;
    unverified_ = exact.failure;
    return false;
  }

  /// Plans the integration anew where its error moves an estimate by more than a tenth of its sigma, and estimates again.
  void integrate_well() {
    constexpr double enough = 0.1, aim = 0.05, few = 3.0;
    constexpr int most_plans = 3;
    double tolerance = options_.integration;
    for (int plans = 0;; ++plans) {
      const double shift = at_.integration_shift();
      describe_integration(plans, shift);
      if (!(shift > enough) || plans == most_plans || tolerance <= kFinestTolerance) return;
      tolerance = finer_tolerance(used_plans(), aim / shift);
      if (!at_.plan(tolerance) || !at_.linearise()) return;
      if (shift > few) at_.iterate(15, this->tolerance());
      learned_ = {};
      refine_jointly();
    }
  }

  [[nodiscard]] std::vector<IntegrationPlan> used_plans() const {
    std::vector<IntegrationPlan> out;
    for (const auto& data : out_.data) out.push_back(data.inputs.plan);
    return out;
  }

  void describe_integration(int plans, double shift) {
    const std::vector<IntegrationPlan> used = used_plans();
    out_.integration = in_words(used, plans) + in_words_of(shift, used.front().tolerance);
  }

  bool exclude_nonlinear(const std::vector<std::vector<std::size_t>>& nonlinear) {
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

  /// −½ log det N is all but straight in the logarithms of the noise: its slope is kept until one of these has changed by a tenth.
  void restrict_likelihood() {
    constexpr double least_change = 0.1;
    const std::vector<double>& logs = out_.noise_fit.logs;
    bool moved = restricted_at_.size() != logs.size();
    for (std::size_t i = 0; i < logs.size() && !moved; ++i) moved = std::abs(logs[i] - restricted_at_[i]) > least_change;
    if (!moved) return;
    restricted_ = restricted_likelihood(out_, at_.theta, options_.threads);
    restricted_at_ = logs;
  }

  /// Where so little is known of the noise that nothing would be left after the information loss, an approximation, it is not taken off.
  bool invert_joint(const LikelihoodDerivatives& exact) {
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

  /// With the curvature that the steps before have shown, else with that of the information: near kinks one learns nonsense.
  std::optional<double> step_jointly(const LikelihoodDerivatives& exact) {
    Eigen::VectorXd gradient = exact.gradient;
    gradient.tail(restricted_.slope.size()) += restricted_.slope;
    learned_.look(at_.joint(), gradient);
    std::optional<double> gained = at_.joint_step(gradient, learned_.inverse(out_.joint_covariance), restricted_.slope);
    if (gained || !learned_.anything()) return gained;
    learned_ = {};
    return at_.joint_step(gradient, out_.joint_covariance, restricted_.slope);
  }

  void conclude() {
    const bool runs = std::all_of(out_.traces.begin(), out_.traces.end(), [](const FilterTrace& trace) { return trace.finite; });
    if (!runs && !at_.linearise()) throw RunError(at_.failure());
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

  void set_covariance() {
    std::vector<Penalty> given = out_.penalties;
    for (auto& p : given) p.chosen = false;
    const PenalisedFit smoothed = estimate_smoothing(at_.normal_equations(), given, 1.0);
    if (smoothed.ok) {
      out_.covariance = smoothed.covariance;
      out_.edf = smoothed.edf;
    }
    if (out_.joint_covariance.size() > 0) out_.covariance = out_.joint_covariance.topLeftCorner(at_.theta.size(), at_.theta.size());
  }

  [[nodiscard]] std::string how_it_ended() const {
    const std::optional<double>& left = out_.newton_decrement;
    if (left && *left >= kDecrementOfOneSigma) {
      return "the exact derivatives of the likelihood say that it could still rise by " + format_value(*left) +
             (out_.converged ? ", less than two sigmas of one parameter would" : "");
    }
    if (out_.converged) return "the likelihood no longer rises";
    if (options_.verify && !left) return "whether the likelihood still rises could not be verified: " + unverified_;
    return "iteration limit: the likelihood may still rise";
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

}  // namespace misfit
