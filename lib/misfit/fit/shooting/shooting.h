#pragma once

// References
//   [B]  H. G. Bock, Recent advances in parameter identification for ODE (1983): multiple shooting.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/inference/roughness.h"
#include "misfit/math/least_squares.h"
#include "misfit/sim/planner.h"

namespace misfit {

/// One pass of multiple shooting: segment initial states are unknowns tied by weighted continuity residuals [B].
struct ShootingPass {
  std::size_t length = 0;       ///< samples per segment; 0: one trajectory per experiment
  double defect_weight = 10.0;  ///< of a defect of one `state scale`, relative to a residual of one sigma
  double initial_radius = 1e4;  ///< of the trust region
  int max_iterations = 30;
  double tolerance = 1e-6;  ///< relative change of the cost
};

struct ShootingScales {
  std::vector<double> sigma;        ///< standard deviation of each output's residual [output unit]
  std::vector<double> state_scale;  ///< size that counts as one sigma of a defect, per state
};

/// The unknowns of output error — free parameters and segment initial states — and how to improve them.
class Shooting {
 public:
  Shooting(Model model, const std::vector<Signals>& experiments, ShootingScales scales, std::vector<RowMatrix> start_states);

  /// One solve by Ceres. The histories (states at every sample) are replaced by what the solved segments pass through.
  LeastSquares::Summary solve(const ShootingPass& pass, const std::vector<Penalty>& penalties);

  /// The single-trajectory problem at the present values: columns are the free parameters, then the initial states of each experiment.
  /// Residuals are in units of sigma. False if the run leaves the finite numbers. `runs`: what run(true) would give, at no further cost.
  bool linearise(NormalEquations& out, std::vector<Segment>* runs = nullptr);
  /// The same with every segment of `length` samples on its own, its initial state (from the history) projected out: columns are the free
  /// parameters. For choosing the roughness before one trajectory fits the whole record.
  bool linearise_segments(std::size_t length, NormalEquations& out);
  /// Predictions over the whole of each experiment from its initial state, with derivatives if asked.
  [[nodiscard]] std::vector<Segment> run(bool sensitivities);

  /// Replaces the histories by the model's own motion from their first states, where that stays finite.
  void run_histories();
  /// Plans the integration along the histories (planner.h); solve() does so by itself, at kSearchTolerance, where there is no plan.
  void plan(double tolerance);
  [[nodiscard]] const IntegrationPlan& plan_of(std::size_t experiment) const { return inputs_[experiment].plan; }
  /// Outputs of whole runs (samples × outputs per experiment), with every part of the plan in two if `halved`. Nothing where a run leaves
  /// the finite numbers.
  [[nodiscard]] std::optional<std::vector<RowMatrix>> outputs(bool halved);
  /// RMS of errors of the outputs, and beside it that of the residuals of `outputs`, where the error is largest of all outputs and
  /// experiments.
  struct ErrorSize {
    double error = 0.0, residual = 0.0;  ///< [sigma]
  };
  [[nodiscard]] ErrorSize size_of(const std::vector<RowMatrix>& errors, const std::vector<RowMatrix>& outputs) const;
  /// How far all unknowns (the free parameters, then the initial states) would move if the outputs were more by `errors`, linear about
  /// `runs`, which are those of the present values with derivatives.
  [[nodiscard]] Eigen::VectorXd shift_by(const std::vector<RowMatrix>& errors, const std::vector<Segment>& runs,
                                         const Eigen::MatrixXd& covariance) const;

  /// Parameters and histories, to go back to when a solve leads nowhere.
  struct State {
    std::vector<Parameter> parameters;
    std::vector<RowMatrix> history;
  };
  [[nodiscard]] State state() const { return {model_.parameters, history_}; }
  void restore(const State& state);
  /// Initial state of each experiment, for a pass of one trajectory.
  void begin_at(const std::vector<Eigen::VectorXd>& initial_states) {
    for (std::size_t e = 0; e < history_.size(); ++e) history_[e].row(0) = initial_states[e];
  }
  /// All unknowns as linearise() orders them. False, and nothing changes, if one of them is outside its bounds.
  bool move_to(const Eigen::VectorXd& unknowns);
  /// What the segments of the last solve predict, each from its own fitted state: samples × outputs per experiment.
  [[nodiscard]] std::vector<RowMatrix> predict_segments();

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const std::vector<double>& sigma() const { return sigma_; }
  void set_sigma(std::vector<double> sigma) { sigma_ = std::move(sigma); }
  [[nodiscard]] Eigen::VectorXd initial_state(std::size_t experiment) const { return history_[experiment].row(0); }
  [[nodiscard]] int linearisations() const { return linearisations_; }
  [[nodiscard]] const std::string& failure() const { return failure_; }  ///< where the last run left the finite numbers, in words
  void forget_failure() { failure_.clear(); }
  /// Does no measurement of it count?
  [[nodiscard]] bool held_out(std::size_t experiment) const { return held_out_[experiment]; }
  /// Is this initial state the one read from the first samples (`start_states`), since no measurement tells it? Those that are fixed or
  /// shared with an experiment that counts are not; own states of effects are neither.
  [[nodiscard]] bool read_from_samples(std::size_t experiment, std::size_t state) const;
  /// Is output o of sample i a residual of the estimation?
  [[nodiscard]] bool counts(std::size_t experiment, std::size_t i, std::size_t o) const;

 private:
  struct Piece {
    std::size_t experiment, first, last;
    double defect_weight = 0.0;
    int block = -1, next = -1;  ///< parameter blocks: own initial state, initial state of the next piece (−1: none)
    Segment segment{};
  };
  void set_theta(const double* theta);
  bool evaluate(Piece& piece, const double* const* blocks, double* r, double** J);
  void fill_rows(const Piece& piece, double* r, double** J) const;
  [[nodiscard]] NormalEquations empty_sums(Eigen::Index unknowns) const;
  [[nodiscard]] double weigh(std::size_t experiment, Segment& run, Eigen::VectorXd& r) const;
  [[nodiscard]] double counted(const Piece& piece) const;
  std::vector<Piece> cut(std::size_t length) const;
  void add_pieces(LeastSquares& problem, int theta_block, std::vector<Piece>& pieces);
  void add_initial(LeastSquares& problem, const std::vector<Piece>& pieces) const;
  /// Stiffness by which an initial state is held [1/unit²]: to its value, or to that of another experiment.
  [[nodiscard]] double holding(std::size_t state) const;
  /// As the study has it; free after a gap, and of own states of effects.
  [[nodiscard]] Initial kind_of_start(std::size_t experiment, std::size_t state) const;
  /// What an initial state is held to by itself.
  [[nodiscard]] std::optional<double> known_start(std::size_t experiment, std::size_t state) const;
  /// Is it one unknown with that of `shared_with_`?
  [[nodiscard]] bool shared_start(std::size_t experiment, std::size_t state) const;
  void constrain_initial(NormalEquations& out) const;
  void add_priors(LeastSquares& problem, int theta_block, const std::vector<Penalty>& penalties) const;
  void remember(std::vector<Piece>& pieces, const LeastSquares& problem);
  void note_failure(const Segment& segment, std::size_t experiment);

  Model model_;
  const std::vector<Signals>& experiments_;
  std::vector<double> sigma_, state_scale_;
  std::vector<RowMatrix> history_;
  std::vector<Eigen::VectorXd> read_start_;  ///< per experiment, from its first samples
  std::vector<bool> held_out_;
  std::optional<std::size_t> shared_with_;  ///< experiment whose initial state shared ones are: the first not after a gap that counts
  std::vector<InputTable> inputs_;
  std::vector<int> free_;
  std::vector<double> values_;
  std::unique_ptr<Stepper> stepper_;
  Segment run_;  ///< kept, so that linearising again does not allocate
  int linearisations_ = 0;
  std::string failure_;
};

}  // namespace misfit
