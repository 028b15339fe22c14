#include "misfit/fit/filter/likelihood_derivatives.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/jobs/work_queue.h"
#include "misfit/math/covariance.h"

namespace misfit {
namespace {

using Runs = std::vector<FilterTrace>;  ///< one per experiment

/// Runs at a point and, a step away, above and below it.
struct ThreeRuns {
  const Runs &here, &above, &below;
};

/// Per experiment the measurements whose log density departs from a straight line by more than `most` between the three runs.
std::vector<std::vector<std::size_t>> nonlinear_measurements(const std::vector<FilterData>& data, const ThreeRuns& runs, double most) {
  std::vector<std::vector<std::size_t>> out(data.size());
  for (std::size_t e = 0; e < data.size(); ++e) {
    for (std::size_t i = 0; i < data[e].use.size(); ++i) {
      if (data[e].use[i] != SampleRole::counted) continue;
      const double bend = log_density(runs.above[e], i) + log_density(runs.below[e], i) - 2.0 * log_density(runs.here[e], i);
      if (!(std::abs(bend) <= most)) out[e].push_back(i);
    }
  }
  return out;
}

/// Whitened derivatives of innovations (first half) and of variances (second half) of the counted measurements, all experiments in order.
void fill_whitened(const std::vector<FilterData>& data, const ThreeRuns& runs, double span, Eigen::Ref<Eigen::VectorXd> column) {
  const Eigen::Index rows = column.size() / 2;
  const double per_step = 1.0 / span;
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < data.size(); ++e) {
    const FilterTrace &above = runs.above[e], &below = runs.below[e];
    for (std::size_t i = 0; i < data[e].use.size(); ++i) {
      if (data[e].use[i] != SampleRole::counted) continue;
      const double S = runs.here[e].S[i];
      column[row] = (above.departure(i) - below.departure(i)) * per_step / std::sqrt(S);
      column[rows + row++] = (above.variance(i) - below.variance(i)) * per_step / (std::numbers::sqrt2 * S);
    }
  }
}

/// Runs on both sides of the estimate, a step `h` away, with their log-likelihoods (not finite where the model cannot be run).
struct Pair {
  double h = 0.0, plus = 0.0, minus = 0.0;
  Runs above, below;
};

struct OneDerivative {
  bool finite = false;  ///< a run beside succeeded
  bool smooth = true;   ///< few measurements are nonlinear
  double slope = 0.0;
  std::vector<std::vector<std::size_t>> nonlinear;
};

/// Central differences; each fills its column of the whitened derivatives.
class Differences {
 public:
  Differences(const FilterEstimate& estimate, const Eigen::VectorXd& theta)
      : estimate_(estimate), theta_(theta), objective_(estimate), here_(estimate.loglik), axes_(correlation_axes(estimate.covariance)) {}

  /// Where more than a tenth of all measurements is nonlinear the step is too long, not the run nonlinear: the axis of a combination that
  /// is hardly determined is long, and straight for a part of it only. Then a shorter one, up to five times.
  OneDerivative along_axis(Eigen::Index i, const Eigen::Ref<Eigen::VectorXd>& column) const {
    constexpr double shortening = 0.2, most_nonlinear = 0.1;  // of the measurements
    constexpr int most_steps = 5;
    const double measurements = 0.5 * static_cast<double>(column.size());  // a column holds innovations and variances
    OneDerivative out;
    double h = longest;
    for (int k = 0; k < most_steps; ++k, h *= shortening) {
      out = with_step(h * axes_.along.col(i), h, column);
      std::size_t nonlinear = 0;
      for (const auto& experiment : out.nonlinear) nonlinear += experiment.size();
      out.smooth = static_cast<double>(nonlinear) <= most_nonlinear * measurements;
      if (out.finite && out.smooth) break;
    }
    return out;
  }

  [[nodiscard]] const CorrelationAxes& axes() const { return axes_; }

  /// To one side; `information`: minus the second derivatives of the log-likelihood over parameters and noise, about.
  OneDerivative upwards(Eigen::Index i, const Eigen::MatrixXd& information, const Eigen::Ref<Eigen::VectorXd>& column) const {
    const Eigen::Index n = theta_.size();
    Pair pair;
    pair.above.resize(estimate_.data.size());
    pair.minus = -std::numeric_limits<double>::infinity();
    double curvature = 0.0;
    if (i < n) {
      const auto along = axes_.along.col(i);
      pair.h = longest;
      curvature = along.dot(information.topLeftCorner(n, n) * along);
      pair.plus = objective_.loglik_at(theta_ + pair.h * along, estimate_.noise, &pair.above);
    } else {
      pair.h = noise_step;
      curvature = information(i, i);
      pair.plus = loglik_with_noise(i - n, pair.h, pair.above);
    }
    OneDerivative out = between(pair, column);
    out.slope += 0.5 * pair.h * curvature;
    return out;
  }

  OneDerivative by_noise(Eigen::Index i, const Eigen::Ref<Eigen::VectorXd>& column) const {
    Pair pair{.h = noise_step, .above = Runs(estimate_.data.size()), .below = Runs(estimate_.data.size())};
    pair.plus = loglik_with_noise(i, pair.h, pair.above);
    pair.minus = loglik_with_noise(i, -pair.h, pair.below);
    return between(pair, column);
  }

 private:
  double loglik_with_noise(Eigen::Index i, double step, Runs& runs) const {
    std::vector<double> logs = estimate_.noise_fit.logs;
    logs[i] += step;
    return objective_.loglik_at(theta_, unpack(logs, estimate_.model.system->spec()), &runs);
  }

  OneDerivative with_step(const Eigen::VectorXd& step, double h, const Eigen::Ref<Eigen::VectorXd>& column) const {
    Pair pair{.h = h, .above = Runs(estimate_.data.size()), .below = Runs(estimate_.data.size())};
    pair.plus = objective_.loglik_at(theta_ + step, estimate_.noise, &pair.above);
    pair.minus = objective_.loglik_at(theta_ - step, estimate_.noise, &pair.below);
    OneDerivative out = between(pair, column);
    out.nonlinear.resize(estimate_.data.size());
    constexpr double most_curved = 0.05;  // of a log density
    if (std::isfinite(pair.plus) && std::isfinite(pair.minus))
      out.nonlinear = nonlinear_measurements(estimate_.data, {estimate_.traces, pair.above, pair.below}, most_curved * h / longest);
    return out;
  }

  OneDerivative between(const Pair& pair, Eigen::Ref<Eigen::VectorXd> column) const {
    column.setZero();
    const bool up = std::isfinite(pair.plus), down = std::isfinite(pair.minus);
    if (!up && !down) return {};
    const double span = (up ? pair.h : 0.0) + (down ? pair.h : 0.0);
    const Runs& here = estimate_.traces;
    fill_whitened(estimate_.data, {here, up ? pair.above : here, down ? pair.below : here}, span, column);
    return {true, true, ((up ? pair.plus : here_) - (down ? pair.minus : here_)) / span, {}};
  }

  static constexpr double longest = 0.05, noise_step = 1e-3;

  const FilterEstimate& estimate_;
  const Eigen::VectorXd& theta_;
  ExactObjective objective_;
  double here_;
  CorrelationAxes axes_;
};

std::string failure_of(const std::vector<OneDerivative>& parts) {
  const auto torn = std::count_if(parts.begin(), parts.end(), [](const OneDerivative& part) { return !part.finite; });
  const auto nonlinear = std::count_if(parts.begin(), parts.end(), [](const OneDerivative& part) { return !part.smooth; });
  const std::string of = " of " + std::to_string(parts.size()) + " directions";
  if (torn > 0) return "in " + std::to_string(torn) + of + " the filter diverges for small parameter changes";
  if (nonlinear > 0)
    return "in " + std::to_string(nonlinear) + of + " the filter's linearisation is not valid for more than a tenth of the measurements";
  return {};
}

Eigen::Index counted_measurements(const FilterEstimate& estimate) {
  std::ptrdiff_t sum = 0;
  for (const auto& data : estimate.data) sum += std::count(data.use.begin(), data.use.end(), SampleRole::counted);
  return sum;
}

}  // namespace

double log_density(const FilterTrace& trace, std::size_t place) {
  if (!(trace.S[place] > 0.0)) return 0.0;
  return -trace.minus_log_density(place);
}

double ExactObjective::at(const Eigen::VectorXd& theta, const FilterNoise& noise) const {
  return loglik_at(theta, noise) + estimate_->prior().log_density(theta) +
         log_prior(noise, estimate_->model.system->spec(), estimate_->reference);
}

double ExactObjective::loglik_at(const Eigen::VectorXd& theta, const FilterNoise& noise, std::vector<FilterTrace>* traces) const {
  FilterModel forced = estimate_->forced;
  forced.set_force_time(noise.force_time);
  FilterRunner runner(forced, false);
  runner.set_parameters(forced.model.values_at(theta));
  double sum = 0.0;
  std::vector<FilterTrace> own(traces == nullptr ? estimate_->data.size() : 0);
  std::vector<FilterTrace>& runs = traces != nullptr ? *traces : own;
  for (std::size_t e = 0; e < estimate_->data.size(); ++e) {
    if (!runner.run(estimate_->data[e], noise, runs[e], {.held_out = estimate_->whole_runs}))
      return -std::numeric_limits<double>::infinity();
    sum += runs[e].loglik;
  }
  return sum;
}

LikelihoodDerivatives exact_derivatives(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads,
                                        const LikelihoodDerivatives* near) {
  const std::size_t n = theta.size();
  if (n > 0 && estimate.covariance.size() == 0) return {{}, {}, {}, "the information matrix cannot be inverted"};
  const Differences differences(estimate, theta);
  std::vector<OneDerivative> parts(n + estimate.noise_fit.logs.size());
  Eigen::MatrixXd columns(2 * counted_measurements(estimate), parts.size());
  run_jobs(parts.size(), threads, [&](std::size_t i) {
    auto column = columns.col(i);
    if (near != nullptr) {
      parts[i] = differences.upwards(i, near->information, column);
      return;
    }
    parts[i] = i < n ? differences.along_axis(i, column) : differences.by_noise(i - n, column);
  });
  LikelihoodDerivatives out{Eigen::VectorXd(columns.cols()), Eigen::MatrixXd::Zero(columns.cols(), columns.cols()),
                            std::vector<std::vector<std::size_t>>(estimate.data.size()), failure_of(parts)};
  if (!out.failure.empty()) return out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out.gradient[i] = parts[i].slope;
    for (std::size_t e = 0; e < parts[i].nonlinear.size(); ++e)
      out.nonlinear[e].insert(out.nonlinear[e].end(), parts[i].nonlinear[e].begin(), parts[i].nonlinear[e].end());
  }
  const Eigen::MatrixXd& back = differences.axes().back;
  columns.leftCols(theta.size()) = columns.leftCols(theta.size()) * back;
  out.information.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  out.information = Eigen::MatrixXd(out.information.selfadjointView<Eigen::Lower>());
  const GaussianPrior prior{regularised_priors_about(theta, estimate.model, estimate.penalties, out.information), estimate.penalties};
  out.gradient.head(theta.size()) = back.transpose() * out.gradient.head(theta.size()).eval() + prior.gradient(theta);
  const NoiseVector noise = pack(estimate.noise, estimate.model.system->spec(), estimate.reference);
  out.gradient.tail(std::ssize(noise.value)) +=
      noise.prior.gradient(Eigen::Map<const Eigen::VectorXd>(noise.value.data(), std::ssize(noise.value)));
  for (auto& nonlinear : out.nonlinear) {
    std::sort(nonlinear.begin(), nonlinear.end());
    nonlinear.erase(std::unique(nonlinear.begin(), nonlinear.end()), nonlinear.end());
  }
  return out;
}

Eigen::MatrixXd joint_information(const FilterEstimate& estimate, const LikelihoodDerivatives& exact) {
  Eigen::MatrixXd out = exact.information;
  out.diagonal() += regularised_priors(estimate.model, out.diagonal()).padded(out.rows()).precision;
  const NoiseVector noise = pack(estimate.noise, estimate.model.system->spec(), estimate.reference);
  out.diagonal().tail(std::ssize(noise.value)) += noise.prior.precision;
  pin_unknown(estimate.noise_fit, out);
  return out;
}

}  // namespace misfit
