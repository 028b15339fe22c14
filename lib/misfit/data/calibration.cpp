#include "misfit/data/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

/// In the order of CameraModel.
constexpr std::array<const char*, 2> model_names = {"plane_by_plane", "pinhole"};

std::size_t parameter_index(const std::string& name) {
  const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
  if (found != camera_parameter_names.end()) return found - camera_parameter_names.begin();
  throw InputError("'" + name + "' is not a camera parameter" +
                   suggest(name, {camera_parameter_names.begin(), camera_parameter_names.end()}));
}

/// InputError for what write_calibration() does not write.
void check(const Calibration& c) {
  for (std::size_t i = 0; i < camera_parameter_names.size(); ++i) {
    if (!std::isfinite(camera_values(c.camera)[i])) throw InputError(std::string(camera_parameter_names[i]) + " has no value");
  }
  for (const std::string& name : c.names) static_cast<void>(parameter_index(name));
  if (c.covariance.rows() != std::ssize(c.names))
    throw InputError(fmt::format("covariance has {} rows for {} names", c.covariance.rows(), c.names.size()));
}

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<CameraTest> auto& test) {
  json("parameters", test.parameters), json("values", test.values), json("sigmas", test.sigmas);
  json("drop", test.drop), json("p_value", test.p_value), json("selected", test.selected);
}

template <class Archive>
void fields(Archive& json, MaybeConst<CalibrationResidual> auto& r) {
  std::string coordinate(1, r.coordinate);
  json("point", r.point), json("coordinate", coordinate), json("theta", r.theta), json("measured", r.measured);
  json("predicted", r.predicted), json("used", r.used);
  if constexpr (Archive::reading) {
    if (coordinate != "y" && coordinate != "z") throw InputError("coordinate is '" + coordinate + "': 'y' or 'z'");
    r.coordinate = coordinate.front();
  }
}

template <class Archive>
void fields(Archive& json, MaybeConst<Calibration> auto& c) {
  json("model", NameOf(c.model, model_names));
  std::array<double, 8> values = camera_values(c.camera);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string name = camera_parameter_names[i];
    Estimate e{values[i], Archive::reading ? 0.0 : c.sigma(name), camera_parameter_units[i]};
    json(name, e);
    if constexpr (Archive::reading) *camera_entries(c.camera)[i] = e.value;
  }
  json("names", c.names), json("covariance", c.covariance), json("sigma_px", c.sigma_px), json("rms_px", c.rms_px);
  json("outliers", c.outliers), json("converged", c.converged), json("message", c.message);
  json("tests", Named(c.tests, &CameraTest::name)), json("residuals", c.residuals), json("notes", c.notes);
  if constexpr (Archive::reading) check(c);
}

double Calibration::value(const std::string& name) const { return camera_values(camera)[parameter_index(name)]; }

double Calibration::sigma(const std::string& name) const {
  static_cast<void>(parameter_index(name));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return 0.0;
  const Eigen::Index i = found - names.begin();
  return std::sqrt(covariance(i, i));
}

void write_calibration(const std::filesystem::path& path, const Calibration& calibration) { write_json(path, calibration); }

Calibration read_calibration(const std::filesystem::path& path) { return read_json<Calibration>(path); }

}  // namespace misfit
