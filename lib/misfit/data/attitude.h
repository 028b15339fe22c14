#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit {

/// Attitude over time (lib/misfit/README.md (17); the paper is its [1]), radians and rad/s; NaN where a sample (or a neighbour a derivative
/// needs) is lost. One entry per sample.
struct Attitude {
  std::vector<double> t;                     ///< [s]
  std::vector<double> theta, psi;            ///< pitch, yaw of the axis as read (not averaged) [rad]
  std::vector<double> theta_mean, psi_mean;  ///< three-point averages [rad]
  std::vector<double> theta_rate, psi_rate;  ///< of the averages [rad/s]
  std::vector<double> alpha, beta;           ///< paper Eqs. 2, 3, from the averages [rad]
  std::vector<double> alpha_T;               ///< paper Eq. 4 [rad]
  std::vector<double> phi;                   ///< clock angle atan2(n_y, n_z) of the axis, from the averages [rad]
  std::vector<double> eta;                   ///< geometric tilt acos(n_x) of the axis as read (not averaged) [rad]
  std::vector<double> sigma_theta, sigma_psi, sigma_alpha_T, sigma_phi;  ///< from track and calibration [rad]
  std::vector<std::string> notes;                                        ///< what was dropped and why, in words
};

/// How many samples have an axis that could be read; alpha_T, which is computed from seven successive samples, may have fewer.
[[nodiscard]] std::size_t samples_read(const Attitude& attitude);

/// attitude.csv: `t[s],theta[deg],psi[deg],alpha[deg],beta[deg],alpha_T[deg],phi[deg]`, then eta[deg], the averages, rates and sigmas.
void write_attitude(const std::filesystem::path& path, const Attitude& attitude);
[[nodiscard]] Attitude read_attitude(const std::filesystem::path& path);

}  // namespace misfit
