#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/reference.h"
#include "misfit/data/verdict.h"
#include "misfit/page/places.h"

namespace misfit::page {

// What the page shows of a model, as JSON (json_text.h), from the same figures and blocks as the report.

/// Measured, predicted and residual of every channel by one of the fits, and when it is held out. "", or a method that is not there: the
/// last, whose residuals the other views are about.
[[nodiscard]] std::string motion_view(const Place& place, const std::string& method);
/// Missing force over time; maps over quantities and pairs of them; the names of the quantities.
/// `before`: the model below it on the ladder, whose maps stand beside; nullptr: none.
[[nodiscard]] std::string where_view(const Place& place, const Place* before);
/// Every sample of the missing force against a quantity, in the order of its times: {"t", "values", "figure"}. InputError: no such
/// experiment or quantity.
[[nodiscard]] std::string samples_view(const Diagnosis& diagnosis, std::size_t experiment, std::size_t quantity);
/// The most significant candidate first. `effects`: keys of those that the program can add.
[[nodiscard]] std::string candidates_view(const Place& place, const std::vector<std::string>& effects);
/// The missing force over time with what a candidate adds; `candidate`: its place in the discovery, which candidates_view names.
/// InputError: no such experiment or candidate.
[[nodiscard]] std::string added_view(const Diagnosis& diagnosis, const Discovery& discovery, std::size_t experiment, std::size_t candidate);
/// Of places[model] by every method; dotted: of the models below it by the last method that has the curve. And the numbers
/// that the last method gives.
[[nodiscard]] std::string curves_view(const std::vector<Place>& places, std::size_t model, const std::vector<Reference>& references);
[[nodiscard]] std::string calibration_view(const Place& place);
[[nodiscard]] std::string ladder_view(const std::vector<Place>& places);
/// {"id", "added"} of every model.
[[nodiscard]] std::string models_view(const std::vector<Place>& places);
/// {"opens", "blocks"}: the view that shows what the verdict is about, "where" or "calibration"; what it says.
[[nodiscard]] std::string verdict_view(const Verdict& verdict);
/// What the study has come to, as the report begins; "null" without a fit. `study`, `out`: as commands name them (VerdictInput).
[[nodiscard]] std::string verdict_view(const std::vector<Place>& places, const std::string& study, const std::string& out);

}  // namespace misfit::page
