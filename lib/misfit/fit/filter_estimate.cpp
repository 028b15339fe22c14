#include "misfit/fit/filter_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/fit/filter_exact.h"
#include "misfit/fit/filter_start.h"

namespace misfit {
namespace {

class Estimation {
 public:
  Estimation(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments, const FilterOptions& options)
      : options_(options) {
    out_.model = start;
    out_.penalties = std::move(penalties);
    if (!options.choose_roughness) {
      for (auto& penalty : out_.penalties) penalty.chosen = false;
    }
    out_.forced = with_random_force(start);
    for (const auto& experiment : experiments) out_.data.push_back(filter_data(out_.forced, experiment));
    if (options.use) {
      for (std::size_t e = 0; e < out_.data.size(); ++e) out_.data[e].use = (*options.use)[e];
    }
    free_ = start.free_parameters();
    theta_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t c = 0; c < free_.size(); ++c)
      theta_[static_cast<Eigen::Index>(c)] = start.parameters[static_cast<std::size_t>(free_[c])].value;
    out_.around = options.around ? *options.around : usual_noise(out_.forced, out_.data);
    out_.noise = options.noise ? *options.noise : out_.around;
  }

  FilterEstimate run() {
    set_time();
    if (!start_run()) throw RunError(failure());
    if (!options_.noise) search_noise();
    iterate(25, options_.verify ? 0.2 : 0.02);  // the exact derivatives step over both blocks at once
    if (!options_.use) gate_outliers();
    if (options_.verify) polish();
    const bool runs = std::all_of(out_.traces.begin(), out_.traces.end(), [](const FilterTrace& trace) { return trace.finite; });
    if (!runs && !linearise()) throw RunError(failure());
    finish();
    return std::move(out_);
  }

 private:
  /// The first run. A filter that is too sure of itself loses the motion: its noise is raised until innovations are as large as it expects
  /// them, within a factor of two.
  bool start_run() {
    constexpr int most = 12;
    bool runs = linearise();
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
      runs = linearise();
    }
    return runs;
  }

  /// Alternates the blocks until neither gains.
  void iterate(int most, double tolerance) {
    out_.converged = false;
    for (int k = 0; k < most; ++k) {
      const double before = objective_;
      const bool choosing = std::any_of(out_.penalties.begin(), out_.penalties.end(), [](const Penalty& p) { return p.chosen; });
      const double edf = out_.edf;
      physical_step();
      noise_step(k < 3 ? 3 : kRefinements);
      const bool settled = !choosing || std::abs(out_.edf - edf) < 0.05;
      if (k > 0 && settled && std::abs(objective_ - before) < tolerance) {
        out_.converged = true;
        return;
      }
    }
  }

  void set_time() { out_.forced.model.parameters[static_cast<std::size_t>(out_.forced.time_parameter)].value = out_.noise.force_time; }
  std::vector<double> values(const Eigen::VectorXd& theta) const {
    std::vector<double> all = out_.forced.model.values();
    for (std::size_t c = 0; c < free_.size(); ++c) all[static_cast<std::size_t>(free_[c])] = theta[static_cast<Eigen::Index>(c)];
    return all;
  }
  double penalty(const Eigen::VectorXd& theta) const { return log_prior_at(out_.model, out_.penalties, theta); }

  /// Full run with derivatives at theta_.
  bool linearise() {
    out_.traces.resize(out_.data.size());
    out_.jacobians.resize(out_.data.size());
    FilterRunner runner(out_.forced, true);
    runner.set_parameters(values(theta_));
    double loglik = 0.0;
    for (std::size_t e = 0; e < out_.data.size(); ++e) {
      if (!runner.run(out_.data[e], out_.noise, out_.traces[e], &out_.jacobians[e])) {
        failed_experiment_ = e;
        return false;
      }
      loglik += out_.traces[e].loglik;
    }
    ++out_.linearisations;
    out_.loglik = loglik;
    objective_ = loglik + penalty(theta_);
    return true;
  }

  double objective_at(const Eigen::VectorXd& theta, const FilterNoise& noise) const { return ExactObjective(out_, free_).at(theta, noise); }

  Linearised normal_equations() const {
    Linearised sums;
    const Eigen::Index n = theta_.size();
    sums.N = Eigen::MatrixXd::Zero(n, n);
    sums.g = Eigen::VectorXd::Zero(n);
    sums.theta = theta_;
    for (const auto& jacobian : out_.jacobians) {
      sums.N.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.J.transpose());
      sums.g += jacobian.J.transpose() * jacobian.r;
      sums.rss += jacobian.r.squaredNorm();
      sums.count += static_cast<double>(jacobian.r.size());
    }
    sums.N = Eigen::MatrixXd(sums.N.selfadjointView<Eigen::Lower>());
    set_priors(out_.model, sums);
    return sums;
  }

  /// One Gauss–Newton step of the physical parameters with new roughness; shortened until the exact objective rises.
  void physical_step() {
    if (free_.empty()) return;
    const Smoothed smoothed = smooth(normal_equations(), out_.penalties, 1.0);
    if (!smoothed.ok) return;
    out_.edf = smoothed.edf;
    out_.covariance = smoothed.covariance;
    objective_ = out_.loglik + penalty(theta_);  // the roughness may have changed
    const Eigen::VectorXd step = inside_bounds(smoothed.theta) - theta_;
    for (double share = 1.0; share > 0.05; share *= 0.4) {
      const Eigen::VectorXd there = theta_ + share * step;
      const double value = objective_at(there, out_.noise);
      if (!(value > objective_ - 1e-6)) continue;
      const Eigen::VectorXd before = theta_;
      theta_ = there;
      if (linearise()) return;
      theta_ = before;
    }
    linearise();
  }

  Eigen::VectorXd inside_bounds(Eigen::VectorXd theta) const {
    for (std::size_t c = 0; c < free_.size(); ++c) {
      const Parameter& p = out_.model.parameters[static_cast<std::size_t>(free_[c])];
      auto& value = theta[static_cast<Eigen::Index>(c)];
      value = std::clamp(value, p.lower, p.upper);
    }
    return theta;
  }

  LinearisedRuns runs() const { return {&out_.forced, &out_.data, &out_.traces}; }

  void noise_step(int iterations) {
    const NoiseFit fit = fit_noise(runs(), out_.noise, out_.around, options_.threads, iterations);
    take_noise(fit);
  }

  /// False if the model cannot be run with it: all is as before.
  bool take_noise(const NoiseFit& fit) {
    const FilterNoise before = out_.noise;
    const double objective = objective_;
    out_.noise = fit.noise;
    out_.noise_fit = fit;
    set_time();
    if (linearise() && objective_ > objective - 1.0) return true;
    out_.noise = before;
    set_time();
    linearise();
    return false;
  }

  /// First about the curves that fit under the assumed noise; these can be too wild to be run with another, then about the start's.
  void search_noise() {
    const Eigen::VectorXd start = theta_;
    physical_step();
    if (take_noise(best_noise())) return;
    theta_ = start;
    linearise();
    take_noise(best_noise());
  }

  /// Starts of the jitter's frequency: the likelihood has a maximum per line it could sit on.
  NoiseFit best_noise() const {
    NoiseFit best;
    best.minus_loglik = std::numeric_limits<double>::infinity();
    for (const double share : {0.4, 1.0, 2.0}) {
      FilterNoise start = out_.noise;
      for (std::size_t o = 0; o < start.channels.size(); ++o)
        start.channels[o].jitter_frequency = share * out_.around.channels[o].jitter_frequency;
      const NoiseFit fit = fit_noise(runs(), start, out_.around, options_.threads, 6);
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
      runner.set_parameters(values(theta_));
      for (std::size_t e = 0; e < all.size(); ++e) {
        if (!runner.run_gated(all[e], out_.noise, trace, now[e])) return;
        out_.outliers += static_cast<int>(now[e].size());
      }
      if (now == before) return;
      for (std::size_t e = 0; e < all.size(); ++e) {
        out_.data[e].use = all[e].use;
        for (std::size_t at : now[e]) out_.data[e].use[at] = Use::none;
      }
      before = now;
      linearise();
      iterate(15, options_.verify ? 0.2 : 0.02);
    }
  }

  /// Steps by the exact derivatives. Readings at which the filter's linearisation breaks still move it, but no longer count.
  void polish() {
    constexpr int most = 6;
    for (int k = 0; k < most; ++k) {
      const ExactDerivatives exact = exact_derivatives(out_, theta_, options_.threads);
      if (!options_.use && uncount(exact.rough)) {
        linearise();
        iterate(15, options_.verify ? 0.2 : 0.02);
        continue;
      }
      if (!invert_scaled(joint_precision(out_, exact), out_.joint_covariance)) return;
      const Eigen::VectorXd step = out_.joint_covariance * exact.gradient;
      out_.left = 0.5 * exact.gradient.dot(step);
      constexpr double enough = 0.02, nearly = 0.5;
      const double before = objective_, promised = out_.left;
      if (out_.left < enough || !try_step(step)) return;
      // A short step that gains what was promised ends at the maximum; a longer one is looked at again.
      if (promised < nearly) {
        out_.left = std::abs(promised - (objective_ - before));
        return;
      }
    }
  }

  bool uncount(const std::vector<std::vector<std::size_t>>& rough) {
    bool any = false;
    for (std::size_t e = 0; e < rough.size(); ++e) {
      for (std::size_t at : rough[e]) {
        out_.data[e].use[at] = Use::update;
        out_.rough.push_back(out_.data[e].signals->t[at / static_cast<std::size_t>(out_.model.outputs())]);
        any = true;
      }
    }
    return any;
  }

  bool try_step(const Eigen::VectorXd& step) {
    const Eigen::Index n = theta_.size();
    for (double share = 1.0; share > 0.1; share *= 0.5) {
      const NoiseVector bounds = pack(out_.noise, out_.model.system->spec(), out_.around);
      std::vector<double> logs = out_.noise_fit.logs;
      for (std::size_t i = 0; i < logs.size(); ++i)
        logs[i] = std::clamp(logs[i] + share * step[n + static_cast<Eigen::Index>(i)], bounds.lower[i], bounds.upper[i]);
      const FilterNoise noise = unpack(logs);
      const Eigen::VectorXd there = inside_bounds(theta_ + share * step.head(n));
      if (!(objective_at(there, noise) > objective_)) continue;
      theta_ = there;
      out_.noise = noise;
      out_.noise_fit.logs = logs;
      set_time();
      return linearise();
    }
    return false;
  }

  void finish() {
    for (std::size_t c = 0; c < free_.size(); ++c)
      out_.model.parameters[static_cast<std::size_t>(free_[c])].value = theta_[static_cast<Eigen::Index>(c)];
    const std::vector<double> all = values(theta_);
    for (std::size_t i = 0; i < all.size(); ++i) out_.forced.model.parameters[i].value = all[i];
    out_.objective = objective_;
    if (!free_.empty()) {
      std::vector<Penalty> kept = out_.penalties;
      for (auto& p : kept) p.chosen = false;
      const Smoothed smoothed = smooth(normal_equations(), kept, 1.0);
      if (smoothed.ok) {
        out_.covariance = smoothed.covariance;
        out_.edf = smoothed.edf;
      }
      if (out_.joint_covariance.size() > 0) out_.covariance = out_.joint_covariance.topLeftCorner(theta_.size(), theta_.size());
    }
    for (const auto& trace : out_.traces) out_.validation_loglik += trace.validation_loglik;
    constexpr double near = 0.5, far = 2.0;  // as much as a sigma, two sigmas of one parameter
    if (options_.verify) out_.converged = out_.left < near || (out_.converged && out_.left < far);
    out_.message = out_.converged    ? "the likelihood no longer rises"
                   : out_.left > far ? "the exact derivatives of the likelihood say that it could still rise by " + format_value(out_.left)
                                     : "iteration limit: the likelihood may still rise";
  }

  std::string failure() const {
    const FilterTrace& trace = out_.traces[failed_experiment_];
    const Signals& signals = *out_.data[failed_experiment_].signals;
    return "the model cannot be run: a state is no longer a number at t = " + format_value(signals.t[trace.failed_at]) +
           " s of experiment '" + signals.name + "'";
  }

  FilterOptions options_;
  FilterEstimate out_;
  std::vector<int> free_;
  Eigen::VectorXd theta_;
  double objective_ = 0.0;
  std::size_t failed_experiment_ = 0;
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
