#pragma once

#include <optional>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/model/request.h"

namespace misfit {

/// A strength at which its effect is whole (CoefficientSpec::whole).
struct WholeStrength {
  int parameter = -1;
  double value = 0.0;  ///< [unit of the strength]
};

/// Of the model's last effect, at an estimate of it: a share of an output, or of the gain by which the rest of the model lets an input act
/// on the effect's first port. Left out: strengths that have none, and inputs that do not act there.
[[nodiscard]] std::vector<WholeStrength> whole_strengths(const FilterEstimate& estimate);

/// The input of which the model's last effect is a share (its strength is one of the gain by which the input acts), where that input moves
/// nothing in the rest of the model, neither rates nor outputs: then the effect is whatever that input does, by another name. nullopt: it
/// has no such strength, or the input acts.
[[nodiscard]] std::optional<std::string> idle_input(const FilterEstimate& estimate);

/// The request with its last effect on the input itself, where its strength is a share of what the input is, whatever the gain by which it
/// acts: fixed at 1, nothing is said of that gain, which a strength fixed at a number would fix. nullopt: it has no such strength, the
/// system has no port of the input's name, or it acts there already.
[[nodiscard]] std::optional<ModelRequest> on_its_input(const Model& model, const ModelRequest& request);

}  // namespace misfit
