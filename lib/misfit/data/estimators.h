#pragma once

#include <array>
#include <string>
#include <vector>

namespace misfit {

/// What distinguishes a method of estimation for studies, the command line, stages and results. How each is run: fit/methods.h.
struct EstimatorInfo {
  const char* name;
  const char* doc;
  /// Of the measured motion: profiles, random starts and refits near a maximum need it. False: a regression on differentiated measurements.
  bool has_likelihood = false;
  /// The motion follows from initial states and inputs. False: a random force drives it too, which diagnosis, discovery and the simulation
  /// of motion like the measured one need.
  bool deterministic = true;
  /// Solves the two curves of the system's regression form (SystemSpec::regression) in the first experiment, not the model's parameters.
  bool regression_form = false;
  bool by_default = true;  ///< used where a study names no method
};

namespace estimators {

inline constexpr EstimatorInfo sliding_bin{.name = "sliding_bin",
                                           .doc = "the paper's regression in bins that slide over the level: a static and a damping curve",
                                           .regression_form = true};
inline constexpr EstimatorInfo equation_error{.name = "equation_error",
                                              .doc = "regression of differentiated measurements on the equations of motion"};
inline constexpr EstimatorInfo output_error{.name = "output_error",
                                            .doc = "the simulated trajectory of a deterministic model against the measured outputs",
                                            .has_likelihood = true};
inline constexpr EstimatorInfo filter_error{.name = "filter_error",
                                            .doc = "extended Kalman filter: the motion is driven by a random force as well",
                                            .has_likelihood = true,
                                            .deterministic = false,
                                            .by_default = false};

/// In the order in which they are listed and run by default.
inline constexpr std::array all{&sliding_bin, &equation_error, &output_error, &filter_error};

}  // namespace estimators

[[nodiscard]] std::vector<std::string> estimator_names();
[[nodiscard]] std::vector<std::string> default_estimators();
[[nodiscard]] const EstimatorInfo* find_estimator(const std::string& name);  ///< nullptr: there is none
/// The one that follows a deterministic trajectory.
[[nodiscard]] const EstimatorInfo& trajectory_estimator();
/// The one whose model has a random force.
[[nodiscard]] const EstimatorInfo& random_force_estimator();
[[nodiscard]] bool has_likelihood(const std::string& name);  ///< false for a name that no method has
/// "output_error and filter_error".
[[nodiscard]] std::string estimators_with_likelihood();

}  // namespace misfit
