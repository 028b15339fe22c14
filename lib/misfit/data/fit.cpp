#include "misfit/data/fit.h"

#include <cmath>

#include "misfit/core/enum_name.h"
#include "misfit/core/text.h"
#include "misfit/data/fit_tables.h"
#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

constexpr const char* trim_key = "trim";  // in Fit::plain_sigmas

/// A parameter with its sigma had the residuals been white, where it is distinguished.
struct StoredParameter {
  Estimate estimate;
  std::optional<double> plain_sigma;
};

std::optional<double> plain_sigma_of(const Fit& fit, const std::string& name, double unit = 1.0) {
  const auto found = fit.plain_sigmas.find(name);
  if (found == fit.plain_sigmas.end()) return std::nullopt;
  return found->second > 0.0 ? found->second / unit : std::numeric_limits<double>::quiet_NaN();
}

std::map<std::string, StoredParameter> stored_parameters(const Fit& fit) {
  std::map<std::string, StoredParameter> out;
  for (const auto& [name, estimate] : fit.parameters) out[name] = {estimate, plain_sigma_of(fit, name)};
  return out;
}

void restore_parameters(const std::map<std::string, StoredParameter>& stored, Fit& fit) {
  for (const auto& [name, parameter] : stored) {
    fit.parameters[name] = parameter.estimate;
    if (parameter.plain_sigma) fit.plain_sigmas[name] = *parameter.plain_sigma;
  }
}

template <class Archive>
void interval_in_degrees(Archive& json, MaybeConst<Estimate> auto& trim) {
  auto interval = trim.interval;
  if (interval) interval = {interval->first / kDegree, interval->second / kDegree};
  json.if_there("interval", interval);
  if constexpr (Archive::reading) {
    if (interval) trim.interval = {interval->first * kDegree, interval->second * kDegree};
  }
}

constexpr const char* roughness_file = "roughness.json";  // apart, since nobody reads its numbers

struct RoughnessPaths {
  std::vector<RoughnessPath> all;
};

/// The curves in the order of their files, with the names of these.
Json curves_to_json(const std::vector<CurveEstimate>& curves) {
  Json array = Json::array();
  for (const CurveFile& file : curve_files(curves)) {
    for (const std::size_t k : file.curves) {
      array.push_back(JsonWriter::json_of(curves[k]));
      array.back()["file"] = file.name;
    }
  }
  return array;
}

}  // namespace

/// Without the points, which are in a table beside.
template <class Archive>
void fields(Archive& json, MaybeConst<CurveEstimate> auto& curve) {
  json("name", curve.name), json("of", curve.of), json("of_unit", curve.of_unit), json("unit", curve.unit);
  json("informative", curve.informative), json("trimmed", curve.trimmed), json("why", curve.why);
}

template <class Archive>
void fields(Archive& json, MaybeConst<CurvesByRoughness> auto& curve) {
  json("name", curve.name), json("of", curve.of), json("of_unit", curve.of_unit), json("unit", curve.unit);
  json("x", curve.x), json("values", curve.values);
}

template <class Archive>
void fields(Archive& json, MaybeConst<RoughnessPath> auto& path) {
  json("curve", path.curve), json("unit", path.unit), json("used", path.used), json("chosen", path.chosen);
  json("roughness", path.roughness), json("log_likelihood", path.log_likelihood), json("curves", path.curves);
}

template <class Archive>
void fields(Archive& json, MaybeConst<StoredParameter> auto& p) {
  fields(json, p.estimate);
  json.if_there("plain_sigma", p.plain_sigma);
}

template <class Archive>
void fields(Archive& json, MaybeConst<ChannelPrediction> auto& p) {
  json("experiment", p.experiment), json("channel", p.channel), json("unit", p.unit);
  json.if_there("rms", p.rms), json.if_there("nrmse", p.nrmse);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Fit> auto& fit) {
  std::map<std::string, StoredParameter> parameters = stored_parameters(fit);
  std::optional<double> plain_sigma = plain_sigma_of(fit, trim_key, kDegree);
  json("method", fit.method), json("status", NameOf(fit.status, fit_status_names)), json("message", fit.message);
  json("warnings", fit.warnings), json.if_there("doubts", fit.doubts);
  json("driven", fit.driven), json("coloured", fit.coloured), json("parameters", parameters);
  json("noise", fit.noise), json("force", fit.force), json("loglik", fit.loglik);
  json("validation_loglik", fit.validation_loglik);
  json("trim_deg", Formed(fit.trim, [&](auto& object, auto& trim) {
         trim_fields(object, trim);
         object.if_there("plain_sigma", plain_sigma);
         interval_in_degrees(object, trim);
       }));
  json("rms", fit.rms), json("validation_rms", fit.validation_rms), json("seconds", fit.seconds);
  json("linearisations", fit.linearisations), json("facts", fit.facts);
  if constexpr (Archive::reading) {
    json("curves", fit.curves);
  } else {
    json("curves", curves_to_json(fit.curves));
  }
  json("predictions", fit.predictions), json("names", fit.names), json("covariance", fit.covariance);
  if constexpr (Archive::reading) {
    restore_parameters(parameters, fit);
    if (plain_sigma) fit.plain_sigmas[trim_key] = *plain_sigma * kDegree;
  }
}

template <class Archive>
void fields(Archive& json, MaybeConst<RoughnessPaths> auto& paths) {
  json("roughness", paths.all);
}

std::string share_of_motion_in_words(double nrmse) {
  const double percent = 100.0 * nrmse, step = std::pow(10.0, std::floor(std::log10(percent)) - 1.0);
  return format_value(percent > 0.0 ? std::round(percent / step) * step : 0.0) + " % of the motion";
}

void Fit::add_doubt(const std::string& clause, const std::string& more) {
  if (!doubts) doubts.emplace();
  doubts->push_back(clause);
  warnings.push_back(clause + more);
}

std::string to_string(FitStatus status) { return enum_name(fit_status_names, status); }

void write_fit(const std::filesystem::path& dir, const Fit& fit) {
  make_writable_folder(dir);
  for (const CurveFile& file : curve_files(fit.curves)) write_curves(dir / file.name, fit.curves, file);
  for (const PredictionFile& file : prediction_files(fit.predictions)) write_predictions(dir / file.name, fit.predictions, file);
  if (fit.roughness.empty()) {
    std::filesystem::remove(dir / roughness_file);  // of an earlier fit
  } else {
    write_json(dir / roughness_file, RoughnessPaths{fit.roughness});
  }
  write_json(dir / "fit.json", fit);
}

Fit read_fit(const std::filesystem::path& dir) {
  Fit fit = read_json<Fit>(dir / "fit.json");
  for (const CurveFile& file : curve_files(fit.curves)) read_curves(dir / file.name, fit.curves, file);
  for (const PredictionFile& file : prediction_files(fit.predictions)) read_predictions(dir / file.name, fit.predictions, file);
  if (std::filesystem::exists(dir / roughness_file)) fit.roughness = read_json<RoughnessPaths>(dir / roughness_file).all;
  return fit;
}

}  // namespace misfit
