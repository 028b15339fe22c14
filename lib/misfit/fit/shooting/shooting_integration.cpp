// How whole runs are integrated, and what the error of that does.

#include <algorithm>
#include <cmath>

#include "misfit/fit/shooting/shooting.h"

namespace misfit {

void Shooting::run_histories() {
  constexpr double tolerance = 1e-6;
  set_theta(model_.theta().data());
  for (std::size_t e = 0; e < inputs_.size(); ++e) {
    InputTable inputs = inputs_[e];
    const Eigen::VectorXd x0 = initial_state(e);
    inputs.plan = plan_run({*stepper_, experiments_[e], inputs}, x0.data(), tolerance);
    const RowMatrix states = run_states({*stepper_, experiments_[e], inputs}, {0, experiments_[e].samples(), x0.data()});
    if (states.rows() == history_[e].rows()) history_[e] = states;
  }
}

void Shooting::plan(double tolerance) {
  set_theta(model_.theta().data());
  for (std::size_t e = 0; e < inputs_.size(); ++e)
    inputs_[e].plan = plan_along({*stepper_, experiments_[e], inputs_[e]}, history_[e], tolerance);
}

std::optional<std::vector<RowMatrix>> Shooting::outputs(bool halved) {
  set_theta(model_.theta().data());
  std::vector<RowMatrix> out;
  Segment run;
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    InputTable inputs = inputs_[e];
    if (halved) inputs.plan = refined(inputs.plan);
    const Eigen::VectorXd x0 = initial_state(e);
    run_segment({*stepper_, experiments_[e], inputs}, {0, experiments_[e].samples(), x0.data()}, run);
    if (!run.finite) return std::nullopt;
    out.push_back(run.y);
  }
  return out;
}

Shooting::ErrorSize Shooting::size_of(const std::vector<RowMatrix>& errors, const std::vector<RowMatrix>& outputs) const {
  ErrorSize worst;
  for (std::size_t e = 0; e < errors.size(); ++e) {
    for (Eigen::Index o = 0; o < errors[e].cols(); ++o) {
      double error = 0.0, residual = 0.0, count = 0.0;
      for (Eigen::Index i = 0; i < errors[e].rows(); ++i) {
        if (!counts(e, i, o)) continue;
        error += std::pow(errors[e](i, o), 2);
        residual += std::pow(outputs[e](i, o) - experiments_[e].measured[o].values[i], 2);
        count += 1.0;
      }
      const double scale = 1.0 / (sigma_[o] * std::sqrt(std::max(count, 1.0)));
      if (std::sqrt(error) * scale > worst.error) worst = {std::sqrt(error) * scale, std::sqrt(residual) * scale};
    }
  }
  return worst;
}

Eigen::VectorXd Shooting::shift_by(const std::vector<RowMatrix>& errors, const std::vector<Segment>& runs,
                                   const Eigen::MatrixXd& covariance) const {
  const Eigen::Index columns = free_.size(), n = model_.states();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(covariance.rows());
  for (std::size_t e = 0; e < errors.size(); ++e) {
    const Eigen::Index start = columns + n * e;
    for (Eigen::Index i = 0; i < errors[e].rows(); ++i) {
      for (Eigen::Index o = 0; o < errors[e].cols(); ++o) {
        if (!counts(e, i, o)) continue;
        const double weighted = errors[e](i, o) / (sigma_[o] * sigma_[o]);
        const auto row = runs[e].y_rows.row(i * errors[e].cols() + o);
        gradient.head(columns) += weighted * row.head(columns).transpose();
        gradient.segment(start, n) += weighted * row.tail(n).transpose();
      }
    }
  }
  return -covariance * gradient;
}

}  // namespace misfit
