#pragma once

#include <optional>
#include <vector>

#include "misfit/data/contained_fit.h"
#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

[[nodiscard]] ContainedFit contained_fit(const FilterEstimate& estimate);

/// Has the model the parameters, curves and channels of the fit, these first?
[[nodiscard]] bool contains(const Model& model, const ContainedFit& contained);

/// `model` at the values of the fit with what is its own off; then where discovery's refit ended, or without that the values of the fit
/// with what is its own as it is in `model`, where that differs. Empty: the model does not contain that of the fit.
[[nodiscard]] std::vector<FilterStart> starts_from(const ContainedFit& contained, const Model& model);

/// The penalties of `model` with the weights that the estimate has for the same curves: those of the same name, before which one of the two
/// may have the effect's.
[[nodiscard]] std::vector<Penalty> with_weights_of(const FilterEstimate& estimate, const Model& model, std::vector<Penalty> penalties);

/// FilterOptions::reference as of the fit, with what the study of `model` knows of the noise.
[[nodiscard]] FilterNoise usual_noise_of(const ContainedFit& contained, const Model& model);

/// FilterOptions::use as of the fit, without what is missing in these experiments; nullopt where they are others.
[[nodiscard]] std::optional<std::vector<std::vector<SampleRole>>> same_use(const ContainedFit& contained,
                                                                           const std::vector<Signals>& experiments);

}  // namespace misfit
