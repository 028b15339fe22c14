#include "misfit/data/comparison.h"

#include <array>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/units.h"
#include "misfit/data/motion_json.h"

namespace misfit {
namespace {

Json degrees_to_json(const std::optional<Estimate>& angle) {
  if (!angle) return nullptr;
  const std::string unit = display_unit(angle->unit);
  return {{"value", number_or_null(convert(angle->value, angle->unit, unit))},
          {"sigma", sigma_or_null(convert(angle->sigma, angle->unit, unit))},
          {"unit", unit}};
}

std::optional<Estimate> degrees_from_json(const Json& object) {
  if (object.is_null()) return std::nullopt;
  Estimate angle = estimate_from_json(object);
  const std::string si = angle.unit == "deg" ? "rad" : angle.unit;
  angle.value = convert(angle.value, angle.unit, si);
  angle.sigma = convert(angle.sigma, angle.unit, si);
  angle.unit = si;
  return angle;
}

Json to_json(const MethodSummary& m) {
  return {{"status", to_string(m.status)},
          {"message", m.message},
          {"driven", m.driven},
          {"trim_deg", degrees_to_json(m.trim)},
          {"slopes", estimates_to_json(m.slopes)},
          {"at_trim", estimates_to_json(m.at_trim)},
          {"rms", estimates_to_json(m.rms)},
          {"validation_rms", estimates_to_json(m.validation_rms)},
          {"loglik", number_or_null(m.loglik)},
          {"validation_loglik", number_or_null(m.validation_loglik)},
          {"parameters", estimates_to_json(m.parameters)}};
}

MethodSummary method_from(const std::string& name, const Json& object) {
  MethodSummary m;
  m.method = name;
  for (const FitStatus status : {FitStatus::converged, FitStatus::not_converged, FitStatus::declined, FitStatus::failed}) {
    if (object.at("status") == to_string(status)) m.status = status;
  }
  m.message = object.at("message");
  m.driven = object.at("driven");
  m.trim = degrees_from_json(object.at("trim_deg"));
  m.slopes = estimates_from_json(object.at("slopes"));
  m.at_trim = estimates_from_json(object.at("at_trim"));
  m.rms = estimates_from_json(object.at("rms"));
  m.validation_rms = estimates_from_json(object.at("validation_rms"));
  const auto number = [&](const char* key) { return object.at(key).is_null() ? std::nullopt : std::optional<double>(object.at(key)); };
  m.loglik = number("loglik");
  m.validation_loglik = number("validation_loglik");
  m.parameters = estimates_from_json(object.at("parameters"));
  return m;
}

Json to_json(const CurveDifference& d) {
  const std::string of_unit = display_unit(d.of_unit);
  const auto shown = [&](double x) { return number_or_null(convert(x, d.of_unit, of_unit)); };
  return {{"curve", d.curve},
          {"of", d.of},
          {"of_unit", of_unit},
          {"a", d.a},
          {"b", d.b},
          {"from", shown(d.from)},
          {"to", shown(d.to)},
          {"points", d.points},
          {"rms_sigmas", number_or_null(d.rms_sigmas)},
          {"max_sigmas", number_or_null(d.max_sigmas)},
          {"at", shown(d.at)},
          {"difference", estimate_to_json(d.difference)}};
}

CurveDifference curve_from(const Json& object, bool reference) {
  CurveDifference d;
  d.curve = object.at("curve");
  d.of = object.at("of");
  const std::string of_unit = object.at("of_unit");
  d.of_unit = of_unit == "deg" ? "rad" : of_unit;
  d.a = object.at("a");
  d.b = object.at("b");
  d.reference = reference;
  d.from = convert(number_or_nan(object, "from"), of_unit, d.of_unit);
  d.to = convert(number_or_nan(object, "to"), of_unit, d.of_unit);
  d.points = object.at("points");
  d.rms_sigmas = number_or_nan(object, "rms_sigmas");
  d.max_sigmas = number_or_nan(object, "max_sigmas");
  d.at = convert(number_or_nan(object, "at"), of_unit, d.of_unit);
  d.difference = estimate_from_json(object.at("difference"));
  d.unit = d.difference.unit;
  return d;
}

Json to_json(const TrimDifference& d) {
  return {{"a", d.a},
          {"b", d.b},
          {"reference", d.reference},
          {"difference_deg", degrees_to_json(d.difference)},
          {"sigmas", number_or_null(d.sigmas)},
          {"sentence", d.sentence}};
}

Json to_json(const ParameterDifference& d) {
  return {{"parameter", d.parameter},
          {"a", d.a},
          {"b", d.b},
          {"difference", estimate_to_json(d.difference)},
          {"sigmas", number_or_null(d.sigmas)},
          {"sentence", d.sentence}};
}

Comparison comparison_from(const Json& root) {
  Comparison c;
  for (const auto& [name, object] : root.at("methods").items()) c.methods.push_back(method_from(name, object));
  for (const Json& object : root.at("curves")) c.curves.push_back(curve_from(object, false));
  for (const Json& object : root.at("references")) c.curves.push_back(curve_from(object, true));
  for (const Json& object : root.at("trims")) {
    const std::optional<Estimate> difference = degrees_from_json(object.at("difference_deg"));
    c.trims.push_back({object.at("a"), object.at("b"), object.at("reference"), difference.value_or(Estimate{}),
                       number_or_nan(object, "sigmas"), object.at("sentence")});
  }
  for (const Json& object : root.at("parameters"))
    c.parameters.push_back({object.at("parameter"), object.at("a"), object.at("b"), estimate_from_json(object.at("difference")),
                            number_or_nan(object, "sigmas"), object.at("sentence")});
  for (const auto& [name, object] : root.at("reference_trims_deg").items()) {
    if (const std::optional<Estimate> trim = degrees_from_json(object)) c.reference_trims[name] = *trim;
  }
  for (const Json& object : root.at("not_compared")) c.not_compared.push_back({object.at("what"), object.at("why")});
  if (root.contains("simulated_motion") && !root.at("simulated_motion").is_null()) c.motion = motion_from_json(root.at("simulated_motion"));
  return c;
}

}  // namespace

void write_comparison(const std::filesystem::path& path, const Comparison& comparison) {
  Json root = {
      {"methods", Json::object()},     {"curves", Json::array()},
      {"references", Json::array()},   {"trims", Json::array()},
      {"parameters", Json::array()},   {"reference_trims_deg", Json::object()},
      {"not_compared", Json::array()}, {"simulated_motion", comparison.motion ? motion_to_json(*comparison.motion) : Json(nullptr)}};
  for (const MethodSummary& m : comparison.methods) root["methods"][m.method] = to_json(m);
  for (const CurveDifference& d : comparison.curves) root[d.reference ? "references" : "curves"].push_back(to_json(d));
  for (const TrimDifference& d : comparison.trims) root["trims"].push_back(to_json(d));
  for (const ParameterDifference& d : comparison.parameters) root["parameters"].push_back(to_json(d));
  for (const auto& [name, trim] : comparison.reference_trims) root["reference_trims_deg"][name] = degrees_to_json(trim);
  for (const NotCompared& n : comparison.not_compared) root["not_compared"].push_back({{"what", n.what}, {"why", n.why}});
  write_atomically(path, root.dump(1) + "\n");
}

Comparison read_comparison(const std::filesystem::path& path) { return parsed_file(path, comparison_from); }

}  // namespace misfit
