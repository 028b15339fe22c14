#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace misfit {

/// One parameter of the rig with its uncertainty, independent of the others.
struct Perturbation {
  std::string name;      ///< as the study writes it: "R", "K", "m_a", "P_y"
  std::string unit;      ///< SI; px of the image
  double sigma = 0.0;    ///< standard deviation of its error [unit]
  bool uniform = false;  ///< uniform within ± sqrt(3) sigma; else normal
};

/// Parameters whose errors go together, normal with this covariance: those of a calibration.
struct CorrelatedPerturbation {
  std::string label;               ///< "calibration": what the whole of them is called in the shares
  std::vector<std::string> names;  ///< order of `covariance`
  std::vector<std::string> units;  ///< SI
  Eigen::MatrixXd covariance;      ///< names × names, positive semi-definite
  std::string source = {};         ///< where the covariance stands: file and key
};

struct Perturbations {
  std::vector<Perturbation> single;
  std::vector<CorrelatedPerturbation> groups;

  [[nodiscard]] std::vector<std::string> names() const;  ///< single ones, then the groups' members
};

/// What is drawn for one run.
struct Draw {
  std::vector<double> errors;   ///< to be added, order of Perturbations::names() [SI]
  std::vector<double> factors;  ///< independent, mean 0, variance 1: one per single parameter, then as many per group as it has members
};

/// Draws errors: run k of a seed is always the same, whoever asks for it, and a parameter's errors do not change when another is added
/// (its random numbers are addressed by its name). Members of a group: errors = L z, L the Cholesky factor of the covariance.
class Sampler {
 public:
  /// InputError if a covariance is not positive semi-definite.
  Sampler(Perturbations perturbations, unsigned long seed);

  [[nodiscard]] Draw draw(std::size_t run) const;
  [[nodiscard]] const Perturbations& perturbations() const { return perturbations_; }
  /// One term of the variance per single parameter, one per group; factors belong to them in order.
  [[nodiscard]] std::vector<std::string> term_names() const;
  [[nodiscard]] const std::vector<std::size_t>& term_of_factor() const { return term_of_factor_; }
  [[nodiscard]] bool is_uniform(std::size_t factor) const;

 private:
  Perturbations perturbations_;
  unsigned long seed_;
  std::vector<Eigen::MatrixXd> roots_;  ///< L of each group
  std::vector<std::size_t> term_of_factor_;
};

}  // namespace misfit
