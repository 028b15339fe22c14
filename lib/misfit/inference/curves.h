#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/inference/roughness.h"
#include "misfit/inference/states.h"
#include "misfit/model/model.h"

namespace misfit {

/// Values of every quantity of the system along measured motion: samples × quantities, only samples where the states are known.
[[nodiscard]] RowMatrix visited_quantities(const Model& model, const Signals& signals, const ReconstructedStates& states);
/// The same of all experiments, one after the other.
[[nodiscard]] RowMatrix visited_quantities(const Model& model, const std::vector<Signals>& experiments,
                                           const std::vector<ReconstructedStates>& states);

/// Equally spaced breakpoints over the visited range of a quantity (0.1 % to 99.9 % of its finite values), `intervals` of them, fewer where
/// the range holds too few samples (at least 30 per interval on average); the first is kept above 0 for odd and even curves. RunError if
/// nothing is visited.
[[nodiscard]] std::vector<double> choose_knots(std::vector<double> visited, int intervals, const std::string& curve);

/// Fills knots of all curves of the request that have none, from the visited ranges in all experiments. Where the channels do not show the
/// quantity move, states that none of them shows are those of the model from where it begins, at its starting values (a charge that a
/// known current changes).
void choose_all_knots(ModelRequest& request, const Registry& registry, const std::vector<Signals>& experiments, int intervals);

/// Estimates for the report from free parameters with joint covariance: parameters by name, curves and derived curves with bands on a grid
/// of 0.1 deg (angles; 1/20 of a range below 2 deg) or 1/200 of the range, visit counts, and the trim (stable zero of the system's static
/// curve) with sigma. `visited` gives the counts.
void describe(const Model& model, const Eigen::MatrixXd& covariance, const RowMatrix& visited, Fit& fit);

/// Fit::roughness: each of the paths as the curves that hang on it, at about 40 of the places of describe().
void describe_roughness(const Model& model, const std::vector<RoughnessPoints>& paths, Fit& fit);

/// Keeps the sigmas of parameters and trim that describe() gave for white residuals, before it is called with the covariance that allows
/// for autocorrelated ones.
void keep_plain_sigmas(Fit& fit);

/// What fixed constants of known uncertainty do to the scale of the static curve, in words: "C_m scales with … : m_a = 0.294 ± 0.033 kg
/// alone makes it uncertain by 6.6 %". From the change of the gain of the curve in the equation of motion by one sigma of each constant, at
/// the state `x`. Empty if nothing is uncertain.
[[nodiscard]] std::vector<std::string> scale_uncertainties(const Model& model, const double* x, const InputsAt& u, double t);

/// Marks a curve, and every derived curve that contains it, as something the method cannot give.
void mark_not_informative(const Model& model, const std::string& curve, const std::string& why, Fit& fit);

/// Zero of a curve with negative slope, where the most samples were (ties: the first); sigma = σ_C/|slope|. nullopt if there is none inside
/// the visited range.
[[nodiscard]] std::optional<Estimate> stable_zero(const CurveEstimate& curve);

/// A warning where the curve that gives the trim has further stable zeros among the values visited: those between which it goes below
/// and above 0 by more than three of its sigmas.
void warn_of_other_trims(Fit& fit);

}  // namespace misfit
