#pragma once

// References
//   [R]  C. R. Rao (1948); K. V. Mardia, R. J. Marshall, Biometrika 71 (1984): score tests in Gaussian likelihoods, V = I11 − I12 I22⁻¹
//   I21.

#include <Eigen/Dense>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

struct ScoreResult {
  double chi2 = 0.0;           ///< sᵀ V⁻¹ s: also the predicted drop, one Gauss–Newton step [R]
  int dof = 0;                 ///< rank of the columns' information, free parameters projected out
  Eigen::VectorXd amplitude;   ///< one Gauss–Newton step; 0 where unknown
  Eigen::VectorXd sigma;       ///< of each
  Eigen::MatrixXd covariance;  ///< of all
  double independent = 0.0;    ///< smallest 1 − R² of a column on the free ones: below 0.01 the model already describes it
};

/// Score tests for further columns of whitened derivatives with the estimate's free parameters projected out.
class ScoreTest {
 public:
  explicit ScoreTest(const FilterEstimate& estimate);

  [[nodiscard]] Eigen::Index rows() const { return r_.size(); }
  /// C: rows × columns, ∂(predicted − measured)/√S by each added coefficient at its off value. Amplitudes (not χ²) leave out combinations
  /// of columns whose 1 − R² on the free parameters' columns is below `least_share`: to be seen at all beside what the parameters make up
  /// for, they would have to be many times what acts.
  [[nodiscard]] ScoreResult test(const Eigen::MatrixXd& C, const ColumnPriors* priors = nullptr, double least_share = 0.0) const;
  /// Change of the free parameters in one joint Gauss–Newton step in which the added coefficients change from 0 to `amplitude`.
  [[nodiscard]] Eigen::VectorXd adjusted_step(const Eigen::MatrixXd& C, const Eigen::VectorXd& amplitude) const;
  /// C − J I22⁻¹ Jᵀ C: the part of the columns orthogonal to those of the free parameters (for correlations between candidates).
  [[nodiscard]] Eigen::MatrixXd projected(const Eigen::MatrixXd& C) const;

 private:
  RowMatrix J_;
  Eigen::VectorXd r_, gradient_;  ///< of log density with priors, by the free parameters
  Eigen::LDLT<Eigen::MatrixXd> information_;
  bool has_parameters_ = false;
};

/// Columns for what is given as functions of the filtered states: forces on dynamic ports, changes of parameters, errors of outputs,
/// changes of the rates of effects' own states.
class ForceSensitivity {
 public:
  /// A sample of an experiment, and its place among those of all.
  struct SamplePlace {
    std::size_t experiment = 0, sample = 0;
    Eigen::Index of_all = 0;
  };

  /// `parameters`: quantity ports of the system that columns are wanted for, too.
  explicit ForceSensitivity(const FilterEstimate& estimate, std::vector<int> parameters = {});

  /// Quantities at the filtered state of each sample, all experiments one after the other (0 before the first used sample).
  [[nodiscard]] const RowMatrix& quantities() const { return quantities_; }
  /// Quantities predicted at the end of the step from each sample, inputs that are held as they were: a force over the step must not depend
  /// on the next measurement, nor on a controller's answer to it.
  [[nodiscard]] const RowMatrix& quantities_ahead() const { return ahead_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const std::vector<bool>& used() const { return used_; }
  /// Columns for forces on `port` that go over each step from f at its start to `ahead` at its end (all samples × m).
  [[nodiscard]] Eigen::MatrixXd columns(int port, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const;
  /// The quantity ports of parameters that there are columns for.
  [[nodiscard]] const std::vector<int>& parameters() const { return parameters_; }
  /// The same for changes of the parameter at place `i` of parameters(): over each step as a force, and, where an output's formula reads
  /// it, at each sample as an error of that output (output_columns()).
  [[nodiscard]] Eigen::MatrixXd parameter_columns(int i, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const;
  /// Columns for errors of an output, measured = predicted + error: at each sample `ahead` of the sample before, for an error must not
  /// depend on the very measurement that it is looked for in; f at the first (all samples × m).
  [[nodiscard]] Eigen::MatrixXd output_columns(int output, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const;
  /// Of these three, that for a place of that kind: a dynamic port, a parameter at its place of parameters(), an output.
  [[nodiscard]] Eigen::MatrixXd columns_at(PortKind kind, int index, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const;
  /// Columns for changes f of the rate of an effect's own state (counted from 0), constant over each step (all samples × m): to second
  /// order in the step, h (I + Phi)/2 of each.
  [[nodiscard]] Eigen::MatrixXd own_rate_columns(int own_state, const Eigen::MatrixXd& f) const;
  /// Rates of the effects' own states, the mean of the step that follows each sample, all experiments one after the other.
  [[nodiscard]] const RowMatrix& own_rates() const { return own_rates_; }
  /// ∂ log-likelihood/∂(force on a dynamic port, or a parameter at its place of parameters(), over the step from each sample), gains fixed:
  /// scans of many functions need only this (all samples). What a parameter does in the formulas of outputs is not in it.
  [[nodiscard]] Eigen::VectorXd score_of_steps(PortKind kind, int index) const;
  /// Whether a force on one dynamic port does over every step what a constant multiple of it does on the other. Not where either does
  /// nothing.
  [[nodiscard]] bool are_multiples(int port, int other) const;

 private:
  void run_steps(Stepper& stepper, std::size_t experiment, std::size_t offset);
  void note_outputs(Stepper& stepper, std::size_t experiment);
  /// Functions of the states at the start and the end of each step (all samples × m).
  struct CourseOverSteps {
    const Eigen::MatrixXd &f, &ahead;
  };
  void add_step(const SamplePlace& at, int place, const CourseOverSteps& course, RowMatrix& s) const;

  const FilterEstimate& estimate_;
  std::vector<int> parameters_;
  std::vector<std::vector<double>> G_;  ///< per experiment: samples × n × (dynamic ports, then parameters)
  std::vector<std::vector<double>> Y_;  ///< ∂(predicted output)/∂(parameter), per experiment: samples × outputs × parameters; empty: 0
  int ports_ = 0, places_ = 0;          ///< dynamic ports; these and the parameters
  RowMatrix quantities_, ahead_, own_rates_;
  std::vector<double> times_;
  std::vector<bool> used_;
};

}  // namespace misfit
