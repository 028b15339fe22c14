#pragma once

#include <string>

#include "misfit/serve/results.h"

namespace misfit::serve {

// What the page shows of a model, as JSON (json_text.h), from the same figures and blocks as the report.

/// Measured, predicted and residual of every channel by one method (place in fits_of()).
[[nodiscard]] std::string motion_view(const Place& place, std::size_t method);
/// Missing force over time; maps over quantities and pairs of them; the names of the quantities.
/// `before`: the model below it on the ladder, whose maps are drawn beside; nullptr: none.
[[nodiscard]] std::string where_view(const Place& place, const Place* before);
/// Every sample of the missing force against a quantity, in the order of its times: {"t", "values", "figure"}. InputError: no such
/// experiment or quantity.
[[nodiscard]] std::string samples_view(const Place& place, std::size_t experiment, std::size_t quantity);
[[nodiscard]] std::string candidates_view(const Place& place, const Registry& registry);
[[nodiscard]] std::string curves_view(const Place& place, const std::vector<Reference>& references);
[[nodiscard]] std::string calibration_view(const Place& place);
[[nodiscard]] std::string ladder_view(const Results& results);
/// What the study has come to, as the report begins. `as_typed`: study and run folder for the command that it names.
[[nodiscard]] std::string verdict_view(const Results& results, const SessionOptions& as_typed);

}  // namespace misfit::serve
