#include "misfit/data/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/display.h"
#include "misfit/core/enum_name.h"
#include "misfit/core/file_name.h"
#include "misfit/core/table.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// A column of added_force.csv.
struct ForceColumn {
  int rank = 0;
  std::string port, unit;

  [[nodiscard]] std::string name() const { return std::to_string(rank) + " " + port; }
};

/// What discovery.json says of the forces of one experiment, whose numbers are in a table.
struct AddedForceTable {
  std::string experiment, file;
  std::vector<ForceColumn> columns;
};

/// discovery.json.
struct StoredDiscovery {
  Discovery discovery;
  std::vector<AddedForceTable> added;
};

}  // namespace

/// The keys that other programs rely on first, then what this program knows beside them.
template <class Archive>
void fields(Archive& json, MaybeConst<Candidate> auto& c) {
  json("rank", c.rank), json("effect", c.effect), json("ports", c.ports), json("score", c.score);
  json("predicted_drop", c.predicted_drop), json("actual_drop", c.actual_drop);
  json("held_out_gain", c.held_out_gain), json("p_value", c.p_value), json("group", c.group);
  json.if_there("also", c.also), json.if_there("holds", c.holds), json.if_there("remaining", c.remaining),
      json.if_there("grows_ahead", c.grows_ahead);
  json("accepted", c.accepted), json("why", c.why), json("parameters", c.parameters),
      json("family", NameOf(c.family, candidate_family_names));
  json("roles", c.roles), json("dof", c.dof), json("described", c.absorbed), json("force", c.force);
  json("held", c.fixed_in_model), json("free", c.free), json("fixed", c.fixed);
  json("refit_values", c.refit_values), json("refit_log_noise", c.refit_log_noise);
}

template <class Archive>
void fields(Archive& json, MaybeConst<EffectPlace> auto& place) {
  json("effect", place.effect), json("roles", place.roles);
}

template <class Archive>
void fields(Archive& json, MaybeConst<NotTried> auto& effect) {
  json("effect", effect.place.effect), json("roles", effect.place.roles), json("reason", effect.reason);
}

template <class Archive>
void fields(Archive& json, MaybeConst<ForceColumn> auto& column) {
  json("rank", column.rank), json("port", column.port), json("unit", column.unit);
}

template <class Archive>
void fields(Archive& json, MaybeConst<AddedForceTable> auto& table) {
  json("experiment", table.experiment), json("file", table.file), json("columns", table.columns);
}

template <class Archive>
void fields(Archive& json, MaybeConst<StoredDiscovery> auto& stored) {
  auto& d = stored.discovery;
  json("outcome", NameOf(d.outcome, search_outcome_names));
  json("verdict", d.verdict), json("sentences", d.sentences), json("tried", d.tried), json("not_tried", d.not_tried),
      json("force", d.force);
  json("unexplained_port", d.unexplained_port), json("unexplained_quantity", d.unexplained_quantity);
  json("unexplained_effects", d.unexplained_effects), json("unexplained_error", d.unexplained_error),
      json("unexplained_parameter", d.unexplained_parameter), json("unexplained_alike", d.unexplained_alike),
      json("held", d.fixed_parameters), json("sweep_asks", d.sweep_asks), json("added_force", stored.added);
  json("seconds", d.seconds);
}

std::string to_string(CandidateFamily family) { return enum_name(candidate_family_names, family); }

std::string effect_at(const std::string& effect, const std::map<std::string, std::string>& roles) {
  std::string bindings;
  for (const auto& [role, target] : roles) bindings += (bindings.empty() ? "" : ", ") + role + " = " + target;
  return bindings.empty() ? effect : effect + " (" + bindings + ")";
}

std::vector<std::string> words_of_place(const std::map<std::string, std::string>& roles) {
  std::vector<std::string> out;
  for (const auto& [role, name] : roles) out.push_back(role + "=" + name);
  return out.empty() ? std::vector<std::string>{"default"} : out;
}

std::string parameters_in_words(const Candidate& candidate) {
  constexpr double none = 1e9;  // an effect's way to say that it has no such limit
  std::vector<std::string> out;
  for (const auto& [name, e] : candidate.parameters) {
    if (!(e.sigma > 0.0) && std::abs(e.value) >= none) continue;
    const bool held = std::any_of(candidate.fixed.begin(), candidate.fixed.end(),
                                  [&, own = name](const std::string& fixed) { return own == fixed || own.ends_with("." + fixed); });
    out.push_back(name + " = " + in_display_unit(e.value, e.unit, e.sigma) + (held ? " (fixed)" : ""));
  }
  return join_words(out);
}

std::string best_rejected(const Candidate& candidate) {
  return "best candidate " + effect_at(candidate.effect, candidate.roles) + " (drop " +
         format_value(candidate.actual_drop.value_or(std::numeric_limits<double>::quiet_NaN())) + ", family-wise " +
         p_equals(candidate.p_value) + "), rejected: " + candidate.why;
}

bool shows_that_something_is_missing(const Candidate& rejected) {
  constexpr double certain = 1e-4;
  return rejected.p_value < certain;
}

namespace {

bool is_tested_curve(const Candidate& c) { return c.family == CandidateFamily::unknown && !c.absorbed; }
bool is_tested_effect(const Candidate& c) { return c.family != CandidateFamily::unknown && !c.absorbed; }

/// Of the same change of a parameter with the same quantity a curve is the whole, and the line or exponential that falls short a part.
bool is_part_of_unexplained(const Candidate& c, const Discovery& discovery) {
  return discovery.unexplained_parameter &&
         std::any_of(c.roles.begin(), c.roles.end(), [&](const auto& role) { return role.second == discovery.unexplained_quantity; });
}

/// On the port of what is unexplained. Of an error of an output a force, too: what a force leaves looks like one.
bool acts_where_it_fails(const Candidate& c, const Discovery& discovery) {
  const bool there = std::find(c.ports.begin(), c.ports.end(), discovery.unexplained_port) != c.ports.end();
  return there || (discovery.unexplained_error && c.family != CandidateFamily::sensor);
}

/// Does a curve of unknown form explain more than this candidate (more than twice as much, where none can be added in its place), or a
/// refitted candidate more than twice as much?
bool is_past_a_larger_one(const Candidate& candidate, const Discovery& discovery) {
  const double drop = *candidate.actual_drop, of_curve = discovery.unexplained_effects.empty() ? 2.0 * drop : drop;
  return std::any_of(discovery.candidates.begin(), discovery.candidates.end(), [&](const Candidate& c) {
    return is_tested_curve(c) ? c.score - 2.0 * c.dof > of_curve : c.actual_drop && *c.actual_drop > 2.0 * drop;
  });
}

}  // namespace

std::size_t effects_tested(const Discovery& discovery) {
  return static_cast<std::size_t>(std::count_if(discovery.candidates.begin(), discovery.candidates.end(), is_tested_effect));
}

std::size_t curves_tested(const Discovery& discovery) {
  return static_cast<std::size_t>(std::count_if(discovery.candidates.begin(), discovery.candidates.end(), is_tested_curve));
}

std::string unknown_curve_key(const std::string& port, const std::string& quantity) { return "unknown:" + port + "(" + quantity + ")"; }

double gain_in_all(const Candidate& candidate) { return 0.5 * candidate.actual_drop.value_or(0.0) + candidate.held_out_gain.value_or(0.0); }

const Candidate* candidate_to_begin_with(const Discovery& discovery) {
  const Candidate* best = nullptr;
  for (const Candidate& c : discovery.candidates) {
    if (!acts_where_it_fails(c, discovery) || is_part_of_unexplained(c, discovery) || !c.remaining || !c.actual_drop || !c.held_out_gain)
      continue;
    if (best == nullptr || gain_in_all(c) > gain_in_all(*best)) best = &c;
  }
  return best == nullptr || is_past_a_larger_one(*best, discovery) ? nullptr : best;
}

std::optional<Candidate> candidate_after_the_curve(const Discovery& discovery) {
  Discovery others = discovery;
  others.unexplained_effects.clear();
  const std::string in_vain = unknown_curve_key(discovery.unexplained_port, discovery.unexplained_quantity);
  std::erase_if(others.candidates, [&](const Candidate& c) { return c.effect == in_vain; });
  const Candidate* best = candidate_to_begin_with(others);
  return best == nullptr ? std::nullopt : std::optional(*best);
}

const Candidate* candidate_short_ahead(const Discovery& discovery) {
  constexpr double most_growth = 2.0;
  const Candidate* best = nullptr;
  for (const Candidate& c : discovery.candidates) {
    if (c.accepted) return nullptr;
    if (!c.actual_drop || !c.held_out_gain) continue;
    if (best == nullptr || gain_in_all(c) > gain_in_all(*best)) best = &c;
  }
  if (best == nullptr || !best->grows_ahead || *best->grows_ahead > most_growth) return nullptr;
  return is_past_a_larger_one(*best, discovery) ? nullptr : best;
}

std::vector<Candidate> candidates_beside(const Discovery& discovery) {
  constexpr std::size_t most = 3;
  std::vector<Candidate> out;
  for (const Candidate& c : discovery.candidates) {
    if (is_tested_effect(c) && (c.accepted || c.remaining) && c.actual_drop && c.held_out_gain.value_or(0.0) > 0.0) out.push_back(c);
  }
  std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return gain_in_all(a) > gain_in_all(b); });
  if (out.size() > most) out.resize(most);
  return out;
}

std::string tested_in_words(const Discovery& discovery) {
  std::set<std::string> effects;
  for (const Candidate& c : discovery.candidates) {
    if (is_tested_effect(c)) effects.insert(c.effect);
  }
  std::vector<std::string> out;
  const std::size_t places = effects_tested(discovery), curves = curves_tested(discovery);
  if (places > 0)
    out.push_back(counted(effects.size(), "effect", "effects") + (places > effects.size() ? fmt::format(" at {} places", places) : ""));
  if (curves > 0) out.push_back(counted(curves, "curve of unknown form", "curves of unknown form"));
  return join_words(out);
}

std::vector<std::string> not_tried_in_words(const Discovery& discovery) {
  std::vector<std::string> out;
  for (const NotTried& n : discovery.not_tried) out.push_back(effect_at(n.place.effect, n.place.roles) + ": not tried: " + n.reason);
  return out;
}

std::string unexplained_place(const std::string& port, bool error, bool parameter) {
  const char* what = error ? "an error of " : parameter ? "a change of " : "a force on ";
  return what + port;
}

std::string unexplained_place(const Discovery& discovery) {
  return unexplained_place(discovery.unexplained_port, discovery.unexplained_error, discovery.unexplained_parameter);
}

namespace {

std::vector<std::string> experiments_of(const Discovery& discovery) {
  std::vector<std::string> out;
  for (const Candidate& c : discovery.candidates) {
    for (const AddedForce& added : c.added) {
      if (std::find(out.begin(), out.end(), added.experiment) == out.end()) out.push_back(added.experiment);
    }
  }
  return out;
}

/// Refits are of the same measurements, so that all have the same times.
AddedForceTable write_added(const fs::path& dir, const Discovery& discovery, const std::string& experiment, const std::string& file) {
  AddedForceTable out{experiment, file, {}};
  Table table;
  for (const Candidate& c : discovery.candidates) {
    for (const AddedForce& added : c.added) {
      if (added.experiment != experiment) continue;
      if (table.columns.empty()) table.add("t", "s", added.t);
      if (added.t.size() != table.rows()) continue;
      for (std::size_t p = 0; p < added.ports.size(); ++p) {
        out.columns.push_back({c.rank, added.ports[p], added.port_units[p]});
        table.add(out.columns.back().name(), display_unit(added.port_units[p]), display_values(added.force[p], added.port_units[p]));
      }
    }
  }
  constexpr int digits = 8;  // of a drawing over a long time
  write_csv(dir / file, table, digits);
  return out;
}

void read_added(const fs::path& dir, const AddedForceTable& stored, Discovery& discovery) {
  const Table table = read_csv(dir / stored.file);
  for (Candidate& c : discovery.candidates) {
    AddedForce added{stored.experiment, table.values("t", "s"), {}, {}, {}};
    for (const ForceColumn& column : stored.columns) {
      if (column.rank != c.rank) continue;
      added.ports.push_back(column.port);
      added.port_units.push_back(column.unit);
      added.force.push_back(table.values(column.name(), column.unit));
    }
    if (!added.ports.empty()) c.added.push_back(std::move(added));
  }
}

}  // namespace

void write_discovery(const fs::path& dir, const Discovery& discovery) {
  make_writable_folder(dir);
  StoredDiscovery stored{discovery, {}};
  const std::vector<std::string> experiments = experiments_of(discovery);
  for (std::size_t k = 0; k < experiments.size(); ++k)
    stored.added.push_back(write_added(dir, discovery, experiments[k], "added_force" + file_suffix(k, experiments[k]) + ".csv"));
  write_json(dir / "candidates.json", discovery.candidates);
  write_json(dir / "discovery.json", stored);
}

Discovery read_discovery(const fs::path& dir) {
  auto stored = read_json<StoredDiscovery>(dir / "discovery.json");
  stored.discovery.candidates = read_json<std::vector<Candidate>>(dir / "candidates.json");
  for (const AddedForceTable& table : stored.added) read_added(dir, table, stored.discovery);
  return std::move(stored.discovery);
}

}  // namespace misfit
