#include "misfit/calibrate/camera_from_study.h"

#include "misfit/calibrate/groups.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"

namespace misfit {

Calibration camera_from_study(CameraModel model, const std::map<std::string, config::Number>& given) {
  for (const char* name : {"h_c", "K"}) {
    if (!given.contains(name)) throw InputError(std::string("[camera] gives no sweep, so it must give ") + name);
  }
  Calibration calibration;
  calibration.model = model;
  calibration.converged = true;
  calibration.message = "given by the study";
  const auto entries = camera_entries(calibration.camera);
  std::vector<double> variances;
  for (const auto& [name, number] : given) *entries[camera_parameter(name)] = number.value;
  for (const char* name : camera_parameter_names) {
    const auto found = given.find(name);
    if (found == given.end()) continue;
    const double sigma = found->second.sigma.value_or(0.0);
    if (sigma < 0.0)
      throw InputError(found->second.where, std::string(name) + ": sigma is " + format_value(sigma) + ", it cannot be negative");
    if (sigma == 0.0) {
      calibration.notes.push_back(std::string(name) + " is given without sigma and treated as exact");
      continue;
    }
    calibration.names.emplace_back(name);
    variances.push_back(sigma * sigma);
  }
  const config::Number& K = given.at("K");
  if (!(K.value > 0.0)) throw InputError(K.where, "K is " + format_value(K.value) + " px/m, it must be positive");
  calibration.covariance = Eigen::Map<Eigen::VectorXd>(variances.data(), variances.size()).asDiagonal();
  return calibration;
}

}  // namespace misfit
