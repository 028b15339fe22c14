#pragma once

// For .cpp files of this layer and above that write or read JSON; no public header includes it.

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

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

/// {"value","sigma","unit"}
[[nodiscard]] inline Json estimate_to_json(const Estimate& estimate) {
  return {{"value", number_or_null(estimate.value)}, {"sigma", sigma_or_null(estimate.sigma)}, {"unit", estimate.unit}};
}

[[nodiscard]] inline Estimate estimate_from_json(const Json& object) {
  const double sigma = number_or_nan(object, "sigma");
  return {number_or_nan(object, "value"), std::isnan(sigma) ? 0.0 : sigma, object.value("unit", "")};
}

}  // namespace misfit
