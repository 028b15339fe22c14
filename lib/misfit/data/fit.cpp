#include "misfit/data/fit.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/fit_tables.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

constexpr std::array<const char*, 4> status_names = {"converged", "not_converged", "declined", "failed"};
constexpr double degree = std::numbers::pi / 180.0;

const char* const trim_key = "trim";  // in Fit::plain_sigmas

Json trim_to_json(const Fit& fit) {
  if (!fit.trim) return nullptr;
  Json out{{"value", number_or_null(fit.trim->value / degree)}, {"sigma", sigma_or_null(fit.trim->sigma / degree)}};
  if (const auto plain = fit.plain_sigmas.find(trim_key); plain != fit.plain_sigmas.end())
    out["plain_sigma"] = sigma_or_null(plain->second / degree);
  if (fit.trim->interval) out["interval"] = {fit.trim->interval->first / degree, fit.trim->interval->second / degree};
  return out;
}

Json parameters_to_json(const Fit& fit) {
  Json out = estimates_to_json(fit.parameters);
  for (const auto& [name, sigma] : fit.plain_sigmas) {
    if (out.contains(name)) out[name]["plain_sigma"] = sigma_or_null(sigma);
  }
  return out;
}

std::map<std::string, double> plain_sigmas_from(const Json& root) {
  std::map<std::string, double> out;
  for (const auto& [name, object] : root.at("parameters").items()) {
    if (object.contains("plain_sigma")) out[name] = number_or_nan(object, "plain_sigma");
  }
  const Json& trim = root.at("trim_deg");
  if (trim.is_object() && trim.contains("plain_sigma")) out[trim_key] = number_or_nan(trim, "plain_sigma") * degree;
  return out;
}

std::optional<Estimate> trim_from_json(const Json& object) {
  if (object.is_null()) return std::nullopt;
  const Estimate degrees = estimate_from_json(object);
  Estimate out{degrees.value * degree, degrees.sigma * degree, "rad"};
  if (degrees.interval) out.interval = {degrees.interval->first * degree, degrees.interval->second * degree};
  return out;
}

Json to_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(number_or_null(matrix(i, j)));
    rows.push_back(std::move(row));
  }
  return rows;
}

Eigen::MatrixXd matrix_from(const Json& rows) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const Json& entry = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
      matrix(i, j) = entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>();
    }
  }
  return matrix;
}

Json curves_to_json(const std::vector<CurveEstimate>& curves) {
  Json object = Json::array();
  for (const CurveFile& file : curve_files(curves)) {
    for (const std::size_t k : file.curves) {
      const CurveEstimate& curve = curves[k];
      object.push_back({{"name", curve.name},
                        {"of", curve.of},
                        {"of_unit", curve.of_unit},
                        {"unit", curve.unit},
                        {"informative", curve.informative},
                        {"trimmed", curve.trimmed},
                        {"why", curve.why},
                        {"file", file.name}});
    }
  }
  return object;
}

std::vector<CurveEstimate> curves_from(const Json& array) {
  std::vector<CurveEstimate> curves;
  for (const Json& object : array) {
    CurveEstimate curve;
    curve.name = object.at("name");
    curve.of = object.at("of");
    curve.of_unit = object.at("of_unit");
    curve.unit = object.at("unit");
    curve.informative = object.at("informative");
    curve.trimmed = object.value("trimmed", false);
    curve.why = object.at("why");
    curves.push_back(std::move(curve));
  }
  return curves;
}

Json predictions_to_json(const std::vector<ChannelPrediction>& predictions) {
  Json array = Json::array();
  for (const ChannelPrediction& p : predictions) {
    array.push_back({{"experiment", p.experiment}, {"channel", p.channel}, {"unit", p.unit}});
  }
  return array;
}

std::vector<ChannelPrediction> predictions_from(const Json& array) {
  std::vector<ChannelPrediction> predictions;
  for (const Json& object : array) {
    ChannelPrediction p;
    p.experiment = object.at("experiment");
    p.channel = object.at("channel");
    p.unit = object.at("unit");
    predictions.push_back(std::move(p));
  }
  return predictions;
}

Json fit_to_json(const Fit& fit) {
  return {{"method", fit.method},
          {"status", to_string(fit.status)},
          {"message", fit.message},
          {"warnings", fit.warnings},
          {"driven", fit.driven},
          {"parameters", parameters_to_json(fit)},
          {"noise", estimates_to_json(fit.noise)},
          {"force", estimates_to_json(fit.force)},
          {"loglik", number_or_null(fit.loglik)},
          {"validation_loglik", number_or_null(fit.validation_loglik)},
          {"trim_deg", trim_to_json(fit)},
          {"rms", estimates_to_json(fit.rms)},
          {"validation_rms", estimates_to_json(fit.validation_rms)},
          {"seconds", number_or_null(fit.seconds)},
          {"linearisations", fit.linearisations},
          {"facts", fit.facts},
          {"curves", curves_to_json(fit.curves)},
          {"predictions", predictions_to_json(fit.predictions)},
          {"names", fit.names},
          {"covariance", to_json(fit.covariance)}};
}

FitStatus status_from(const std::string& name) {
  for (std::size_t k = 0; k < status_names.size(); ++k) {
    if (name == status_names[k]) return static_cast<FitStatus>(k);
  }
  throw InputError("status '" + name + "'" + suggest(name, {status_names.begin(), status_names.end()}));
}

std::optional<double> optional_number(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

Fit fit_from_json(const Json& root) {
  Fit fit;
  fit.method = root.at("method");
  fit.status = status_from(root.at("status"));
  fit.message = root.at("message");
  fit.warnings = root.at("warnings").get<std::vector<std::string>>();
  fit.driven = root.at("driven");
  fit.parameters = estimates_from_json(root.at("parameters"));
  fit.noise = estimates_from_json(root.at("noise"));
  fit.force = estimates_from_json(root.at("force"));
  fit.loglik = optional_number(root.at("loglik"));
  fit.validation_loglik = optional_number(root.at("validation_loglik"));
  fit.trim = trim_from_json(root.at("trim_deg"));
  fit.plain_sigmas = plain_sigmas_from(root);
  fit.rms = estimates_from_json(root.at("rms"));
  fit.validation_rms = estimates_from_json(root.at("validation_rms"));
  fit.seconds = number_or_nan(root, "seconds");
  fit.linearisations = root.at("linearisations");
  fit.facts = root.at("facts").get<std::map<std::string, std::string>>();
  fit.curves = curves_from(root.at("curves"));
  fit.predictions = predictions_from(root.at("predictions"));
  fit.names = root.at("names").get<std::vector<std::string>>();
  fit.covariance = matrix_from(root.at("covariance"));
  return fit;
}

}  // namespace

std::string to_string(FitStatus status) { return status_names.at(static_cast<std::size_t>(status)); }

void write_fit(const std::filesystem::path& dir, const Fit& fit) {
  make_writable_folder(dir);
  for (const CurveFile& file : curve_files(fit.curves)) write_curves(dir / file.name, fit.curves, file);
  for (const PredictionFile& file : prediction_files(fit.predictions)) write_predictions(dir / file.name, fit.predictions, file);
  write_atomically(dir / "fit.json", fit_to_json(fit).dump(1) + "\n");
}

Fit read_fit(const std::filesystem::path& dir) {
  const std::filesystem::path path = dir / "fit.json";
  Fit fit;
  try {
    fit = fit_from_json(Json::parse(read_file(path)));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(Source{path.string(), 0, 0}, error.what());
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.find(path.string()) != std::string::npos) throw;
    throw InputError(Source{path.string(), 0, 0}, what);
  }
  for (const CurveFile& file : curve_files(fit.curves)) read_curves(dir / file.name, fit.curves, file);
  for (const PredictionFile& file : prediction_files(fit.predictions)) read_predictions(dir / file.name, fit.predictions, file);
  return fit;
}

}  // namespace misfit
