#pragma once

#include <string>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/fit.h"

namespace misfit {

// What a person reads on a terminal: aligned, with units and sigmas.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);
[[nodiscard]] std::string attitude_text(const std::string& experiment, const Attitude& attitude);
[[nodiscard]] std::string fits_text(const std::vector<Fit>& fits);
/// 1 if every method failed or declined although some were asked for, else 0.
[[nodiscard]] int status_of(const std::vector<Fit>& fits);
/// The content of a result file, to stdout: for --json.
void print_file(const std::filesystem::path& path);

}  // namespace misfit
