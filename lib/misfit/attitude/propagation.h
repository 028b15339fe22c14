#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "misfit/attitude/axis_sample.h"
#include "misfit/data/attitude.h"

namespace misfit {

/// Measurement noise and calibration behind the sigmas of an attitude.
struct UncertaintySources {
  const std::vector<AxisSample>& samples;
  const std::vector<double>& sigma_px;  ///< per sample, of one coordinate [px]; NaN: not known
  Eigen::MatrixXd camera;               ///< covariance of the calibration
};

/// Fills sigma_theta, sigma_psi, sigma_phi and sigma_alpha_T (attitude/attitude.h says what is in them) and returns a sentence with the
/// median shares of both sources in sigma_alpha_T. `lag` = R_cp / V [s]. NaN where the value itself is.
[[nodiscard]] std::string add_sigmas(Attitude& attitude, const UncertaintySources& from, double lag);

}  // namespace misfit
