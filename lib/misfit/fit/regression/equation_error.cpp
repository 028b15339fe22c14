#include "misfit/fit/regression/equation_error.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/core/watch.h"
#include "misfit/data/estimators.h"
#include "misfit/inference/coloured.h"
#include "misfit/inference/curve_freedom.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/driven.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/own_clocks.h"
#include "misfit/inference/short_record.h"
#include "misfit/math/bounded.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// The states for which there is an equation to regress: shown by a channel, and their rate is not just another state (as that of a
/// position is its velocity).
std::vector<int> dynamic_states(const Model& model, const std::vector<bool>& shown) {
  std::vector<int> rows;
  const auto& states = model.system->spec().states;
  for (std::size_t j = 0; j < states.size(); ++j) {
    const bool kinematic = std::any_of(states.begin(), states.end(), [&](const StateSpec& s) { return s.rate_of == static_cast<int>(j); });
    if (!kinematic && shown[j]) rows.push_back(static_cast<int>(j));
  }
  return rows;
}

/// "the state x, v": those of the system that no channel shows; empty if there are none.
std::string hidden_states(const Model& model, const std::vector<bool>& shown) {
  std::string names;
  const auto& states = model.system->spec().states;
  for (std::size_t j = 0; j < states.size(); ++j) {
    if (!shown[j]) names += (names.empty() ? "the state " : ", ") + states[j].name;
  }
  return names;
}

/// Samples that the regression uses. Where a zero-order-hold input steps, the rate of a state jumps, and the polynomial through
/// neighbouring samples, from which the derivative is read, rounds that jump off. So the samples at a step and beside it are left out (of
/// sensors with clocks of their own also those within two steps of the fastest). Where that would leave out more than half, since the input
/// steps at nearly every sample, all are used and the derivatives are said to be smoothed.
struct UsableSamples {
  std::vector<bool> usable;
  bool smoothed = false;
};

UsableSamples usable_samples(const Model& model, const Signals& signals) {
  const auto& inputs = model.system->spec().inputs;
  const std::vector<std::string> needed = model.needed_inputs();
  const std::size_t n = signals.samples();
  UsableSamples out{std::vector<bool>(n, true)};
  const double reach = have_own_clocks(signals) ? 2.0 * step_of_measurements(signals) : 0.0;
  for (std::size_t k = 0; k < inputs.size() && k < signals.inputs.size(); ++k) {
    if (inputs[k].hold != Hold::zero_order || std::find(needed.begin(), needed.end(), inputs[k].name) == needed.end()) continue;
    const std::vector<double>& u = signals.inputs[k].values;
    for (std::size_t i = 1; i < n; ++i) {
      if (u[i] == u[i - 1]) continue;
      for (std::size_t at = i - 1; at <= std::min(i + 1, n - 1); ++at) out.usable[at] = false;
      for (std::size_t at = i; at-- > 0 && signals.t[i] - signals.t[at] < reach;) out.usable[at] = false;
      for (std::size_t at = i + 1; at < n && signals.t[at] - signals.t[i] < reach; ++at) out.usable[at] = false;
    }
  }
  const std::size_t left = std::count(out.usable.begin(), out.usable.end(), true);
  if (2 * left >= n) return out;
  return {std::vector<bool>(n, true), true};
}

struct Regression {
  NormalEquations sums;
  std::vector<std::vector<double>> residuals;  ///< per experiment and row, NaN where not used
  std::vector<ResidualRows> rows;              ///< per experiment, if asked for; a row's channel is its place among the dynamic states
};

class Regressor {
 public:
  Regressor(const Model& model, const std::vector<Signals>& experiments) : experiments_(experiments) {
    for (const auto& experiment : experiments) {
      states_.push_back(reconstruct_states(model, experiment));
      inputs_.push_back(input_table(experiment, model));
      usable_.push_back(usable_samples(model, experiment));
    }
    rows_ = dynamic_states(model, states_.front().shown);
  }
  const std::vector<int>& rows() const { return rows_; }
  const std::vector<Signals>& experiments() const { return experiments_; }
  const std::vector<ReconstructedStates>& states() const { return states_; }
  /// The first experiment whose states are known at some sample; nullopt if there is none.
  std::optional<std::size_t> first_known() const {
    for (std::size_t e = 0; e < states_.size(); ++e) {
      if (std::find(states_[e].ok.begin(), states_[e].ok.end(), true) != states_[e].ok.end()) return e;
    }
    return std::nullopt;
  }
  bool smoothed_at_steps() const {
    return std::any_of(usable_.begin(), usable_.end(), [](const UsableSamples& u) { return u.smoothed; });
  }

  Regression linearise(const Model& at, bool keep_rows = false) const {
    Regression out;
    Evaluator evaluator(at);
    const int columns = evaluator.columns();
    out.sums.N = Eigen::MatrixXd::Zero(columns, columns);
    out.sums.g = Eigen::VectorXd::Zero(columns);
    out.sums.theta = at.theta();
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      if (keep_rows) out.rows.push_back(empty_rows(e, columns));
      add(e, evaluator, out);
    }
    return out;
  }

 private:
  ResidualRows empty_rows(std::size_t e, int columns) const {
    const auto rows = static_cast<Eigen::Index>(experiments_[e].samples() * rows_.size());
    ResidualRows out{RowMatrix::Zero(rows, columns), Eigen::VectorXd::Constant(rows, std::nan("")), {}};
    for (Eigen::Index c = 0; c < columns; ++c) out.place.push_back(c);
    return out;
  }

  void add(std::size_t e, Evaluator& evaluator, Regression& out) const {
    const Signals& signals = experiments_[e];
    const ReconstructedStates& states = states_[e];
    const int n = evaluator.states();
    std::vector<double> D(n * kRowStride), dx(n);
    Slots slots;
    for (std::size_t channel = 0; channel < rows_.size(); ++channel) {
      const int row = rows_[channel];
      std::vector<double> residuals(signals.samples(), std::nan(""));
      for (std::size_t i = signals.exclude; i < signals.samples(); ++i) {
        look_at_watch();
        if (!states.ok[i] || signals.held_out(i) || !usable_[e].usable[i]) continue;
        slots.clear();
        evaluator.linearise_rates({states.x.row(i).data(), inputs_[e].at(i), signals.t[i]}, slots, dx.data(), D.data());
        const double r = dx[row] - states.dx(i, row);
        if (!std::isfinite(r)) continue;
        residuals[i] = r;
        const double* d = D.data() + row * kRowStride + n;
        if (out.rows.size() > e) {
          const Eigen::Index at = i * rows_.size() + channel;
          out.rows[e].r[at] = r;
          for (int a = 0; a < slots.count(); ++a) out.rows[e].J(at, slots.column(a)) = d[a];
        }
        for (int a = 0; a < slots.count(); ++a) {
          out.sums.g[slots.column(a)] += d[a] * r;
          for (int b = 0; b < slots.count(); ++b) out.sums.N(slots.column(a), slots.column(b)) += d[a] * d[b];
        }
        out.sums.rss += r * r;
        out.sums.count += 1.0;
      }
      out.residuals.push_back(std::move(residuals));
    }
  }

  const std::vector<Signals>& experiments_;
  std::vector<ReconstructedStates> states_;
  std::vector<InputTable> inputs_;
  std::vector<UsableSamples> usable_;
  std::vector<int> rows_;
};

/// Very wide priors (regularised_priors_about() the present point), so that N can be inverted. They are wide compared with the standard
/// errors, for which the variance of the residuals is needed: that at the minimum of the quadratic about this point,
/// (rss - g' N^-1 g)/count.
ColumnPriors very_wide_beside(const NormalEquations& sums, const Model& model, const std::vector<Penalty>& penalties) {
  constexpr double rounding = 1e-12;
  const Eigen::VectorXd information = sums.N.diagonal();
  Eigen::MatrixXd N = sums.N;
  N.diagonal() += rounding * information + Eigen::VectorXd::Constant(information.size(), std::numeric_limits<double>::min());
  const double left = sums.rss - sums.g.dot(symmetric_solve(N, sums.g)), variance = left / std::max(sums.count, 1.0);
  const bool usable = variance > 0.0 && std::isfinite(variance);
  return regularised_priors_about(sums.theta, model, penalties, usable ? Eigen::MatrixXd(sums.N / variance) : sums.N);
}

/// Maximum of the penalised Gaussian inside the bounds of the parameters. Coefficients of curves have none here: their roughness penalty
/// keeps them in place.
Eigen::VectorXd inside_bounds(const Model& model, const std::vector<int>& free, const PenalisedFit& smoothed) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(smoothed.theta.size(), -infinite), upper = -lower;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    if (p.curve >= 0) continue;
    lower[c] = p.lower;
    upper[c] = p.upper;
  }
  return maximum_inside(smoothed.theta, smoothed.covariance, lower, upper).at;
}

/// Gauss-Newton iterations. The equations are linear in strengths and curves, so that without shapes the first one is the answer; shapes
/// need the others. False, with status and message, where there is no answer.
bool solve(const Regressor& regressor, FittedModel& out, PenalisedFit& smoothed) {
  const std::vector<int> free = out.model.free_parameters();
  constexpr int rounds = 12;
  constexpr double converged_step = 1e-2;  // of a sigma
  bool settled = false;
  for (int round = 0; round < rounds && !settled; ++round) {
    Regression regression = regressor.linearise(out.model);
    ++out.fit.linearisations;
    regression.sums.prior = very_wide_beside(regression.sums, out.model, out.penalties);
    if (regression.sums.count < 2.0 * static_cast<double>(free.size()) || free.empty()) {
      out.fit.status = FitStatus::declined;
      out.fit.message = free.empty() ? "every parameter is fixed: there is nothing to estimate"
                                     : "only " + std::to_string(static_cast<long>(regression.sums.count)) + " usable samples for " +
                                           std::to_string(free.size()) + " unknowns";
      return false;
    }
    smoothed = estimate_smoothing(regression.sums, out.penalties);
    if (!smoothed.ok) break;
    const Eigen::VectorXd there = inside_bounds(out.model, free, smoothed);
    const Eigen::VectorXd sigma = smoothed.covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
    settled = round > 0 && (there - regression.sums.theta).cwiseQuotient(sigma).cwiseAbs().maxCoeff() < converged_step;
    out.model.set_theta(there);
  }
  out.fit.status = !smoothed.ok ? FitStatus::failed : settled ? FitStatus::converged : FitStatus::not_converged;
  out.fit.message = !smoothed.ok ? "the regression is singular: some coefficients are not determined by these data"
                    : settled    ? "regression solved"
                                 : "no convergence after " + std::to_string(rounds) + " iterations: a shape parameter is not identifiable";
  return smoothed.ok;
}

/// Columns of the parameters that end at a bound.
std::vector<Eigen::Index> at_bounds(const Model& model) {
  std::vector<Eigen::Index> out;
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    if (p.curve < 0 && (p.value == p.lower || p.value == p.upper)) out.push_back(static_cast<Eigen::Index>(c));
  }
  return out;
}

/// Where bounds hold parameters, `smoothed` is the maximum without them, whose residuals are smaller than those of the estimate: the
/// variance is taken from the estimate's own, with the effective parameters of those that no bound holds.
void take_variance_inside_bounds(const Regressor& regressor, const FittedModel& out, PenalisedFit& smoothed) {
  const std::vector<Eigen::Index> held = at_bounds(out.model);
  if (held.empty()) return;
  NormalEquations here = regressor.linearise(out.model).sums;
  here.prior = very_wide_beside(here, out.model, out.penalties);
  NormalEquations others = here;
  for (const Eigen::Index c : held) {
    others.N.row(c).setZero();
    others.N.col(c).setZero();
    others.g[c] = 0.0;
  }
  std::vector<Penalty> penalties = with_fixed_weights(out.penalties);
  const PenalisedFit of_others = estimate_smoothing(others, penalties);
  if (!of_others.ok) return;
  const double sigma2 = std::max(here.rss / std::max(here.count - of_others.edf, 1.0), 1e-300);
  const PenalisedFit inside = estimate_smoothing(here, penalties, sigma2);
  if (!inside.ok) return;
  smoothed = inside;
  smoothed.edf = of_others.edf;
}

std::vector<double> derivative(const ReconstructedStates& states, int state) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < states.dx.rows(); ++i) out.push_back(states.dx(i, state));
  return out;
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

/// Is the motion driven? From the residuals of the first equation of motion of the first experiment whose states are known, beside the
/// acceleration and what further noise of the measured size adds to them.
DrivenTest test_first_equation(const Regressor& regressor, const Regression& regression, const Model& model) {
  const std::size_t e = regressor.first_known().value_or(0);
  const Signals& signals = regressor.experiments()[e];
  const ReconstructedStates& states = regressor.states()[e];
  const int row = regressor.rows().front();
  const double frequency = motion_frequency(model, states);
  constexpr int usual_lags = 20, beyond_stencil = 5;
  const double half_period = frequency > 0.0 ? std::numbers::pi / frequency / usual_step(signals.t) : usual_lags;
  const std::vector<double> acceleration = derivative(states, row);
  const std::vector<double>& residual = regression.residuals[e * regressor.rows().size()];
  const auto of_noise = [&] {
    const std::vector<Signals> noisier{with_more_noise(model.system->spec(), signals)};
    return difference(Regressor(model, noisier).linearise(model).residuals.front(), residual);
  };
  return test_driven({.t = signals.t,
                      .residual = residual,
                      .acceleration = acceleration,
                      .of_noise = of_noise,
                      .half_period = static_cast<int>(half_period),
                      .stencil_reach = beyond_stencil});
}

void test_residuals(const Regressor& regressor, double sigma2, FittedModel& out) {
  const Regression regression = regressor.linearise(out.model);
  const DrivenTest test = test_first_equation(regressor, regression, out.model);
  out.fit.driven = test.driven();
  out.fit.driven_untested = !test.tested();
  out.fit.facts["whiteness"] = "equation " + in_words(test);
  const std::string unit = rate_unit(out.model.system->spec().states[regressor.rows().front()].unit);
  out.fit.noise["equation_residual"] = {std::sqrt(sigma2), 0.0, unit};
  const std::ptrdiff_t rows = regressor.rows().size();
  for (auto r = regression.residuals.begin(); r != regression.residuals.end(); r += rows) out.equation_residuals.emplace_back(r, r + rows);
}

/// Parameters, curves and trim with a covariance that allows for autocorrelated residuals; as plain sigmas, those for white residuals.
/// Returned: degrees of freedom, usable samples less the effective number of parameters.
double describe_estimates(const Regressor& regressor, const Regression& regression, const PenalisedFit& smoothed, FittedModel& out) {
  const double degrees = regression.sums.count - smoothed.edf;
  const ColouredCovariance coloured = residual_covariance(regression.rows, smoothed.covariance, regressor.rows().size(), degrees);
  const RowMatrix visited = visited_quantities(out.model, regressor.experiments(), regressor.states());
  out.plain_covariance = with_uncertain_roughness(regression.sums, out.penalties, smoothed.sigma2);
  describe(out.model, out.plain_covariance, visited, out.fit);
  keep_plain_sigmas(out.fit);
  describe(out.model, with_uncertain_roughness(regression.sums, out.penalties, smoothed.sigma2, coloured.excess), visited, out.fit);
  describe_roughness(out.model, roughness_paths(regression.sums, out.penalties, smoothed.sigma2), out.fit);
  describe_freedom(out.model, regression.sums, out.penalties, smoothed.sigma2, out.fit);
  out.fit.facts["covariance"] = in_words(coloured);
  if (degrees >= kFewestDegrees && degrees < kShortRecord) add_student_intervals(std::min(degrees, coloured.degrees), out.fit);
  return degrees;
}

void add_remarks(const Regressor& regressor, const NormalEquations& sums, double sigma2, FittedModel& out) {
  if (const std::optional<std::size_t> e = regressor.first_known()) {
    const ReconstructedStates& states = regressor.states()[*e];
    const Signals& first = regressor.experiments()[*e];
    const InputTable inputs = input_table(first, out.model);
    const std::size_t known = std::find(states.ok.begin(), states.ok.end(), true) - states.ok.begin();
    out.fit.warnings = scale_uncertainties(out.model, states.x.row(known).data(), inputs.at(known), first.t[known]);
  }
  if (regressor.smoothed_at_steps()) {
    out.fit.warnings.emplace_back(
        "an input steps at nearly every sample: the derivatives of this method smear what it does, so that its parameters are biased "
        "by more than their sigmas; methods that run the model are not");
  }
  if (const std::string which = undetermined_beside_priors(out.model, sums, sigma2); !which.empty()) out.fit.warnings.push_back(which);
  warn_of_collinearity(out.model, out.fit.covariance, out.fit);
  warn_of_other_trims(out.fit);
  reject_prior_conflicts(out.model, out.fit.covariance, out.fit);
}

void describe_all(const Regressor& regressor, const PenalisedFit& smoothed, FittedModel& out) {
  Regression regression = regressor.linearise(out.model, true);
  regression.sums.prior = very_wide_beside(regression.sums, out.model, out.penalties);
  const double weight = 1.0 / std::sqrt(smoothed.sigma2);
  for (ResidualRows& rows : regression.rows) {
    rows.J *= weight;
    rows.r *= weight;
  }
  const double degrees = describe_estimates(regressor, regression, smoothed, out);
  add_remarks(regressor, regression.sums, smoothed.sigma2, out);
  if (degrees < kFewestDegrees) {
    withhold_sigmas(format_value(regression.sums.count) + " usable samples for " + format_value(std::round(10.0 * smoothed.edf) / 10.0) +
                        " unknowns are too few to estimate the uncertainty of the values: no sigma is given",
                    out.fit);
  }
}

}  // namespace

FittedModel equation_error(const Model& model, const std::vector<Signals>& experiments) {
  const Stopwatch clock;
  FittedModel out{{}, model, curve_penalties(model), {}};
  out.fit.method = estimators::equation_error.name;
  const Regressor regressor(model, experiments);
  if (regressor.rows().empty()) {
    out.fit.status = FitStatus::declined;
    out.fit.message = "the measured channels do not show the states of system '" + model.system->spec().key +
                      "' and their rates, so its equations cannot be regressed";
    return out;
  }
  if (const std::string hidden = hidden_states(model, regressor.states().front().shown); !hidden.empty()) {
    out.fit.status = FitStatus::declined;
    out.fit.message = "no channel shows " + hidden + " of system '" + model.system->spec().key + "', so its equations cannot be regressed";
    return out;
  }
  PenalisedFit smoothed;
  if (!solve(regressor, out, smoothed)) return out;
  take_variance_inside_bounds(regressor, out, smoothed);
  test_residuals(regressor, smoothed.sigma2, out);
  describe_all(regressor, smoothed, out);
  if (out.fit.driven) {
    out.fit.warnings.push_back(
        "the motion is driven (" + out.fit.facts["whiteness"] +
        "): on stationary driven motion the product of acceleration and rate telescopes, so the damping of this method is not informative");
    mark_not_informative(out.model, model.system->spec().damping_curve, "driven motion: the sum of acceleration times rate telescopes",
                         out.fit);
  }
  out.fit.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
