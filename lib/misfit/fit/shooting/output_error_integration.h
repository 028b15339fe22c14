#pragma once

#include <vector>

#include "misfit/fit/shooting/shooting.h"
#include "misfit/inference/fitted_model.h"

// How finely output error integrates: not for use outside.
namespace misfit::output_error_parts {

/// A step, each unknown in its sigma; and the largest of them.
[[nodiscard]] Eigen::VectorXd in_sigmas(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance);
[[nodiscard]] double largest_in_sigmas(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance);

/// Plans the steps of the shooting's runs (sim/plan.h) and judges them against runs with half the steps.
class OutputErrorIntegration {
 public:
  /// `tolerance`: to begin with; 0: kSearchTolerance. `checked`: false for fits by the thousand, which go on with the plan of the one they
  /// are made about.
  OutputErrorIntegration(Shooting& shooting, const std::vector<Signals>& experiments, double tolerance, bool checked);

  void plan();
  /// A plan whose error whole runs show: halving its parts changes their outputs by little, beside the noise or beside what the model is
  /// still off. Where a finer plan or two do not bring that about, it is not the plan that keeps the model from following.
  void plan_for_whole_runs();
  /// A motion that the plan of a search cannot follow to the end may be followed by a finer one. False: it is as fine already.
  bool plan_finely();
  /// Does the integration's error move no estimate by more than a tenth of its sigma? If it does, it is planned anew. `runs`, `covariance`:
  /// with derivatives, and of all unknowns, at the present values.
  bool negligible_at(const std::vector<Segment>& runs, const Eigen::MatrixXd& covariance);
  /// By how much the error moves an estimate, at most [sigma], when it was last looked at.
  [[nodiscard]] double shift() const { return shift_; }
  /// What it costs and what its error does, into the fit.
  void describe(FittedModel& out) const;

 private:
  [[nodiscard]] Shooting::ErrorSize error();
  void plan_anew(double ratio);
  [[nodiscard]] std::vector<IntegrationPlan> plans() const;

  Shooting& shooting_;
  const std::vector<Signals>& experiments_;
  double tolerance_;
  bool checked_;
  double shift_ = 0.0;
  bool judged_ = false;  ///< shift_ is that of the plan in use, which stands
  int plans_ = 0;        ///< made at estimates
};

}  // namespace misfit::output_error_parts
