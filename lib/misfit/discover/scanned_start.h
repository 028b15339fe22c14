#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/discover/candidate_model.h"

namespace misfit {

/// Where a fit may begin with an effect whose shapes nobody has given a start for: the likelihood has a maximum per sector, frequency or
/// delay, and from the wrong one no search finds the right one.
struct ScannedStart {
  std::vector<std::optional<double>> values;          ///< of the effect's coefficients, in its order; nullopt: none of its own, or a curve
  std::vector<double> refit_values, refit_log_noise;  ///< of all parameters with the effect behind all others, and of the noise, there
};

/// What the scan works on.
struct ScanTask {
  FittedStudy without;                       ///< without the effect
  const Calibration* calibration = nullptr;  ///< as in DiscoverOptions
  int threads = 0;                           ///< does not change the answer
};

/// Score tests over the cells of the effect's scanned shapes (screen.h), then the effect refitted from the best of them (refit.h). `fixed`:
/// its coefficients that are to stay at these values, by name. nullopt where it cannot be screened, explains nothing (chi² below 10), or
/// cannot be refitted.
[[nodiscard]] std::optional<ScannedStart> scanned_start(const ScanTask& task, const EffectRequest& effect,
                                                        const std::map<std::string, double>& fixed);

}  // namespace misfit
