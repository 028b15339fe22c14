#pragma once

#include <map>
#include <string>
#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/discover/unknown_curves.h"

namespace misfit {

// A force, or an error of an output, of which only the quantity is known that it depends on, as an effect of the model: a curve. The
// effects that do so are those of the registry with EffectSpec::has_unknown_form().

/// The effects that add such a curve at the place of what is unexplained: of its quantity, or of a surface of each of the two, the one that
/// explains more alone first (`screened`: unknown_curves()). Empty: it depends on no quantity of the system (but on time, or the past of an
/// input), or the registry has no such effect.
[[nodiscard]] std::vector<EffectPlace> effects_of_unknown_form(const UnknownCurve& unexplained, const std::vector<UnknownCurve>& screened,
                                                               const SystemSpec& system, const Registry& registry);

/// An effect of unknown form at each place where unknown_curves() looks for one, the most significant first: candidates with `roles`, and
/// `fixed_in_model` the parameters that its curve can take over; where one of narrow_curves() is clearly better, that one, which has
/// `knots`. `families`: that their p-values are corrected for, besides the number of narrow ones.
[[nodiscard]] std::vector<Candidate> candidates_of_unknown_form(const ScoreWork& work, const Effect& effect, double families);

/// Free parameters of the model, numbers only, which these columns (all samples × hats) describe beside the other free ones and which are
/// not described by those alone: 1 − R² < 0.01. A curve of the same quantity and such a parameter could not both be estimated: constants
/// and straight lines are curves, too. One at a time, the best described first, since the next may be determined once it is fixed.
[[nodiscard]] std::vector<int> parameters_in_columns(const FilterEstimate& estimate, const Eigen::MatrixXd& columns);

/// ∂(predicted − measured)/√S by the free parameters: rows of the estimate × free parameters.
[[nodiscard]] Eigen::MatrixXd columns_of_parameters(const FilterEstimate& estimate);
/// Those of `b` after those of `a`.
[[nodiscard]] Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace misfit
