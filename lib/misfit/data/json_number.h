#pragma once

// For .cpp files of this layer and above that write or read JSON; no public header includes it.

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/fit.h"

namespace misfit {

using Json = nlohmann::ordered_json;

/// JSON has no nan: a number that is not finite is null.
[[nodiscard]] inline Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
[[nodiscard]] inline Json number_or_null(const std::optional<double>& value) { return value ? number_or_null(*value) : Json(nullptr); }

/// null, or a key that is absent → NaN.
[[nodiscard]] inline double number_or_nan(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? std::numeric_limits<double>::quiet_NaN() : found->get<double>();
}

/// A sigma of 0 means "not estimated" and is written as null: nobody must take it for certainty.
[[nodiscard]] inline Json sigma_or_null(double sigma) { return sigma > 0.0 ? number_or_null(sigma) : Json(nullptr); }

/// {"value","sigma","unit"}, and "interval": [low, high] (95 %) where it is not value ± 1.96 sigma.
[[nodiscard]] inline Json estimate_to_json(const Estimate& estimate) {
  Json object{{"value", number_or_null(estimate.value)}, {"sigma", sigma_or_null(estimate.sigma)}, {"unit", estimate.unit}};
  if (estimate.interval) object["interval"] = {estimate.interval->first, estimate.interval->second};
  return object;
}

[[nodiscard]] inline Estimate estimate_from_json(const Json& object) {
  const double sigma = number_or_nan(object, "sigma");
  Estimate out{number_or_nan(object, "value"), std::isnan(sigma) ? 0.0 : sigma, object.value("unit", "")};
  if (object.contains("interval")) out.interval = object.at("interval").get<std::pair<double, double>>();
  return out;
}

/// {NAME: {"value","sigma","unit"}, …}
[[nodiscard]] inline Json estimates_to_json(const std::map<std::string, Estimate>& estimates) {
  Json object = Json::object();
  for (const auto& [name, estimate] : estimates) object[name] = estimate_to_json(estimate);
  return object;
}

[[nodiscard]] inline std::map<std::string, Estimate> estimates_from_json(const Json& object) {
  std::map<std::string, Estimate> estimates;
  for (const auto& [name, entry] : object.items()) estimates[name] = estimate_from_json(entry);
  return estimates;
}

/// An array with null for every entry that is not finite.
[[nodiscard]] inline Json numbers_to_json(const std::vector<double>& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number_or_null(value));
  return array;
}

[[nodiscard]] inline std::vector<double> numbers_from_json(const Json& array) {
  std::vector<double> values;
  for (const Json& entry : array) values.push_back(entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>());
  return values;
}

[[nodiscard]] inline std::optional<double> optional_from_json(const Json& object, const char* key) {
  const double value = number_or_nan(object, key);
  return std::isnan(value) ? std::nullopt : std::optional<double>(value);
}

/// Reads and parses PATH and hands it to `take`; whatever is wrong with its form is an InputError that names the file.
template <class Take>
[[nodiscard]] auto parsed_file(const std::filesystem::path& path, Take take) {
  const std::string text = read_file(path);
  try {
    return take(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(Source{path.string(), 0, 0}, error.what());
  }
}

}  // namespace misfit
