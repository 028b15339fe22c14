#include "misfit/data/calibration.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

constexpr const char* pinhole_name = "pinhole";
constexpr const char* plane_by_plane_name = "plane_by_plane";

std::size_t parameter_index(const std::string& name) {
  const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
  if (found != camera_parameter_names.end()) return static_cast<std::size_t>(found - camera_parameter_names.begin());
  throw InputError("'" + name + "' is not a camera parameter" +
                   suggest(name, {camera_parameter_names.begin(), camera_parameter_names.end()}));
}

Json numbers_to_json(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double v : values) json.push_back(number_or_null(v));
  return json;
}

double to_number(const Json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

std::vector<double> numbers_from_json(const Json& json) {
  std::vector<double> values;
  for (const Json& v : json) values.push_back(to_number(v));
  return values;
}

Json covariance_to_json(const Eigen::MatrixXd& covariance) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) row.push_back(number_or_null(covariance(i, j)));
    rows.push_back(row);
  }
  return rows;
}

Eigen::MatrixXd covariance_from_json(const Json& rows, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  if (rows.size() != size)
    throw InputError("covariance has " + std::to_string(rows.size()) + " rows for " + std::to_string(size) + " names");
  Eigen::MatrixXd covariance(n, n);
  for (std::size_t i = 0; i < size; ++i) {
    const std::vector<double> row = numbers_from_json(rows[i]);
    if (row.size() != size) throw InputError("covariance row " + std::to_string(i) + " has " + std::to_string(row.size()) + " entries");
    for (std::size_t j = 0; j < size; ++j) covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
  }
  return covariance;
}

Json test_to_json(const CameraTest& test) {
  return {{"parameters", test.parameters},     {"values", numbers_to_json(test.values)},  {"sigmas", numbers_to_json(test.sigmas)},
          {"drop", number_or_null(test.drop)}, {"p_value", number_or_null(test.p_value)}, {"taken_in", test.selected}};
}

CameraTest test_from_json(const std::string& name, const Json& json) {
  CameraTest test;
  test.name = name;
  test.parameters = json.at("parameters").get<std::vector<std::string>>();
  test.values = numbers_from_json(json.at("values"));
  test.sigmas = numbers_from_json(json.at("sigmas"));
  test.drop = to_number(json.at("drop"));
  test.p_value = to_number(json.at("p_value"));
  test.selected = json.at("taken_in").get<bool>();
  return test;
}

Json residual_to_json(const CalibrationResidual& r) {
  return {{"point", r.point},         {"coordinate", std::string(1, r.coordinate)},
          {"theta", r.theta},         {"measured", r.measured},
          {"predicted", r.predicted}, {"used", r.used}};
}

CalibrationResidual residual_from_json(const Json& json) {
  CalibrationResidual r;
  r.point = json.at("point").get<int>();
  r.coordinate = json.at("coordinate").get<std::string>().at(0);
  r.theta = json.at("theta").get<double>();
  r.measured = json.at("measured").get<double>();
  r.predicted = json.at("predicted").get<double>();
  r.used = json.at("used").get<bool>();
  return r;
}

CameraModel model_from_text(const std::string& text) {
  if (text == pinhole_name) return CameraModel::pinhole;
  if (text == plane_by_plane_name) return CameraModel::plane_by_plane;
  throw InputError("model is '" + text + "'" + suggest(text, {pinhole_name, plane_by_plane_name}));
}

Calibration from_json(const Json& json) {
  Calibration c;
  c.model = model_from_text(json.at("model").get<std::string>());
  const auto entries = camera_entries(c.camera);
  for (std::size_t i = 0; i < entries.size(); ++i) *entries[i] = json.at(camera_parameter_names[i]).at("value").get<double>();
  c.names = json.at("names").get<std::vector<std::string>>();
  for (const std::string& name : c.names) static_cast<void>(parameter_index(name));
  c.covariance = covariance_from_json(json.at("covariance"), c.names.size());
  c.sigma_px = json.at("sigma_px").get<double>();
  c.rms_px = json.at("rms_px").get<double>();
  c.outliers = json.at("outliers").get<int>();
  c.converged = json.at("converged").get<bool>();
  c.message = json.at("message").get<std::string>();
  for (const auto& [name, test] : json.at("tests").items()) c.tests.push_back(test_from_json(name, test));
  for (const Json& r : json.at("residuals")) c.residuals.push_back(residual_from_json(r));
  c.notes = json.at("notes").get<std::vector<std::string>>();
  return c;
}

}  // namespace

double Calibration::value(const std::string& name) const { return camera_values(camera)[parameter_index(name)]; }

double Calibration::sigma(const std::string& name) const {
  static_cast<void>(parameter_index(name));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return 0.0;
  const auto i = static_cast<Eigen::Index>(found - names.begin());
  return std::sqrt(covariance(i, i));
}

void write_calibration(const std::filesystem::path& path, const Calibration& c) {
  Json json;
  json["model"] = c.model == CameraModel::pinhole ? pinhole_name : plane_by_plane_name;
  for (std::size_t i = 0; i < camera_parameter_names.size(); ++i) {
    const std::string name = camera_parameter_names[i];
    json[name] = estimate_to_json({c.value(name), c.sigma(name), camera_parameter_units[i]});
  }
  json["names"] = c.names;
  json["covariance"] = covariance_to_json(c.covariance);
  json["sigma_px"] = c.sigma_px;
  json["rms_px"] = c.rms_px;
  json["outliers"] = c.outliers;
  json["converged"] = c.converged;
  json["message"] = c.message;
  json["tests"] = Json::object();
  for (const CameraTest& test : c.tests) json["tests"][test.name] = test_to_json(test);
  json["residuals"] = Json::array();
  for (const CalibrationResidual& r : c.residuals) json["residuals"].push_back(residual_to_json(r));
  json["notes"] = c.notes;
  write_atomically(path, json.dump(1) + "\n");
}

Calibration read_calibration(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return from_json(Json::parse(text));
  } catch (const std::exception& error) {  // the parser's, a missing key's, or one of the InputErrors above: all lack the file's name
    throw InputError(Source{path.string(), 0, 0}, std::string("not a camera.json as misfit writes it: ") + error.what());
  }
}

}  // namespace misfit
