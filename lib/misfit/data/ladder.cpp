#include "misfit/data/ladder.h"

#include <algorithm>

#include "misfit/data/candidates.h"
#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

/// A number of a rung, −1 stored as null.
template <class Int>
struct RungId {
  explicit RungId(Int& id_) : id(id_) {}
  [[nodiscard]] Json stored() const { return id < 0 ? Json(nullptr) : Json(id); }
  void restore(const Json& json) const { id = json.is_null() ? -1 : json.get<int>(); }
  Int& id;
};

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<Rung> auto& r) {
  json("id", r.id), json("parent", RungId(r.parent)), json("study", r.study), json("added", r.added);
  json.if_there("roles", r.roles);
  json("predicted_drop", r.predicted_drop), json("actual_drop", r.actual_drop);
  json("held_out_gain", r.held_out_gain), json("force", r.force), json("rms", r.rms);
  json("validation_rms", r.validation_rms), json("system", r.system), json("method", r.method);
  json("loglik", r.loglik), json("validation_loglik", r.validation_loglik);
  json.derived("steps", std::vector<int>(std::begin(kLadderSteps), std::end(kLadderSteps)));
  json("k_step", r.k_step);
  json("trim_deg", Formed(r.trim, [](auto& object, auto& trim) { trim_fields(object, trim); }));
  json("parameters", r.parameters), json("note", r.note);
  json.if_there("estimates", r.estimates), json.if_there("gained_too_little", r.gained_too_little);
  json.if_there("also", r.also), json.if_there("holds", r.holds), json.if_there("new_parameters", r.new_parameters);
  json.if_there("validation_k_step", r.validation_k_step), json.if_there("gain_of_search", r.gain_of_search);
  json.if_there("remained", r.remained), json.if_there("why_too_little", r.why_too_little);
  json.if_there("free_rms", r.free_rms), json.if_there("validation_free_rms", r.validation_free_rms);
  json.if_there("doubts", r.doubts), json.if_there("kept", r.kept), json.if_there("alike", r.alike);
  json.if_there("stays_for_free_run", r.stays_for_free_run);
}

int parameters_added(const Rung& rung) { return rung.new_parameters.value_or(static_cast<int>(rung.parameters.size())); }

bool is_seen_in_measurements(const Rung& rung) { return rung.kept && parameters_added(rung) == 0; }

void describe_added(const Candidate& from, Rung& rung) {
  rung.roles = from.roles;
  rung.also = from.also;
  rung.holds = from.holds;
  rung.remained = from.remaining;
  std::vector<std::string> alike = from.group;
  std::erase(alike, effect_at(from.effect, from.roles));
  if (!alike.empty() && alike.size() < from.group.size()) rung.alike = alike;
}

std::string added_in_words(const Rung& rung) { return effect_at(rung.added, rung.roles.value_or(std::map<std::string, std::string>{})); }

void write_ladder(const std::filesystem::path& path, const Ladder& ladder) { write_json(path, ladder.rungs); }

Ladder read_ladder(const std::filesystem::path& path) { return {read_json<std::vector<Rung>>(path)}; }

}  // namespace misfit
