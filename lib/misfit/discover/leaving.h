#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/discover/discover.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/model/registry.h"

namespace misfit {

/// An estimate without one of its model's effects.
struct Without {
  FilterEstimate estimate;
  ModelRequest request;  ///< what its model was assembled from
  double drop = 0.0;     ///< 2 [objective(with) − objective(without)], each at its maximum on the same measurements, roughness as there
  int parameters = 0;    ///< free ones that have gone with it
  double p_value = 1.0;  ///< of that drop by chance: chi² tail
};

/// `name`: an effect of the model as it calls it (BoundEffect::name). The model without it is estimated anew from the estimate's values.
/// nullopt: it cannot go (another effect shares its coefficients, or the model cannot be run without it), the search did not converge, or a
/// limit of time was spent.
[[nodiscard]] std::optional<Without> without_effect(const FittedStudy& fitted, const std::string& name, int threads);

/// Family-wise p (Sidak) of the drop of 2 log L of an effect with so many parameters, if it is one of so many that were tried.
[[nodiscard]] double chance_of(double drop, int parameters, double families);
/// May it be chance? Above 0.01, as for acceptance.
[[nodiscard]] bool may_be_chance(double drop, int parameters, double families);

/// A Wald test that is quick: are all free strengths of the effect within `sigmas` of 0 (4.5: p = 7e-6)? Else it is needed, whatever a fit
/// without it says.
[[nodiscard]] bool may_leave(const FilterEstimate& estimate, const std::string& name, double sigmas = 4.5);

/// A smoothing (ScanSpec::smooths) of one of the model's effects that was fixed, estimated.
struct FreedWidth {
  std::string coefficient;  ///< as the effect's file calls it
  double value = 0.0;       ///< [its unit]
  double drop = 0.0;        ///< 2 [objective(free) − objective(fixed)]
};

/// A width at which discovery has left an effect is that which its filter could resolve beside what was still missing then; as more is
/// explained the filter resolves more. The first fixed one of the effect that ends inside its bounds, no narrower than is resolved now
/// (OperatingRange::lower_bound()); nullopt: it has none, or the search did not converge.
[[nodiscard]] std::optional<FreedWidth> freed_width(const FilterEstimate& estimate, const std::vector<Signals>& experiments,
                                                    const std::string& name, int threads);

}  // namespace misfit
