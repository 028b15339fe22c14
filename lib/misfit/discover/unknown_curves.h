#pragma once

// Score tests of forces, errors and changes of parameters of unknown form: what no effect of the registry needs to describe.

#include <string>
#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

/// Hats per quantity of the unknown curves.
inline constexpr int hats_of_unknown_curves = 8;

/// Dynamic ports on which a force of unknown form may act (may_be_forced()).
[[nodiscard]] std::vector<int> ports_of_unknown_curves(const SystemSpec& system);

/// Columns of forces, errors, and of the parameters of a small system.
[[nodiscard]] ForceSensitivity sensitivity_of_forces_and_parameters(const FilterEstimate& estimate);

/// Quantity ports of the parameters that may change in a way of unknown form: of a small system those that are free in the model. None
/// where an effect shifts the time at which outputs are taken: the columns of a constant change are not those of the parameter then.
[[nodiscard]] std::vector<int> parameters_of_unknown_curves(const Model& model);

/// Drops nearer than this do not distinguish two effects: beyond it the evidence is "very strong" (Kass & Raftery, Bayes Factors,
/// J. Am. Stat. Assoc. 90 (1995), section 3.2).
inline constexpr double tied_drops = 10.0;

/// A force of unknown form: hat functions of a quantity on a dynamic port, or for a surface their products with those of another; or so a
/// change of a parameter, or an error of an output.
struct UnknownCurve {
  PortKind kind = PortKind::dynamic;  ///< quantity: `port` is a parameter; sensor: it is an output
  int index = -1;                     ///< of the place among those of its kind (ForceSensitivity::columns_at())
  std::string port, quantity;
  int quantity_index = -1;
  std::string other;                  ///< second quantity of a surface; empty: a curve
  std::string memory;                 ///< what stands for a memory of unknown form in place of this, in words; empty: nothing
  int hats = hats_of_unknown_curves;  ///< looked for
  std::vector<double> centre;         ///< of the hats that have samples [unit of the quantity]; of a curve only
  ScoreResult result;
  double log_p = 0.0, p_value = 1.0;

  /// By which the first of several is chosen: log_p, but a force or an error is the simpler of two that explain about the same.
  [[nodiscard]] double order() const { return log_p + (kind == PortKind::quantity ? 0.5 * tied_drops : 0.0); }

  /// χ² less twice what it is on average where nothing is missing.
  [[nodiscard]] double worth() const { return result.chi2 - 2.0 * result.dof; }

  /// "an unknown curve dv/dt(v)", "an unknown surface dv/dt(v, u)", "an error of y that depends on u", "delay (input = u)"
  [[nodiscard]] std::string label() const;
  [[nodiscard]] std::string quantities() const;  ///< "v", "v and u"
  [[nodiscard]] std::string in_words() const;    ///< "a change of c that depends on x"
};

/// At one place, of one quantity.
[[nodiscard]] bool is_of_the_same(const UnknownCurve& a, const UnknownCurve& b);

/// Of every quantity, and of the past of every input, on every dynamic port, and as errors of every output; of every quantity as changes
/// of the parameters (parameters_of_unknown_curves()) of which `work.force` has columns.
[[nodiscard]] std::vector<UnknownCurve> unknown_curves(const ScoreWork& work, const ProgressFn& progress = {});
[[nodiscard]] std::size_t count_of_unknown_curves(const ScoreWork& work);

/// What changes over shorter ways than unknown_curves() can follow (a detent, a magnet beside the way, a worn place of a potentiometer): of
/// every quantity of the system, as a force and as an error of an output, with 24 and with 72 hats, the better of the two corrected for
/// both. What describes every sharp effect a little better than itself: for where no effect explains what is missing.
[[nodiscard]] std::vector<UnknownCurve> narrow_curves(const ScoreWork& work);
/// By more than a drop of tied_drops.
[[nodiscard]] bool is_clearly_better(const UnknownCurve& narrow, const UnknownCurve& usual);
/// `usual` curves, and in place of those of the same quantity at the same place the narrow ones that are clearly better.
[[nodiscard]] std::vector<UnknownCurve> with_narrow_ones(std::vector<UnknownCurve> usual, std::vector<UnknownCurve> narrow);

/// Those of `all` that explain about the same as `curve` (p-values apart by no more than a drop of tied_drops), where neither explains
/// anything more beside the other (one score test of both): these data cannot tell them apart. None of the past of an input.
[[nodiscard]] std::vector<UnknownCurve> curves_alike(const UnknownCurve& curve, const std::vector<UnknownCurve>& all, const ScoreWork& work,
                                                     double p_accept);

/// past_of() what an effect with a memory reads first.
[[nodiscard]] std::string past_read_by(const SystemSpec& system, const BoundEffect& effect);

/// Changes of the rate of every own state of the last `effects` effects, of that state and of that rate: whether their memories are of
/// these forms. `quantity`: past_read_by() the effect.
[[nodiscard]] std::vector<UnknownCurve> unknown_own_rates(const ScoreWork& work, int effects);

/// Of every pair of quantities, time among them, of which `read` has at least one, on every dynamic port; four hats of each.
[[nodiscard]] std::vector<UnknownCurve> unknown_surfaces(const ScoreWork& work, const std::vector<int>& read);

}  // namespace misfit
