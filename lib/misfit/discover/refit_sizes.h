#pragma once

#include "misfit/discover/refit.h"

namespace misfit {

/// A width (ScanSpec::smooths) that ends at what the filter resolved beside what was missing: as the effect explains more, the filter
/// resolves more, and the search goes on down to that, as long as the log-likelihood rises.
void narrow_smoothings(const RefitWork& work, Refit& out);

/// A time in which something follows that in truth follows at once (backlash_tau), fixed at two sampling intervals, goes on to a tenth and
/// a hundredth of that while the log-likelihood rises by more than tied_drops/2: as long as it is, it is a lag beside the effect, which the
/// search makes up for with a weaker and wider one. Each is integrated in steps of its own: those of the search would be too long.
void shorten_numerical_times(const RefitWork& work, Refit& out);

/// A strength that is a rate [1/s], so large that what it does is over within a sampling interval (above three of it), says "at once", and
/// the data determine no more of it: what spills over the edge of a lid. It is fixed at 300 per interval, where what stays above the edge
/// is a 300th of what flows in, if that costs the log-likelihood little, else where it was found, so that the effect is judged by what is
/// determined, its edge.
void fix_instant_strengths(const RefitWork& work, Refit& out);

}  // namespace misfit
