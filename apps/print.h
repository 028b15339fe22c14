#pragma once

#include <string>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/batch.h"
#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/intervals.h"
#include "misfit/data/ladder.h"
#include "misfit/data/track_facts.h"
#include "misfit/data/uncertainty.h"

namespace misfit {

// What a person reads on a terminal: aligned, with units and sigmas.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);
[[nodiscard]] std::string track_text(const std::string& experiment, const TrackFacts& facts);
[[nodiscard]] std::string attitude_text(const std::string& experiment, const Attitude& attitude);
[[nodiscard]] std::string fits_text(const std::vector<Fit>& fits);
[[nodiscard]] std::string batch_text(const Batch& batch);
[[nodiscard]] std::string uncertainty_text(const Uncertainty& uncertainty);
[[nodiscard]] std::string resampling_text(const Resampling& resampling);
[[nodiscard]] std::string diagnosis_text(const Diagnosis& diagnosis);
[[nodiscard]] std::string discovery_text(const Discovery& discovery);
/// Error before and after of a rung and its parent, per channel in its unit.
[[nodiscard]] std::string rung_text(const Ladder& ladder, const Rung& rung);
[[nodiscard]] std::string ladder_text(const Ladder& ladder);
/// What a fit warns of, one paragraph each.
[[nodiscard]] std::string warnings_text(const Fit& fit);
/// 1 if every method failed or declined although some were asked for, else 0.
[[nodiscard]] int status_of(const std::vector<Fit>& fits);
/// The content of a result file, to stdout: for --json.
void print_file(const std::filesystem::path& path);

}  // namespace misfit
