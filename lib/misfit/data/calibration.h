#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "misfit/math/camera.h"

namespace misfit {

/// What the sweep says about one optional camera parameter (or group, as the two centre coordinates).
struct CameraTest {
  std::string name;                     ///< "camera_roll", "image_centre", "pixel_aspect", "lens_k1", "camera_distance"
  std::vector<std::string> parameters;  ///< members of camera_parameter_names
  std::vector<double> values;           ///< estimate when freed (given those selected), SI
  std::vector<double> sigmas;
  double drop = 0.0;     ///< 2 Δ log L for freeing it, given those selected before
  double p_value = 1.0;  ///< corrected for the number of candidates
  bool selected = false;
};

/// One reference point at one angle.
struct CalibrationResidual {
  int point = 0;           ///< 1, 2, 3
  char coordinate = 'z';   ///< 'y' or 'z'
  double theta = 0.0;      ///< [rad]
  double measured = 0.0;   ///< [px]
  double predicted = 0.0;  ///< [px]
  bool used = true;        ///< false: set aside as an outlier
};

/// A calibrated camera: values, joint covariance of the free ones, and why each parameter is free or not.
struct Calibration {
  CameraModel model = CameraModel::pinhole;
  CameraParameters<double> camera;
  std::vector<std::string> names;  ///< free parameters, order of `covariance`
  Eigen::MatrixXd covariance;      ///< names × names, SI units
  double sigma_px = 0.0;           ///< estimated noise of one coordinate [px]
  double rms_px = 0.0;             ///< over the points used [px]
  int outliers = 0;
  std::string message;  ///< why the solver stopped
  bool converged = false;
  std::vector<CameraTest> tests;
  std::vector<CalibrationResidual> residuals;
  std::vector<std::string> notes;  ///< what was dropped and why, in words

  [[nodiscard]] double value(const std::string& name) const;  ///< any of camera_parameter_names
  [[nodiscard]] double sigma(const std::string& name) const;  ///< 0 if not free
};

/// camera.json: {"h_c":{"value","sigma","unit"},…,"names","covariance","rms_px","tests":{…}}; angles in radians, unit
/// "rad".
void write_calibration(const std::filesystem::path& path, const Calibration& calibration);
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& path);

}  // namespace misfit
