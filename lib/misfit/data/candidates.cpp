#include "misfit/data/candidates.h"

#include "misfit/data/json_fields.h"

namespace misfit {

/// The keys that other programs rely on first, then what this program knows beside them.
template <class Archive>
void fields(Archive& json, MaybeConst<Candidate> auto& c) {
  json("rank", c.rank), json("effect", c.effect), json("ports", c.ports), json("score", c.score);
  json("predicted_drop", c.predicted_drop), json("actual_drop", c.actual_drop);
  json("held_out_gain", c.held_out_gain), json("p_value", c.p_value), json("group", c.group);
  json("accepted", c.accepted), json("why", c.why), json("parameters", c.parameters), json("family", c.family);
  json("roles", c.roles), json("dof", c.dof), json("described", c.described), json("force", c.force);
  json("free", c.free), json("fixed", c.fixed);
  json("refit_values", c.refit_values), json("refit_log_noise", c.refit_log_noise);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Discovery> auto& d) {
  json("verdict", d.verdict), json("sentences", d.sentences), json("tried", d.tried), json("force", d.force);
  json("unexplained_port", d.unexplained_port), json("unexplained_quantity", d.unexplained_quantity);
  json("unexplained_error", d.unexplained_error), json("sweep_asks", d.sweep_asks), json("seconds", d.seconds);
}

std::string effect_at(const std::string& effect, const std::map<std::string, std::string>& roles) {
  std::string bindings;
  for (const auto& [role, target] : roles) bindings += (bindings.empty() ? "" : ", ") + role + " = " + target;
  return bindings.empty() ? effect : effect + " (" + bindings + ")";
}

std::vector<std::string> words_of_place(const Candidate& candidate) {
  std::vector<std::string> out;
  for (const auto& [role, name] : candidate.roles) out.push_back(role + "=" + name);
  return out.empty() ? std::vector<std::string>{"default"} : out;
}

std::string unexplained_place(const Discovery& discovery) {
  return (discovery.unexplained_error ? "an error of " : "a force on ") + discovery.unexplained_port;
}

void write_discovery(const std::filesystem::path& dir, const Discovery& discovery) {
  make_writable_folder(dir);
  write_json(dir / "candidates.json", discovery.candidates);
  write_json(dir / "discovery.json", discovery);
}

Discovery read_discovery(const std::filesystem::path& dir) {
  auto discovery = read_json<Discovery>(dir / "discovery.json");
  discovery.candidates = read_json<std::vector<Candidate>>(dir / "candidates.json");
  return discovery;
}

}  // namespace misfit
