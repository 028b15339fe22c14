#pragma once

#include "misfit/fit/filter/likelihood_ascent.h"

namespace misfit {

/// Of LikelihoodAscent::iterate(), and its threads.
struct AscentRounds {
  int most;
  double tolerance;
  int threads;
};

/// weigh_outputs_otherwise() (inference/output_weights.h) of a search of the filter, rounds of LikelihoodAscent::iterate() from each
/// weighing. A weighing leads away where a step of the parameters moves one by more than five sigmas and a noise about it differs by a
/// fifth. TimeLimitReached: the search stands at the highest end so far.
void weigh_outputs_otherwise(LikelihoodAscent& at, const AscentRounds& rounds);

}  // namespace misfit
