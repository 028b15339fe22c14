#pragma once

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/jobs/bytes.h"

namespace misfit {

/// An estimate to the last bit, for checkpoints: all of it but the shape of its model and the measurements, which whoever reads it must
/// have.
void write_estimate(ByteWriter& bytes, const FilterEstimate& estimate);

/// `model`: the estimate's but for the values of the parameters and which of them are free; `experiments`: those it was made of, kept by
/// reference. RunError: the bytes are of no such estimate.
[[nodiscard]] FilterEstimate read_estimate(ByteReader& bytes, const Model& model, const std::vector<Signals>& experiments);

}  // namespace misfit
