#include "misfit/fit/filter/likelihood_ascent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/fit/filter/filter_start.h"
#include "misfit/fit/filter/likelihood_derivatives.h"
#include "misfit/fit/filter/mirrored_start.h"
#include "misfit/math/bounded.h"
#include "misfit/math/covariance.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

BoxBounds bounds_of(const Model& model) {
  const std::vector<int> free = model.free_parameters();
  BoxBounds bounds{Eigen::VectorXd(std::ssize(free)), Eigen::VectorXd(std::ssize(free))};
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) {
    bounds.lower[c] = model.parameters[free[c]].lower;
    bounds.upper[c] = model.parameters[free[c]].upper;
  }
  return bounds;
}

Eigen::VectorXd joined(const Eigen::VectorXd& a, const std::vector<double>& b) {
  Eigen::VectorXd both(a.size() + std::ssize(b));
  both << a, Eigen::Map<const Eigen::VectorXd>(b.data(), std::ssize(b));
  return both;
}

constexpr double least_gain = 0.02;  // of the log-likelihood: what is less is left

/// Noise with the standard deviations of outputs, but for those given, and of the random force multiplied.
FilterNoise multiplied(FilterNoise noise, const std::vector<double>& factors, const Model& model) {
  if (factors.empty()) return noise;
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    if (!model.known_noise[o].fixed) noise.channels[o].white *= factors[o];
  }
  noise.force *= factors.back();
  for (double& force : noise.further_forces) force *= factors.back();
  return noise;
}

}  // namespace

LikelihoodAscent::LikelihoodAscent(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                                   const FilterOptions& options)
    : threads_(options.threads) {
  out.model = start;
  out.whole_runs = options.whole_runs;
  out.penalties = options.choose_roughness ? std::move(penalties) : with_fixed_weights(std::move(penalties));
  out.forced = with_random_force(start);
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const IntegrationPlan* plan = options.plans ? &(*options.plans)[e] : nullptr;
    out.data.push_back(filter_data(out.forced, experiments[e], options.integration, plan));
    if (options.use) out.data[e].use = (*options.use)[e];
  }
  theta = start.theta();
  out.reference = options.reference ? *options.reference : usual_noise(out.forced, out.data);
  mark_rounding(out.forced, out.data, out.reference);
  out.noise = options.noise ? *options.noise : multiplied(out.reference, options.noise_factors, start);
  out.forced.set_force_time(out.noise.force_time);
  choose_mirrored_starts(out.forced, values(), hardly_forced(out.noise, out.reference), out.data);
}

bool LikelihoodAscent::linearise() {
  if (!run(out.whole_runs)) return false;
  ++out.linearisations;
  return true;
}

bool LikelihoodAscent::linearise_whole() { return run(true); }

bool LikelihoodAscent::is_whole() const {
  return std::all_of(out.traces.begin(), out.traces.end(), [](const FilterTrace& t) { return t.finite && t.end == t.samples; });
}

bool LikelihoodAscent::run(bool whole) {
  out.traces.resize(out.data.size());
  out.jacobians.resize(out.data.size());
  FilterRunner runner(out.forced, true);
  runner.set_parameters(values());
  double loglik = 0.0;
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    if (!runner.run(out.data[e], out.noise, out.traces[e], {.jacobian = &out.jacobians[e], .held_out = whole})) {
      failed_experiment_ = e;
      return false;
    }
    loglik += out.traces[e].loglik;
  }
  out.loglik = loglik;
  objective = loglik + log_prior();
  return true;
}

double LikelihoodAscent::log_prior() const {
  return out.prior().log_density(theta) + misfit::log_prior(out.noise, out.model.system->spec(), out.reference);
}

void LikelihoodAscent::plan_along_measurements(double tolerance) {
  for (FilterData& data : out.data) data.inputs.plan = filter_data(out.forced, *data.signals, tolerance).inputs.plan;
}

bool LikelihoodAscent::plan(double tolerance) {
  if (!is_whole() && !linearise_whole()) {
    linearise();
    return false;
  }
  bool another = false;
  Stepper stepper(out.forced.model);
  stepper.evaluator().set_parameters(values().data());
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    const FilterTrace& trace = out.traces[e];
    FilterData& data = out.data[e];
    RowMatrix states(trace.samples, trace.n);
    for (std::size_t k = data.first; k < trace.samples; ++k) states.row(k) = trace.filtered(k);
    states.topRows(data.first).rowwise() = states.row(data.first).eval();
    IntegrationPlan plan = plan_along({stepper, *data.signals, data.inputs}, states, tolerance);
    another = another || plan.parts != data.inputs.plan.parts || plan.first != data.inputs.plan.first;
    data.inputs.plan = std::move(plan);
  }
  return another;
}

void LikelihoodAscent::begin_memories(const Eigen::VectorXd& theta_of_memories) {
  if (out.model.own_states.empty()) return;
  FilterModel there = out.forced;
  there.model.set_theta(theta_of_memories);
  for (FilterData& data : out.data) data = filter_data_like(there, data);
}

double LikelihoodAscent::integration_shift() const {
  FilterRunner runner(out.forced, false);
  runner.set_parameters(values());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(theta.size());
  FilterTrace trace;
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    FilterData finer = out.data[e];
    finer.inputs.plan = refined(finer.inputs.plan);
    if (!runner.run(finer, out.noise, trace, {.held_out = out.whole_runs})) return 0.0;
    const FilterJacobian& jacobian = out.jacobians[e];
    Eigen::VectorXd change = -jacobian.r;
    for (Eigen::Index r = 0; r < change.size(); ++r) {
      const std::size_t at = jacobian.index[r];
      change[r] -= trace.e[at] / std::sqrt(trace.S[at]);
    }
    gradient += jacobian.J.transpose() * change;
  }
  const Eigen::Index n = theta.size();
  const Eigen::MatrixXd& all = out.joint_covariance.size() > 0 ? out.joint_covariance : out.covariance;
  if (n == 0 || all.rows() < n) return 0.0;
  const auto covariance = all.topLeftCorner(n, n);
  constexpr double least = 1e-300;
  return (covariance * gradient).cwiseQuotient(covariance.diagonal().cwiseMax(least).cwiseSqrt()).cwiseAbs().maxCoeff();
}

double LikelihoodAscent::objective_at(const Eigen::VectorXd& there, const FilterNoise& noise) const {
  return ExactObjective(out).at(there, noise);
}

NormalEquations LikelihoodAscent::normal_equations() const {
  NormalEquations sums;
  const Eigen::Index n = theta.size();
  sums.N = Eigen::MatrixXd::Zero(n, n);
  sums.g = Eigen::VectorXd::Zero(n);
  sums.theta = theta;
  for (const auto& jacobian : out.jacobians) {
    jacobian.add_information(sums.N);
    sums.g += jacobian.J.transpose() * jacobian.r;
    sums.rss += jacobian.r.squaredNorm();
    sums.count += static_cast<double>(jacobian.r.size());
  }
  sums.N = Eigen::MatrixXd(sums.N.selfadjointView<Eigen::Lower>());
  sums.prior = regularised_priors_about(theta, out.model, out.penalties, sums.N);
  return sums;
}

bool LikelihoodAscent::rises_along(const Eigen::VectorXd& step) {
  for (double share = 1.0; share > 0.05; share *= 0.4) {
    const Eigen::VectorXd there = theta + share * step;
    const double value = objective_at(there, out.noise);
    if (!(value > objective - 1e-6)) continue;
    const Eigen::VectorXd before = theta;
    theta = there;
    if (linearise()) {
      remember();
      return true;
    }
    theta = before;
  }
  return false;
}

double LikelihoodAscent::gauss_newton_step() {
  constexpr double nothing = 0.0, unknown = std::numeric_limits<double>::infinity();
  if (theta.size() == 0) return nothing;
  const PenalisedFit smoothed = estimate_smoothing(normal_equations(), out.penalties, 1.0);
  if (!smoothed.ok) return unknown;
  out.edf = smoothed.edf;
  out.covariance = smoothed.covariance;
  objective = out.loglik + log_prior();  // the roughness may have changed
  const auto [lower, upper] = bounds_of(out.model);
  const BoundedMaximum best = maximum_inside(smoothed.theta, smoothed.covariance, lower, upper);
  if (rises_along(best.at - theta)) return nothing;
  linearise();
  Eigen::MatrixXd precision;
  if (!invert_scaled(smoothed.covariance, precision)) return unknown;
  const Eigen::VectorXd newton = smoothed.theta - theta;
  const double not_gained = 0.5 * newton.dot(precision * newton) - best.below;
  if (not_gained >= kDecrementOfOneSigma) damped_step(precision, newton);
  return not_gained;
}

void LikelihoodAscent::damped_step(const Eigen::MatrixXd& precision, const Eigen::VectorXd& newton) {
  constexpr double weakest = 1.0, strongest = 1e4, stronger = 10.0;
  const auto [lower, upper] = bounds_of(out.model);
  const Eigen::VectorXd gradient = precision * newton;
  for (double damping = weakest; damping <= strongest; damping *= stronger) {
    Eigen::MatrixXd damped = precision;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd before = theta, there = (theta + symmetric_solve(damped, gradient)).cwiseMax(lower).cwiseMin(upper);
    if (!(objective_at(there, out.noise) > objective + least_gain)) continue;
    theta = there;
    if (linearise()) {
      remember();
      return;
    }
    theta = before;
    linearise();
  }
}

bool LikelihoodAscent::try_noise(const NoiseFit& fit) {
  const FilterNoise before = out.noise;
  const NoiseFit fit_before = out.noise_fit;
  const std::vector<double> logs = pack(before, out.model.system->spec(), out.reference).value;
  const double then = objective;
  if (!std::isfinite(fit.minus_log_density)) {
    out.noise_fit.logs = logs;
    describe_noise();
    return false;
  }
  out.noise = fit.noise;
  out.noise_fit = fit;
  out.forced.set_force_time(out.noise.force_time);
  if (linearise() && objective > then - 1.0) {
    remember();
    return true;
  }
  out.noise = before;
  out.noise_fit = fit_before;
  out.noise_fit.logs = logs;
  out.forced.set_force_time(out.noise.force_time);
  if (linearise()) describe_noise();
  return false;
}

BoxBounds LikelihoodAscent::joint_bounds() const {
  const NoiseVector noise = pack(out.noise, out.model.system->spec(), out.reference);
  const auto [lower, upper] = bounds_of(out.model);
  return {joined(lower, noise.lower), joined(upper, noise.upper)};
}

bool LikelihoodAscent::move_to(const Eigen::VectorXd& joint) {
  const Eigen::Index n = theta.size();
  return move_to(joint.head(n), {joint.data() + n, joint.data() + joint.size()});
}

bool LikelihoodAscent::move_to(const Eigen::VectorXd& there, const std::vector<double>& logs) {
  const Eigen::VectorXd theta_before = theta;
  const std::vector<double> logs_before = out.noise_fit.logs;
  const auto set = [&](const Eigen::VectorXd& parameters, const std::vector<double>& noise) {
    theta = parameters;
    out.noise_fit.logs = noise;
    out.noise = unpack(noise, out.model.system->spec());
    out.forced.set_force_time(out.noise.force_time);
    return linearise();
  };
  if (set(there, logs)) {
    remember();
    report_iteration(++iterations_, "log-likelihood", out.loglik);
    return true;
  }
  set(theta_before, logs_before);
  return false;
}

void LikelihoodAscent::remember() { remembered_.emplace(here()); }

bool LikelihoodAscent::return_to_remembered() { return remembered_ && return_to(Point(*remembered_)); }

bool LikelihoodAscent::return_to(const Point& point) {
  theta = point.theta;
  out.noise = point.noise;
  out.noise_fit = point.noise_fit;
  out.penalties = point.penalties;
  out.forced.set_force_time(out.noise.force_time);
  remembered_.emplace(point);
  if (!linearise()) return false;
  describe_noise();
  return true;
}

void LikelihoodAscent::describe_noise() {
  if (!out.noise_fit.at_bound.empty()) return;
  out.noise_fit = fit_noise(runs(), out.noise, {out.reference, threads_, 0});
  out.noise_fit.information = noise_information(runs(), out.noise_fit.logs, out.reference, threads_);
}

bool LikelihoodAscent::begin_with(const FilterNoise& noise) {
  const FilterNoise before = out.noise;
  out.noise = noise;
  out.forced.set_force_time(noise.force_time);
  if (linearise()) return true;
  out.noise = before;
  out.forced.set_force_time(before.force_time);
  linearise();
  return false;
}

double LikelihoodAscent::reached() const { return remembered_ ? remembered_->objective : -std::numeric_limits<double>::infinity(); }

void LikelihoodAscent::iterate(int most, double tolerance) {
  out.converged = false;
  for (int k = 0; k < most; ++k) {
    const double before = objective;
    const bool choosing = any_chosen(out.penalties);
    const double edf = out.edf;
    const double not_gained = gauss_newton_step();
    try_noise(fit_noise(runs(), out.noise, {out.reference, threads_, k < 3 ? 3 : kRefinements}));
    report_iteration(++iterations_, "log-likelihood", out.loglik);
    const bool settled = !choosing || std::abs(out.edf - edf) < 0.05;
    if (k > 0 && settled && std::abs(objective - before) < tolerance) {
      out.converged = not_gained < kDecrementOfOneSigma;
      return;
    }
  }
}

Eigen::VectorXd LikelihoodAscent::joint() const { return joined(theta, out.noise_fit.logs); }

std::optional<double> LikelihoodAscent::joint_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& inverse,
                                                   const Eigen::VectorXd& slope) {
  const BoxBounds bounds = joint_bounds();
  const Eigen::VectorXd here = joint(), newton = inverse * gradient;
  const BoundedMaximum there = maximum_inside(here + newton, inverse, bounds.lower, bounds.upper);
  const Eigen::VectorXd step = there.at - here;
  const double promised = 0.5 * gradient.dot(newton) - there.below;
  out.newton_decrement = promised;
  if (promised < least_gain) return std::nullopt;
  const auto gain = [&](double share) { return gain_at(bounds.nearest(here + share * step), slope); };
  constexpr double shortest = 0.005;  // at a kink of the likelihood only a short step rises
  double share = 1.0, gained = gain(share);
  while (!(gained > 0.0) && share > shortest) gained = gain(share *= 0.5);
  if (!(gained > 0.0)) return std::nullopt;
  constexpr double worth_lengthening = 1.2, longest = 256.0;  // of the promised gain; of the step
  for (double longer = 2.0; share >= 1.0 && gained > worth_lengthening * promised && longer <= longest; longer *= 2.0) {
    const double value = gain(longer);
    if (!(value > gained)) break;
    share = longer;
    gained = value;
  }
  return move_to(bounds.nearest(here + share * step)) ? std::optional(gained) : std::nullopt;
}

double LikelihoodAscent::gain_at(const Eigen::VectorXd& at, const Eigen::VectorXd& slope) const {
  const Eigen::Index n = theta.size();
  return objective_at(at.head(n), unpack({at.data() + n, at.data() + at.size()}, out.model.system->spec())) - objective +
         slope.dot((at - joint()).tail(slope.size()));
}

std::optional<double> LikelihoodAscent::axis_step(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& slope) {
  const BoxBounds bounds = joint_bounds();
  const Eigen::VectorXd here = joint();
  Eigen::VectorXd best = here;
  double most = least_gain;
  const CorrelationAxes axes = correlation_axes(covariance);
  for (Eigen::Index a = 0; a < axes.along.cols(); ++a) {
    for (const double share : {1.0, -1.0, 0.25, -0.25, 0.05, -0.05}) {
      const Eigen::VectorXd at = bounds.nearest(here + share * axes.along.col(a));
      const double gain = gain_at(at, slope);
      if (!(gain > most)) continue;
      most = gain;
      best = at;
    }
  }
  if (best == here || !move_to(best)) return std::nullopt;
  return most;
}

std::string LikelihoodAscent::failure() const {
  const FilterTrace& trace = out.traces[failed_experiment_];
  const Signals& signals = *out.data[failed_experiment_].signals;
  return "filter diverged: non-finite state at t = " + format_value(signals.t[trace.failed_at]) + " s of experiment '" + signals.name + "'";
}

}  // namespace misfit
