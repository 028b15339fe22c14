#pragma once

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Gain of the log-likelihood that a Newton step promises, ½ gᵀ H⁻¹ g, where it moves one parameter by one sigma, by two.
inline constexpr double kDecrementOfOneSigma = 0.5, kDecrementOfTwoSigmas = 2.0;

/// Of unknowns.
struct BoxBounds {
  Eigen::VectorXd lower, upper;

  /// The point inside that is nearest.
  [[nodiscard]] Eigen::VectorXd nearest(const Eigen::VectorXd& to) const { return to.cwiseMax(lower).cwiseMin(upper); }
};

/// Where an estimation stands: parameters, noise, the runs and derivatives there; and the steps that raise its objective. Held in `out`,
/// which is always that of a run that succeeded unless a member says false.
class LikelihoodAscent {
 public:
  LikelihoodAscent(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                   const FilterOptions& options);

  /// Run with derivatives at `theta`. False: the model cannot be run there, failure() says where it ended.
  bool linearise();
  /// The same to the end of the recordings, which a search does not need (FilterOptions::whole_runs). False: it diverges on the way.
  bool linearise_whole();
  /// The last run went to the end of all recordings.
  [[nodiscard]] bool is_whole() const;
  /// One Gauss–Newton step of the physical parameters with new roughness; shortened until the exact objective rises. Returns what a step
  /// promised of which no length rises: 0 if one did, or nothing was promised; infinity where no step could be computed.
  double gauss_newton_step();
  /// Alternates the blocks, physical parameters and noise, until neither gains `tolerance`: then `out.converged`, unless a step that
  /// promised as much as a sigma of one parameter found no way up.
  void iterate(int most, double tolerance);
  /// Plans the integration along the states that the channels show.
  void plan_along_measurements(double tolerance);
  /// Plans the integration along the filtered states. True if it is another one than before: then linearise() is due.
  bool plan(double tolerance);
  /// Memories of effects begin where these parameters say that they are (own_states_along()); nothing is run.
  void begin_memories(const Eigen::VectorXd& theta_of_memories);
  /// How far the free parameters would move if every part of the plan were halved [sigma], the largest; 0 where it cannot be run so.
  [[nodiscard]] double integration_shift() const;
  /// False if the model cannot be run with it, or has no density with it (a fit of the noise that failed): all is as before.
  bool try_noise(const NoiseFit& fit);
  /// A step of a Newton kind over parameters and log noise together, inside their bounds: `gradient` of the exact objective and of a
  /// further term linear in the log noise, with `slope` (what restricted_likelihood() adds), `inverse` of their curvature. Shortened until
  /// their sum rises, lengthened where it gains more than it promised. `out.newton_decrement` is what it promises. What it gained; nullopt:
  /// it promises less than 0.02, or no length of it rises.
  std::optional<double> joint_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& inverse, const Eigen::VectorXd& slope);
  /// The highest of the points a sigma, a quarter and a twentieth of one away along the axes of the correlation matrix of `covariance`,
  /// that of parameters and log noise together: the way up where the objective has a kink, of which derivatives say nothing. `slope` as
  /// above. What it gained; nullopt: less than 0.02, all is as before.
  std::optional<double> axis_step(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& slope);
  /// Parameters and logarithms of the noise, inside their bounds. False if the model cannot be run there: all is as before.
  bool move_to(const Eigen::VectorXd& there, const std::vector<double>& logs);
  bool move_to(const Eigen::VectorXd& joint);  ///< as joint() has them
  /// Where a search stands.
  struct Point {
    Eigen::VectorXd theta;
    double objective;
    FilterNoise noise;
    NoiseFit noise_fit;
    std::vector<Penalty> penalties;
  };
  [[nodiscard]] Point here() const { return {theta, objective, out.noise, out.noise_fit, out.penalties}; }
  /// With runs and information of the noise there, whatever was going on; it is then the point to return to. False: it cannot be run.
  bool return_to(const Point& point);
  /// Bounds and information of the noise as it is, where no fit of it has been taken.
  void describe_noise();
  /// False if the model cannot be run with it: all is as before.
  bool begin_with(const FilterNoise& noise);
  /// The present point is the one to return to; every step that has risen does this by itself.
  void remember();
  /// To the point that was remembered last. False: there is none, or it cannot be run.
  bool return_to_remembered();
  /// Objective at that point; −infinity: there is none.
  [[nodiscard]] double reached() const;
  [[nodiscard]] Eigen::VectorXd joint() const;  ///< the free parameters, then the logarithms of the noise

  [[nodiscard]] std::vector<double> values() const { return out.forced.model.values_at(theta); }
  [[nodiscard]] LinearisedRuns runs() const { return {&out.forced, &out.data, &out.traces}; }
  [[nodiscard]] NormalEquations normal_equations() const;
  [[nodiscard]] std::string failure() const;

  FilterEstimate out;
  Eigen::VectorXd theta;   ///< the free parameters (Model::theta)
  double objective = 0.0;  ///< at `theta` and `out.noise`

 private:
  bool run(bool whole);
  /// Takes the longest share of the step by which the exact objective rises. False: there is none.
  bool rises_along(const Eigen::VectorXd& step);
  /// Where no share of the Newton step rises: Levenberg and Marquardt's, (N + mu diag N) step = gradient with mu = 1, 10, …, the first that
  /// raises the exact objective; far from a maximum the unknowns that the data hardly determine make the Newton step too long for the rest.
  void damped_step(const Eigen::MatrixXd& precision, const Eigen::VectorXd& newton);
  [[nodiscard]] double objective_at(const Eigen::VectorXd& there, const FilterNoise& noise) const;
  /// Of the objective and what is linear in the log noise, over the present point.
  [[nodiscard]] double gain_at(const Eigen::VectorXd& at, const Eigen::VectorXd& slope) const;
  [[nodiscard]] BoxBounds joint_bounds() const;  ///< as joint()
  [[nodiscard]] double log_prior() const;        ///< of parameters, roughness and noise, at `theta` and `out.noise`

  int threads_;
  std::size_t failed_experiment_ = 0;
  std::optional<Point> remembered_;
  int iterations_ = 0;  ///< reported to the watch
};

}  // namespace misfit
