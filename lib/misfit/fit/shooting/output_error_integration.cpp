#include "misfit/fit/shooting/output_error_integration.h"

#include <algorithm>
#include <limits>

namespace misfit::output_error_parts {
namespace {

std::vector<RowMatrix> difference(std::vector<RowMatrix> outputs, const std::vector<RowMatrix>& from) {
  for (std::size_t e = 0; e < outputs.size(); ++e) outputs[e] -= from[e];
  return outputs;
}

}  // namespace

Eigen::VectorXd in_sigmas(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance) {
  constexpr double least = 1e-300;
  return step.cwiseQuotient(covariance.diagonal().cwiseMax(least).cwiseSqrt());
}

double largest_in_sigmas(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance) {
  return in_sigmas(step, covariance).cwiseAbs().maxCoeff();
}

OutputErrorIntegration::OutputErrorIntegration(Shooting& shooting, const std::vector<Signals>& experiments, double tolerance, bool checked)
    : shooting_(shooting), experiments_(experiments), tolerance_(tolerance > 0.0 ? tolerance : kSearchTolerance), checked_(checked) {}

void OutputErrorIntegration::plan() { shooting_.plan(tolerance_); }

void OutputErrorIntegration::plan_for_whole_runs() {
  constexpr double of_the_noise = 0.2, of_the_residual = 0.03, small = 3.0, aim = 0.1, most_at_once = 1e-3;  // errors in sigma
  constexpr int most_refinements = 2;
  if (shooting_.plan_of(0).tolerance != tolerance_) shooting_.plan(tolerance_);
  if (!checked_) return;
  const double before = tolerance_;
  for (int k = 0;; ++k) {
    const auto [error, residual] = this->error();
    if (error < of_the_noise || error < of_the_residual * residual) return;
    if (k == most_refinements || tolerance_ <= kFinestTolerance) break;
    plan_anew(std::max(aim / error, most_at_once));
    if (error < small) return;  // it is judged at the estimate once more
  }
  tolerance_ = before;
  shooting_.plan(tolerance_);
}

Shooting::ErrorSize OutputErrorIntegration::error() {
  const auto coarse = shooting_.outputs(false), fine = shooting_.outputs(true);
  if (!coarse || !fine) return {std::numeric_limits<double>::infinity(), 0.0};
  return shooting_.size_of(difference(*fine, *coarse), *fine);
}

void OutputErrorIntegration::plan_anew(double ratio) {
  tolerance_ = finer_tolerance(plans(), ratio);
  shooting_.plan(tolerance_);
}

std::vector<IntegrationPlan> OutputErrorIntegration::plans() const {
  std::vector<IntegrationPlan> out;
  for (std::size_t e = 0; e < experiments_.size(); ++e) out.push_back(shooting_.plan_of(e));
  return out;
}

bool OutputErrorIntegration::negligible_at(const std::vector<Segment>& runs, const Eigen::MatrixXd& covariance) {
  constexpr double enough = 0.1, aim = 0.05;
  constexpr int most_plans = 4;
  if (!checked_) return true;
  judged_ = false;
  const auto coarse = shooting_.outputs(false), fine = shooting_.outputs(true);
  if (!coarse || !fine) return true;
  shift_ = largest_in_sigmas(shooting_.shift_by(difference(*fine, *coarse), runs, covariance), covariance);
  judged_ = !(shift_ > enough) || plans_ == most_plans || tolerance_ <= kFinestTolerance;
  if (judged_) return true;
  ++plans_;
  plan_anew(aim / shift_);
  return false;
}

bool OutputErrorIntegration::plan_finely() {
  constexpr double fine = 1e-7;
  if (tolerance_ <= fine) return false;
  judged_ = false;
  tolerance_ = fine;
  shooting_.plan(tolerance_);
  return true;
}

void OutputErrorIntegration::describe(FittedModel& out) const {
  out.integration = tolerance_;
  const std::vector<IntegrationPlan> used = plans();
  for (std::size_t e = 0; e < used.size(); ++e) {
    if (!used[e].lack.empty()) out.fit.warnings.push_back("experiment '" + experiments_[e].name + "': " + used[e].lack);
  }
  std::string& fact = out.fit.facts["integration"];
  fact = in_words(used, plans_);
  if (checked_) fact += judged_ ? in_words_of(shift_, tolerance_) : "; what its steps err by was not checked at the estimate";
}

}  // namespace misfit::output_error_parts
