#include "misfit/attitude/axis_reading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/math/scalar.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::size_t parameters = camera_parameter_names.size();
constexpr int width = 2 + static_cast<int>(parameters);  // P_y, P_z, then the camera
using ReadingJet = Jet<width>;

std::vector<Eigen::Index> free_columns(const Calibration& calibration) {
  std::vector<Eigen::Index> columns;
  for (const std::string& name : calibration.names) {
    const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
    columns.push_back(2 + static_cast<Eigen::Index>(found - camera_parameter_names.begin()));
  }
  return columns;
}

CameraParameters<ReadingJet> jet_camera(const CameraParameters<double>& camera) {
  CameraParameters<ReadingJet> jets;
  const auto to = camera_entries(jets);
  const auto values = camera_values(camera);
  for (std::size_t i = 0; i < parameters; ++i) *to[i] = ReadingJet(values[i], 2 + static_cast<int>(i));
  return jets;
}

}  // namespace

AxisReadings read_axes(const Track& track, const Calibration& calibration, const RigGeometry& geometry) {
  const AxisGeometry axis{geometry.R, geometry.l_b, geometry.l_s};
  const CameraParameters<ReadingJet> camera = jet_camera(calibration.camera);
  const std::vector<Eigen::Index> columns = free_columns(calibration);
  AxisReadings readings;
  readings.samples.resize(track.t.size());
  for (std::size_t i = 0; i < track.t.size(); ++i) {
    if (!track.ok[i] || !std::isfinite(track.P_y[i]) || !std::isfinite(track.P_z[i])) {
      ++readings.lost;
      continue;
    }
    const auto read = read_axis(calibration.model, camera, axis, ReadingJet(track.P_y[i], 0), ReadingJet(track.P_z[i], 1));
    if (!read) {
      ++readings.unexplained;
      continue;
    }
    AxisReading& sample = readings.samples[i];
    sample.ok = true;
    sample.theta = (*read)[0].a;
    sample.psi = (*read)[1].a;
    sample.by_camera.resize(2, static_cast<Eigen::Index>(columns.size()));
    for (Eigen::Index row = 0; row < 2; ++row) {
      const auto& derivatives = (*read)[static_cast<std::size_t>(row)].v;
      sample.by_pixel.row(row) = derivatives.head<2>().transpose();
      for (std::size_t j = 0; j < columns.size(); ++j) sample.by_camera(row, static_cast<Eigen::Index>(j)) = derivatives[columns[j]];
    }
  }
  return readings;
}

std::optional<double> reading_noise(const Track& track, const std::vector<bool>& even_step) {
  constexpr std::array<double, 7> difference = {1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};  // sum of squares 924
  constexpr std::size_t order = difference.size() - 1;
  std::vector<double> differences;
  for (std::size_t i = 0; i + order < track.t.size(); ++i) {
    bool whole = true;
    double d_y = 0.0, d_z = 0.0;
    for (std::size_t k = 0; k <= order; ++k) {
      whole = whole && track.ok[i + k] && (k == order || even_step[i + k]);
      d_y += difference[k] * track.P_y[i + k];
      d_z += difference[k] * track.P_z[i + k];
    }
    if (!whole || !std::isfinite(d_y) || !std::isfinite(d_z)) continue;
    differences.push_back(d_y);
    differences.push_back(d_z);
  }
  if (differences.size() < 40) return std::nullopt;
  return mad_sigma(differences) / std::sqrt(924.0);
}

}  // namespace misfit
