#include "misfit/attitude/axis_sample.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/math/scalar.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr int parameters = int_size(camera_parameter_names);
constexpr int width = 2 + parameters;  // P_y, P_z, then the camera
using PixelJet = Jet<width>;

std::vector<Eigen::Index> free_columns(const Calibration& calibration) {
  std::vector<Eigen::Index> columns;
  for (const std::string& name : calibration.names) {
    const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
    columns.push_back(2 + (found - camera_parameter_names.begin()));
  }
  return columns;
}

CameraParameters<PixelJet> jet_camera(const CameraParameters<double>& camera) {
  CameraParameters<PixelJet> jets;
  const auto to = camera_entries(jets);
  const auto values = camera_values(camera);
  for (int i = 0; i < parameters; ++i) *to[i] = PixelJet(values[i], 2 + i);
  return jets;
}

class Reader {
 public:
  Reader(const Calibration& calibration, const RigGeometry& geometry, bool derivatives)
      : model_(calibration.model),
        axis_{geometry.R, geometry.l_b, geometry.l_s},
        plain_(calibration.camera),
        camera_(jet_camera(calibration.camera)),
        columns_(free_columns(calibration)),
        derivatives_(derivatives) {}

  /// False if no angle explains the pixel.
  bool read(double P_y, double P_z, AxisSample& sample) const { return derivatives_ ? with(P_y, P_z, sample) : without(P_y, P_z, sample); }

 private:
  bool without(double P_y, double P_z, AxisSample& sample) const {
    const auto read = read_axis(AxisCamera{model_, plain_, axis_}, P_y, P_z);
    if (!read) return false;
    sample.ok = true;
    sample.theta = (*read)[0];
    sample.psi = (*read)[1];
    return true;
  }

  bool with(double P_y, double P_z, AxisSample& sample) const {
    const auto read = read_axis(AxisCamera{model_, camera_, axis_}, PixelJet(P_y, 0), PixelJet(P_z, 1));
    if (!read) return false;
    sample.ok = true;
    sample.theta = (*read)[0].a;
    sample.psi = (*read)[1].a;
    sample.by_camera.resize(2, columns_.size());
    for (Eigen::Index row = 0; row < 2; ++row) {
      const auto& derivatives = (*read)[row].v;
      sample.by_pixel.row(row) = derivatives.head<2>().transpose();
      for (std::size_t j = 0; j < columns_.size(); ++j) sample.by_camera(row, j) = derivatives[columns_[j]];
    }
    return true;
  }

  CameraModel model_;
  AxisGeometry axis_;
  CameraParameters<double> plain_;
  CameraParameters<PixelJet> camera_;
  std::vector<Eigen::Index> columns_;
  bool derivatives_;
};

}  // namespace

AxisSamples read_axes(const Track& track, const Calibration& calibration, const RigGeometry& geometry, bool derivatives) {
  const Reader reader(calibration, geometry, derivatives);
  AxisSamples axes;
  axes.samples.resize(track.t.size());
  for (std::size_t i = 0; i < track.t.size(); ++i) {
    const bool there = track.ok[i] && std::isfinite(track.P_y[i]) && std::isfinite(track.P_z[i]);
    if (!there) {
      ++axes.lost;
    } else if (!reader.read(track.P_y[i], track.P_z[i], axes.samples[i])) {
      ++axes.unexplained;
    }
  }
  return axes;
}

std::optional<double> pixel_noise(const Track& track, const std::vector<bool>& even_step) {
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
