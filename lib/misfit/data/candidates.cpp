#include "misfit/data/candidates.h"

#include "misfit/data/json_number.h"

namespace misfit {
namespace {

/// The keys that other programs rely on first, then what this program knows beside them.
Json to_json(const Candidate& c) {
  return {{"rank", c.rank},
          {"effect", c.effect},
          {"ports", c.ports},
          {"score", number_or_null(c.score)},
          {"predicted_drop", number_or_null(c.predicted_drop)},
          {"actual_drop", number_or_null(c.actual_drop)},
          {"held_out_gain", number_or_null(c.held_out_gain)},
          {"p_value", number_or_null(c.p_value)},
          {"group", c.group},
          {"accepted", c.accepted},
          {"why", c.why},
          {"parameters", estimates_to_json(c.parameters)},
          {"family", c.family},
          {"roles", c.roles},
          {"dof", c.dof},
          {"described", c.described},
          {"force", estimates_to_json(c.force)}};
}

Candidate candidate_from(const Json& object) {
  Candidate c;
  c.rank = object.at("rank");
  c.effect = object.at("effect");
  c.ports = object.at("ports").get<std::vector<std::string>>();
  c.score = number_or_nan(object, "score");
  c.predicted_drop = number_or_nan(object, "predicted_drop");
  c.actual_drop = optional_from_json(object, "actual_drop");
  c.held_out_gain = optional_from_json(object, "held_out_gain");
  c.p_value = number_or_nan(object, "p_value");
  c.group = object.at("group").get<std::vector<std::string>>();
  c.accepted = object.at("accepted");
  c.why = object.at("why");
  c.parameters = estimates_from_json(object.at("parameters"));
  c.family = object.at("family");
  c.roles = object.at("roles").get<std::map<std::string, std::string>>();
  c.dof = object.at("dof");
  c.described = object.at("described");
  c.force = estimates_from_json(object.at("force"));
  return c;
}

}  // namespace

std::string effect_at(const std::string& effect, const std::map<std::string, std::string>& roles) {
  std::string bindings;
  for (const auto& [role, target] : roles) bindings += (bindings.empty() ? "" : ", ") + role + " = " + target;
  return bindings.empty() ? effect : effect + " (" + bindings + ")";
}

void write_discovery(const std::filesystem::path& dir, const Discovery& discovery) {
  make_writable_folder(dir);
  Json candidates = Json::array();
  for (const auto& candidate : discovery.candidates) candidates.push_back(to_json(candidate));
  const Json root = {{"verdict", discovery.verdict},       {"sentences", discovery.sentences},
                     {"tried", discovery.tried},           {"force", estimates_to_json(discovery.force)},
                     {"sweep_asks", discovery.sweep_asks}, {"seconds", number_or_null(discovery.seconds)}};
  write_atomically(dir / "candidates.json", candidates.dump(1) + "\n");
  write_atomically(dir / "discovery.json", root.dump(1) + "\n");
}

Discovery read_discovery(const std::filesystem::path& dir) {
  Discovery discovery = parsed_file(dir / "discovery.json", [](const Json& root) {
    Discovery d;
    d.verdict = root.at("verdict");
    d.sentences = root.at("sentences").get<std::vector<std::string>>();
    d.tried = root.at("tried").get<std::vector<std::string>>();
    d.force = estimates_from_json(root.at("force"));
    d.sweep_asks = root.value("sweep_asks", std::vector<std::string>{});
    d.seconds = number_or_nan(root, "seconds");
    return d;
  });
  discovery.candidates = parsed_file(dir / "candidates.json", [](const Json& array) {
    std::vector<Candidate> candidates;
    for (const Json& object : array) candidates.push_back(candidate_from(object));
    return candidates;
  });
  return discovery;
}

}  // namespace misfit
