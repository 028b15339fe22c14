#pragma once

#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Of each output, the whole steps that `with` reads it in and `without` does not, 0: none; empty: that is no output.
[[nodiscard]] std::vector<double> steps_of_one_alone(const FilterEstimate& with, const FilterEstimate& without);

/// What the log-likelihood of a run over `data` changes by where these outputs are known to a cell of width `steps` instead of exactly
/// (likelihood_drop()).
[[nodiscard]] double change_in_cells(const FilterData& data, const FilterTrace& trace, const std::vector<double>& steps);

/// 2 [log L(with) − log L(without)], each at its own maximum, priors counted; of one set of measurements, which is not checked.
///
/// Where `with` reads an output in whole steps q (5.6 of lib/misfit/README.md) and `without` takes it as it is, log L(without) counts what
/// was recorded for what it is, too: a cell of width q. Of a measurement at a distance d from its prediction of variance S that is
///   log {[Φ((d + q/2)/√S) − Φ((d − q/2)/√S)]/q}
/// instead of the log density, whose limit it is for S ≫ q². Measurements that repeat to the last digit have densities without bound, which
/// a random force that follows the stairs would count as evidence against the stairs; their probability is 1 at most.
[[nodiscard]] double likelihood_drop(const FilterEstimate& with, const FilterEstimate& without);

}  // namespace misfit
