#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/data/geometry.h"
#include "misfit/data/track.h"

namespace misfit {

/// One sample read through the camera.
struct AxisSample {
  bool ok = false;
  double theta = 0.0, psi = 0.0;                       ///< [rad]
  Eigen::Matrix2d by_pixel;                            ///< ∂(theta, psi)/∂(P_y, P_z) [rad/px]
  Eigen::Matrix<double, 2, Eigen::Dynamic> by_camera;  ///< ∂(theta, psi)/∂(Calibration::names) [rad/SI]
};

/// All samples, with derivatives where asked; `unexplained` counts those present in the track that no angle explains.
struct AxisSamples {
  std::vector<AxisSample> samples;
  std::size_t lost = 0, unexplained = 0;
};
[[nodiscard]] AxisSamples read_axes(const Track& track, const Calibration& calibration, const RigGeometry& geometry,
                                    bool derivatives = true);

/// White noise of one coordinate [px] from sixth differences of P_y and P_z over runs of seven samples without gap: their MAD over
/// sqrt(924). Smooth motion does not enter (a line at 0.15 of the sampling rate is weakened 50 times against white noise); an offset that
/// alternates does. nullopt with fewer than 20 such runs.
[[nodiscard]] std::optional<double> pixel_noise(const Track& track, const std::vector<bool>& even_step);

}  // namespace misfit
