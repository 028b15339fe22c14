#include "misfit/data/ladder.h"

#include <numbers>

#include "misfit/data/json_number.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Json trim_to_json(const std::optional<Estimate>& trim) {
  if (!trim) return nullptr;
  return {{"value", number_or_null(trim->value / degree)}, {"sigma", sigma_or_null(trim->sigma / degree)}};
}

std::optional<Estimate> trim_from_json(const Json& object) {
  if (object.is_null()) return std::nullopt;
  const Estimate degrees = estimate_from_json(object);
  return Estimate{degrees.value * degree, degrees.sigma * degree, "rad"};
}

Json k_step_to_json(const std::map<std::string, std::vector<double>>& k_step) {
  Json object = Json::object();
  for (const auto& [channel, values] : k_step) object[channel] = numbers_to_json(values);
  return object;
}

Json to_json(const Rung& r) {
  return {{"id", r.id},
          {"parent", r.parent < 0 ? Json(nullptr) : Json(r.parent)},
          {"study", r.study},
          {"added", r.added},
          {"predicted_drop", number_or_null(r.predicted_drop)},
          {"actual_drop", number_or_null(r.actual_drop)},
          {"held_out_gain", number_or_null(r.held_out_gain)},
          {"force", estimates_to_json(r.force)},
          {"rms", estimates_to_json(r.rms)},
          {"validation_rms", estimates_to_json(r.validation_rms)},
          {"system", r.system},
          {"method", r.method},
          {"loglik", number_or_null(r.loglik)},
          {"validation_loglik", number_or_null(r.validation_loglik)},
          {"steps", kLadderSteps},
          {"k_step", k_step_to_json(r.k_step)},
          {"trim_deg", trim_to_json(r.trim)},
          {"parameters", estimates_to_json(r.parameters)},
          {"note", r.note}};
}

Rung rung_from(const Json& object) {
  Rung r;
  r.id = object.at("id");
  r.parent = object.at("parent").is_null() ? -1 : object.at("parent").get<int>();
  r.study = object.at("study");
  r.added = object.at("added");
  r.predicted_drop = optional_from_json(object, "predicted_drop");
  r.actual_drop = optional_from_json(object, "actual_drop");
  r.held_out_gain = optional_from_json(object, "held_out_gain");
  r.force = estimates_from_json(object.at("force"));
  r.rms = estimates_from_json(object.at("rms"));
  r.validation_rms = estimates_from_json(object.at("validation_rms"));
  r.system = object.at("system");
  r.method = object.at("method");
  r.loglik = number_or_nan(object, "loglik");
  r.validation_loglik = optional_from_json(object, "validation_loglik");
  for (const auto& [channel, values] : object.at("k_step").items()) r.k_step[channel] = numbers_from_json(values);
  r.trim = trim_from_json(object.at("trim_deg"));
  r.parameters = estimates_from_json(object.at("parameters"));
  r.note = object.at("note");
  return r;
}

}  // namespace

void write_ladder(const std::filesystem::path& path, const Ladder& ladder) {
  Json array = Json::array();
  for (const auto& rung : ladder.rungs) array.push_back(to_json(rung));
  write_atomically(path, array.dump(1) + "\n");
}

Ladder read_ladder(const std::filesystem::path& path) {
  return parsed_file(path, [](const Json& array) {
    Ladder ladder;
    for (const Json& object : array) ladder.rungs.push_back(rung_from(object));
    return ladder;
  });
}

}  // namespace misfit
