#pragma once

#include <string>

#include "misfit/fit/roughness.h"
#include "misfit/model/model.h"

namespace misfit {

/// Which free parameters these data cannot tell, in words: a parameter that no residual depends on, or several of which only a combination
/// acts — named as product or ratio where it is one. From the eigenvectors of the normal matrix N (columns scaled to unit diagonal, priors
/// included, curves held by their roughness left out; further columns of N, initial states, are projected out) with eigenvalues below 1e-10
/// of the largest. Empty if every parameter is determined.
[[nodiscard]] std::string undetermined(const Model& model, const Linearised& problem);

}  // namespace misfit
