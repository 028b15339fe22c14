#pragma once

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// 2 [log L(with) − log L(without)], each at its own maximum, priors counted; of one set of measurements, which is not checked.
///
/// Where `with` reads an output in whole steps q (5.6 of lib/misfit/README.md) and `without` takes it as it is, log L(without) counts what
/// was recorded for what it is, too: a cell of width q. Of a measurement at a distance d from its prediction of variance S that is
///   log {[Φ((d + q/2)/√S) − Φ((d − q/2)/√S)]/q}
/// instead of the log density, whose limit it is for S ≫ q². Measurements that repeat to the last digit have densities without bound, which
/// a random force that follows the stairs would count as evidence against the stairs; their probability is 1 at most.
[[nodiscard]] double likelihood_drop(const FilterEstimate& with, const FilterEstimate& without);

}  // namespace misfit
