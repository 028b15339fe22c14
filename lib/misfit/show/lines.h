#pragma once

#include <string>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/ladder.h"
#include "misfit/data/track_facts.h"

namespace misfit {

// What a stage has found, in one line for whoever watches a run: its main number with unit and sigma. Tables have the rest (results.h).

[[nodiscard]] std::string line_of(const TrackFacts& facts);
[[nodiscard]] std::string line_of(const Calibration& calibration);
[[nodiscard]] std::string line_of(const Attitude& attitude);
/// Trim or else the parameters; the random force, or without one the residuals in their unit and in per cent of the motion.
[[nodiscard]] std::string line_of(const Fit& fit);
/// Whether the model reproduces the statistics of the motion, else by how much the methods differ; empty: nothing to compare.
[[nodiscard]] std::string line_of(const Comparison& comparison);
[[nodiscard]] std::string line_of(const Diagnosis& diagnosis);
/// The accepted effect, or how many were tested and which is nearest.
[[nodiscard]] std::string line_of(const Discovery& discovery);
[[nodiscard]] std::string line_of(const Rung& rung);
/// Its rungs: "planar → coning → strut_wake"; empty for a ladder without rungs above the first.
[[nodiscard]] std::string line_of(const Ladder& ladder);
[[nodiscard]] std::string line_of(const std::vector<Fit>& fits);  ///< of the first

}  // namespace misfit
