#pragma once

#include <string>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/batch.h"
#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/intervals.h"
#include "misfit/data/ladder.h"
#include "misfit/data/track_facts.h"
#include "misfit/data/uncertainty.h"
#include "misfit/show/blocks.h"

namespace misfit {

// What is shown of each result, on a terminal and in the report alike: with units and sigmas. In brackets: the places of figures.

[[nodiscard]] Blocks blocks_of(const Calibration& calibration);  ///< [residuals]
[[nodiscard]] Blocks blocks_of(const std::string& experiment, const TrackFacts& facts);
[[nodiscard]] Blocks blocks_of(const std::string& experiment, const Attitude& attitude);
[[nodiscard]] Blocks blocks_of(const std::vector<Fit>& fits);
[[nodiscard]] Blocks blocks_of(const Comparison& comparison);
[[nodiscard]] Blocks blocks_of(const SimulatedMotion& motion);  ///< [statistics]
[[nodiscard]] Blocks blocks_of(const Batch& batch);
[[nodiscard]] Blocks blocks_of(const Uncertainty& uncertainty);  ///< [bands]
[[nodiscard]] Blocks blocks_of(const Resampling& resampling);    ///< [intervals]
[[nodiscard]] Blocks blocks_of(const Diagnosis& diagnosis);      ///< [maps], [innovations], [force]
[[nodiscard]] Blocks blocks_of(const Discovery& discovery);      ///< [candidates]
[[nodiscard]] Blocks blocks_of(const Ladder& ladder);            ///< [ladder]
/// Errors of a rung beside those of its parent, its drop, its parameters; without a heading.
[[nodiscard]] Blocks rung_blocks(const Ladder& ladder, const Rung& rung);
/// Error before and after of a rung and its parent, per channel in its unit; what the fit of the rung warns of.
[[nodiscard]] Blocks blocks_of(const Ladder& ladder, const Rung& rung, const Fit& fit);

// Parts of these.

/// Whether a candidate was not accepted for its p alone, which stands beside it in a table.
[[nodiscard]] bool is_only_not_significant(const Candidate& candidate);

/// Parameters, noise and random force of one fit.
[[nodiscard]] TableBlock parameter_table(const Fit& fit);
/// Where curves of different methods, or of a method and a reference, differ; what was not compared.
[[nodiscard]] Blocks curve_difference_blocks(const Comparison& comparison);
/// Trim, values at the trim, errors and log-likelihood of the methods side by side.
[[nodiscard]] TableBlock method_table(const Comparison& comparison);
/// Status, reason of termination, time of each fit; then what they warn of.
[[nodiscard]] Blocks status_blocks(const std::vector<Fit>& fits);

}  // namespace misfit
