#pragma once

#include "misfit/fit/filter/likelihood_ascent.h"

namespace misfit {

/// [log-likelihood] By which starts of one model are compared (marginal_loglik), parameters and noise as they are.
[[nodiscard]] double height_of(const LikelihoodAscent& at);

/// The first noise of a search, from the usual one: after one Gauss–Newton step of the parameters under that, or at the start's parameters,
/// where the filter diverges after the step or the start is clearly higher (from good parameters the usual noise, much too large, leads
/// astray). From three start values of the coloured noise's frequency, since the likelihood has a local maximum at each spectral line of
/// the measurement noise.
void search_noise(LikelihoodAscent& at, int threads);

}  // namespace misfit
