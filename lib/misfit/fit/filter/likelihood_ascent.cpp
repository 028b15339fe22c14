#include "misfit/fit/filter/likelihood_ascent.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"
#include "misfit/fit/filter/filter_start.h"
#include "misfit/fit/filter/likelihood_derivatives.h"
#include "misfit/math/bounded.h"

namespace misfit {
namespace {

struct Box {
  Eigen::VectorXd lower, upper;
};

Box bounds_of(const Model& model, const std::vector<int>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Box box{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index c = 0; c < n; ++c) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(c)])];
    box.lower[c] = p.lower;
    box.upper[c] = p.upper;
  }
  return box;
}

Eigen::VectorXd joined(const Eigen::VectorXd& a, const std::vector<double>& b) {
  Eigen::VectorXd both(a.size() + static_cast<Eigen::Index>(b.size()));
  both << a, Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
  return both;
}

}  // namespace

LikelihoodAscent::LikelihoodAscent(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                                   const FilterOptions& options)
    : threads_(options.threads) {
  out.model = start;
  out.penalties = std::move(penalties);
  if (!options.choose_roughness) {
    for (auto& penalty : out.penalties) penalty.chosen = false;
  }
  out.forced = with_random_force(start);
  for (const auto& experiment : experiments) out.data.push_back(filter_data(out.forced, experiment, options.integration));
  if (options.use) {
    for (std::size_t e = 0; e < out.data.size(); ++e) out.data[e].use = (*options.use)[e];
  }
  free = start.free_parameters();
  theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
  for (std::size_t c = 0; c < free.size(); ++c)
    theta[static_cast<Eigen::Index>(c)] = start.parameters[static_cast<std::size_t>(free[c])].value;
  out.around = options.around ? *options.around : usual_noise(out.forced, out.data);
  out.noise = options.noise ? *options.noise : out.around;
  set_time();
}

void LikelihoodAscent::set_time() {
  out.forced.model.parameters[static_cast<std::size_t>(out.forced.time_parameter)].value = out.noise.force_time;
}

std::vector<double> LikelihoodAscent::values() const {
  std::vector<double> all = out.forced.model.values();
  for (std::size_t c = 0; c < free.size(); ++c) all[static_cast<std::size_t>(free[c])] = theta[static_cast<Eigen::Index>(c)];
  return all;
}

bool LikelihoodAscent::linearise() {
  out.traces.resize(out.data.size());
  out.jacobians.resize(out.data.size());
  FilterRunner runner(out.forced, true);
  runner.set_parameters(values());
  double loglik = 0.0;
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    if (!runner.run(out.data[e], out.noise, out.traces[e], &out.jacobians[e])) {
      failed_experiment_ = e;
      return false;
    }
    loglik += out.traces[e].loglik;
  }
  ++out.linearisations;
  out.loglik = loglik;
  objective = loglik + log_prior_at(out.model, out.penalties, theta);
  return true;
}

bool LikelihoodAscent::plan(double tolerance) {
  bool another = false;
  Stepper stepper(out.forced.model);
  stepper.evaluator().set_parameters(values().data());
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    const FilterTrace& trace = out.traces[e];
    FilterData& data = out.data[e];
    const auto samples = static_cast<Eigen::Index>(trace.samples);
    const Eigen::Map<const RowMatrix> predicted(trace.predicted.data(), samples, trace.n), moved(trace.correction.data(), samples, trace.n);
    RowMatrix states = predicted + moved;
    const auto first = static_cast<Eigen::Index>(data.first);
    states.topRows(first).rowwise() = states.row(first).eval();
    IntegrationPlan plan = plan_along(stepper, *data.signals, data.inputs, states, tolerance);
    another = another || plan.parts != data.inputs.plan.parts || plan.first != data.inputs.plan.first;
    data.inputs.plan = std::move(plan);
  }
  return another;
}

double LikelihoodAscent::integration_shift() const {
  FilterRunner runner(out.forced, false);
  runner.set_parameters(values());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(theta.size());
  FilterTrace trace;
  for (std::size_t e = 0; e < out.data.size(); ++e) {
    FilterData finer = out.data[e];
    finer.inputs.plan = refined(finer.inputs.plan);
    if (!runner.run(finer, out.noise, trace)) return 0.0;
    const FilterJacobian& jacobian = out.jacobians[e];
    Eigen::VectorXd change = -jacobian.r;
    for (Eigen::Index r = 0; r < change.size(); ++r) {
      const std::size_t at = jacobian.index[static_cast<std::size_t>(r)];
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
  return ExactObjective(out, free).at(there, noise);
}

NormalEquations LikelihoodAscent::normal_equations() const {
  NormalEquations sums;
  const Eigen::Index n = theta.size();
  sums.N = Eigen::MatrixXd::Zero(n, n);
  sums.g = Eigen::VectorXd::Zero(n);
  sums.theta = theta;
  for (const auto& jacobian : out.jacobians) {
    sums.N.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.J.transpose());
    sums.g += jacobian.J.transpose() * jacobian.r;
    sums.rss += jacobian.r.squaredNorm();
    sums.count += static_cast<double>(jacobian.r.size());
  }
  sums.N = Eigen::MatrixXd(sums.N.selfadjointView<Eigen::Lower>());
  set_priors(out.model, sums);
  return sums;
}

double LikelihoodAscent::gauss_newton_step() {
  constexpr double nothing = 0.0, unknown = std::numeric_limits<double>::infinity();
  if (free.empty()) return nothing;
  const PenalisedFit smoothed = estimate_smoothing(normal_equations(), out.penalties, 1.0);
  if (!smoothed.ok) return unknown;
  out.edf = smoothed.edf;
  out.covariance = smoothed.covariance;
  objective = out.loglik + log_prior_at(out.model, out.penalties, theta);  // the roughness may have changed
  const auto [lower, upper] = bounds_of(out.model, free);
  const BoundedMaximum best = maximum_inside(smoothed.theta, smoothed.covariance, lower, upper);
  const Eigen::VectorXd step = best.at - theta;
  for (double share = 1.0; share > 0.05; share *= 0.4) {
    const Eigen::VectorXd there = theta + share * step;
    const double value = objective_at(there, out.noise);
    if (!(value > objective - 1e-6)) continue;
    const Eigen::VectorXd before = theta;
    theta = there;
    if (linearise()) return nothing;
    theta = before;
  }
  linearise();
  Eigen::MatrixXd precision;
  if (!invert_scaled(smoothed.covariance, precision)) return unknown;
  const Eigen::VectorXd newton = smoothed.theta - theta;
  return 0.5 * newton.dot(precision * newton) - best.below;
}

bool LikelihoodAscent::try_noise(const NoiseFit& fit) {
  const FilterNoise before = out.noise;
  const std::vector<double> logs = pack(before, out.model.system->spec(), out.around).value;
  const double then = objective;
  out.noise = fit.noise;
  out.noise_fit = fit;
  set_time();
  if (linearise() && objective > then - 1.0) return true;
  out.noise = before;
  out.noise_fit.logs = logs;
  set_time();
  linearise();
  return false;
}

bool LikelihoodAscent::move_to(const Eigen::VectorXd& there, const std::vector<double>& logs) {
  const Eigen::VectorXd theta_before = theta;
  const std::vector<double> logs_before = out.noise_fit.logs;
  const auto set = [&](const Eigen::VectorXd& parameters, const std::vector<double>& noise) {
    theta = parameters;
    out.noise_fit.logs = noise;
    out.noise = unpack(noise);
    set_time();
    return linearise();
  };
  if (set(there, logs)) return true;
  set(theta_before, logs_before);
  return false;
}

void LikelihoodAscent::iterate(int most, double tolerance) {
  out.converged = false;
  for (int k = 0; k < most; ++k) {
    const double before = objective;
    const bool choosing = std::any_of(out.penalties.begin(), out.penalties.end(), [](const Penalty& p) { return p.chosen; });
    const double edf = out.edf;
    const double in_vain = gauss_newton_step();
    try_noise(fit_noise(runs(), out.noise, out.around, threads_, k < 3 ? 3 : kRefinements));
    const bool settled = !choosing || std::abs(out.edf - edf) < 0.05;
    constexpr double as_a_sigma = 0.5;
    if (k > 0 && settled && std::abs(objective - before) < tolerance) {
      out.converged = in_vain < as_a_sigma;
      return;
    }
  }
}

Eigen::VectorXd LikelihoodAscent::joint() const { return joined(theta, out.noise_fit.logs); }

std::optional<double> LikelihoodAscent::joint_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& inverse,
                                                   const Eigen::VectorXd& slope, double enough) {
  const Eigen::Index n = theta.size();
  const NoiseVector noise = pack(out.noise, out.model.system->spec(), out.around);
  const auto [lower, upper] = bounds_of(out.model, free);
  const Eigen::VectorXd here = joint(), newton = inverse * gradient;
  const Eigen::VectorXd lowest = joined(lower, noise.lower), highest = joined(upper, noise.upper);
  const BoundedMaximum there = maximum_inside(here + newton, inverse, lowest, highest);
  const Eigen::VectorXd step = there.at - here;
  const double promised = 0.5 * gradient.dot(newton) - there.below;
  out.left = promised;
  if (promised < enough) return std::nullopt;
  const auto gain = [&](double share) {
    const Eigen::VectorXd at = (here + share * step).cwiseMax(lowest).cwiseMin(highest);
    return objective_at(at.head(n), unpack({at.data() + n, at.data() + at.size()})) - objective + slope.dot((at - here).tail(slope.size()));
  };
  constexpr double shortest = 0.005;  // at a kink of the likelihood only a short step rises
  double share = 1.0, gained = gain(share);
  while (!(gained > 0.0) && share > shortest) gained = gain(share *= 0.5);
  if (!(gained > 0.0)) return std::nullopt;
  constexpr double more = 1.2, furthest = 256.0;
  for (double longer = 2.0; share >= 1.0 && gained > more * promised && longer <= furthest; longer *= 2.0) {
    const double value = gain(longer);
    if (!(value > gained)) break;
    share = longer;
    gained = value;
  }
  const Eigen::VectorXd at = (here + share * step).cwiseMax(lowest).cwiseMin(highest);
  return move_to(at.head(n), {at.data() + n, at.data() + at.size()}) ? std::optional(gained) : std::nullopt;
}

std::string LikelihoodAscent::failure() const {
  const FilterTrace& trace = out.traces[failed_experiment_];
  const Signals& signals = *out.data[failed_experiment_].signals;
  return "filter diverged: non-finite state at t = " + format_value(signals.t[trace.failed_at]) + " s of experiment '" + signals.name + "'";
}

}  // namespace misfit
