#pragma once

#include "misfit/fit/filter/likelihood_ascent.h"

namespace misfit {

/// With hardly any random force, so that the filter is a free run whose initial states alone are estimated: are the residuals of every
/// output less than half of its variance, in every experiment?
[[nodiscard]] bool follows_freely(LikelihoodAscent& at);

/// Gauss–Newton steps in such a run, the white noise as large as what is left, until that falls by less than 1 %: where the random force
/// may have a long memory it explains what the model does not yet, and no step of the parameters gains. RunError: the model cannot be run
/// so.
void settle_freely(LikelihoodAscent& at);

}  // namespace misfit
