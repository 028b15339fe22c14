#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "misfit/calibrate/sweep_points.h"
#include "misfit/math/camera.h"
#include "misfit/math/least_squares.h"

namespace misfit {

/// What a camera is fitted to. References must outlive it.
struct SweepData {
  const std::vector<SweepPoint>& points;
  const std::vector<bool>& keep;  ///< points that count
  double l_b = 0.0;               ///< RigGeometry::l_b [m]
};

/// Which camera parameters are free (indices into camera_parameter_names, ascending), and the camera to start from.
struct SweepModel {
  std::vector<std::size_t> free;
  CameraParameters<double> start;
};

/// A fit of a SweepModel to points.
struct SweepFit {
  CameraParameters<double> camera;
  std::vector<std::size_t> free;
  std::size_t data = 0;        ///< coordinates used
  double rss = 0.0;            ///< Σ residual² over them [px²]
  double sigma_px = 0.0;       ///< sqrt(rss / (data − free)) [px]
  Eigen::MatrixXd covariance;  ///< of the free ones, SI; sigma_px² (J'J)⁻¹; empty if not determined
  bool determined = false;     ///< J has full rank: the data distinguish the free parameters
  bool inside = false;         ///< no free parameter ended at its bounds
  bool converged = false;
  std::string message;

  [[nodiscard]] double sigma(std::size_t parameter) const;  ///< 0 if not free, NaN if not determined
};

[[nodiscard]] double& camera_entry(CameraParameters<double>& camera, std::size_t parameter);
[[nodiscard]] double camera_entry(const CameraParameters<double>& camera, std::size_t parameter);

/// (P_y, P_z) predicted for a point [px].
[[nodiscard]] std::array<double, 2> predict(const SweepPoint& point, double l_b, const CameraParameters<double>& camera);

/// `start` with K and h_c by linear least squares on (P_z − centre_z) (l_b + camera_distance − x)/l_b = K z + (K h_c), roll and lens left
/// out.
[[nodiscard]] CameraParameters<double> start_camera(const std::vector<SweepPoint>& points, double l_b, CameraParameters<double> start);

/// Least squares over the points with keep[i]. Loss acts on the distance of a point, both coordinates together.
[[nodiscard]] SweepFit fit_sweep(const SweepData& data, const SweepModel& model, const LeastSquares::Robust& loss = {});

}  // namespace misfit
