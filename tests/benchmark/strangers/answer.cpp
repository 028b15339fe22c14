#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>

#include "tests/benchmark/strangers/bench.h"

namespace strangers {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json read(const fs::path& file) {
  std::ifstream in(file);
  return in ? json::parse(in, nullptr, false) : json();
}

/// An effect of an input that acts on the input itself, wherever that goes.
bool acts_on_its_input(const json& candidate) {
  const json& roles = candidate["roles"];
  return roles.contains("port") && roles.contains("input") && roles["port"] == roles["input"];
}

/// "key@port;role=value" against a candidate of candidates.json.
bool is_right(const std::string& answer, const json& candidate) {
  const std::size_t at = answer.find('@'), role = std::min(answer.find(';'), answer.size());
  if (answer.substr(0, std::min(at, role)) != candidate["effect"].get<std::string>()) return false;
  const json& ports = candidate["ports"];
  if (at != std::string::npos && !acts_on_its_input(candidate) &&
      (ports.empty() || !ports[0].get<std::string>().starts_with(answer.substr(at + 1, role - at - 1))))
    return false;
  if (role == answer.size()) return true;
  const std::size_t equals = answer.find('=', role);
  const std::string name = answer.substr(role + 1, equals - role - 1), value = answer.substr(equals + 1);
  // The default binding of a role is not written: the first input.
  return candidate["roles"].contains(name) ? candidate["roles"][name] == value : name == "input";
}

bool is_right(const World& world, const json& candidate) {
  return std::any_of(world.hidden.begin(), world.hidden.end(), [&](const Hidden& h) {
    return std::any_of(h.effect.right.begin(), h.effect.right.end(), [&](const std::string& a) { return is_right(a, candidate); });
  });
}

std::string place_of(const json& candidate) {
  std::string text = candidate["effect"];
  if (!candidate["ports"].empty()) text += "@" + candidate["ports"][0].get<std::string>();
  for (const auto& [role, value] : candidate["roles"].items())
    if (role != "port" && role != "output") text += ";" + role + "=" + value.get<std::string>();
  return text;
}

/// Log-likelihood of filter_error; nothing where the fit failed, or leaves out measurements as nonlinear: each counts several units, so
/// that it is no measure for a fit of all of them.
std::optional<double> loglik(const fs::path& study) {
  const json fit = read(study / "out/fit/filter_error/fit.json");
  if (!fit.is_object() || !fit["loglik"].is_number()) return std::nullopt;
  for (const json& warning : fit["warnings"]) {
    if (warning.get<std::string>().find("excluded: the filter's linearisation") != std::string::npos) return std::nullopt;
  }
  return fit["loglik"].get<double>();
}

std::optional<double> fitted(const fs::path& study, const Bench& bench) {
  const Ended ended =
      run({bench.program, "fit", study, "--method", "filter_error", "--threads", std::to_string(bench.threads), "--quiet", "--force"},
          study / "fit.txt", bench);
  return ended.status == 0 ? loglik(study) : std::nullopt;
}

/// What the accepted candidate says of the numbers that were hidden, where it is the hidden effect: those that its `truth` starts at one of
/// them ("limit = {limit}").
json intervals(const Hidden& hidden, const json& candidate) {
  json out = json::array();
  const std::regex start(R"((\w+) = \{(\w+)\})");
  const std::string& text = hidden.effect.truth;
  for (std::sregex_iterator it(text.begin(), text.end(), start), end; it != end; ++it) {
    const std::string name = (*it)[1], drawn = (*it)[2];
    const auto truth = hidden.values.numbers.find(drawn);
    if (truth == hidden.values.numbers.end() || !candidate["parameters"].contains(name)) continue;
    const json& estimate = candidate["parameters"][name];
    if (!estimate["sigma"].is_number() || !(estimate["sigma"] > 0.0)) continue;
    out.push_back({{"name", name}, {"truth", truth->second}, {"value", estimate["value"]}, {"sigma", estimate["sigma"]}});
  }
  return out;
}

void judge(const World& world, const fs::path& study, json& row) {
  const json candidates = read(study / "out/candidates.json"), discovery = read(study / "out/discovery.json");
  const std::string verdict = discovery.value("verdict", "");
  row["says"] = verdict;
  row["verdict"] = verdict.starts_with("Something is missing")       ? "unknown"
                   : verdict.starts_with("No missing effect")        ? "nothing"
                   : verdict.starts_with("No effect accepted")       ? "refused"
                   : verdict.starts_with("No effect of the library") ? "untested"
                                                                     : "other";
  row["candidates"] = candidates.size();
  if (!candidates.is_array() || candidates.empty()) return;
  const json& first = candidates[0];
  row["nearest"] = place_of(first);
  const auto accepted = std::find_if(candidates.begin(), candidates.end(), [](const json& c) { return c["accepted"] == true; });
  if (accepted != candidates.end()) {
    row["verdict"] = "named";
    row["named"] = place_of(*accepted);
    row["gain"] = (*accepted)["held_out_gain"];
    row["drop"] = (*accepted)["actual_drop"];
    row["group"] = (*accepted)["group"];
    row["first"] = is_right(world, *accepted);
    row["in_group"] = row["first"];
    if (row["first"] == true && world.kind == "effect") row["intervals"] = intervals(world.hidden.front(), *accepted);
    for (const json& c : candidates) {
      const std::string at = place_of(c), key = c["effect"];
      const bool grouped = std::any_of(row["group"].begin(), row["group"].end(), [&](const json& g) {
        const std::string name = g.get<std::string>();
        return name.substr(0, name.find(' ')) == key;
      });
      if (grouped && is_right(world, c)) row["in_group"] = true;
    }
  }
  // What became of the right one.
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const json& c = candidates[i];
    if (!is_right(world, c)) continue;
    row["right"] = {{"at", place_of(c)},
                    {"rank", i + 1},
                    {"predicted", c["predicted_drop"]},
                    {"actual", c["actual_drop"]},
                    {"gain", c["held_out_gain"]},
                    {"p", c["p_value"]},
                    {"why", c["why"]}};
    break;
  }
}

void weigh(const World& world, const Bench& bench, const fs::path& dir, json& row) {
  const std::optional<double> without = loglik(dir / "study");
  if (!without || world.kind == "null") return;
  if (write_truth(world, dir)) {
    if (const auto with = fitted(dir / "truth", bench)) row["oracle_drop"] = 2 * (*with - *without);
  }
  if (row.contains("oracle_drop")) return;
  // No effect describes it: how much less likely the recording is than that of the twin.
  write_twin(world, dir);
  if (const auto twin = fitted(dir / "twin", bench)) row["twin_drop"] = 2 * (*twin - *without);
}

}  // namespace

json answer(const World& world, const Bench& bench) {
  const fs::path dir = bench.folder / (world.system->name + "_" + std::to_string(world.seed));
  fs::remove_all(dir);
  json row = {{"system", world.system->name}, {"seed", world.seed},   {"kind", world.kind}, {"samples", world.samples},
              {"step", world.step},           {"noise", world.noise}, {"held", world.held}, {"disturbance", world.disturbance}};
  for (const auto& hidden : world.hidden) {
    row["hidden"].push_back({{"effect", hidden.effect.name}, {"values", hidden.values.numbers}, {"right", hidden.effect.right}});
  }
  if (!write_study(world, bench, dir)) {
    row["verdict"] = "failed";
    row["says"] = "init failed";
    return row;
  }
  const Ended ended = run({bench.program, "discover", dir / "study", "--threads", std::to_string(bench.threads), "--quiet", "--force"},
                          dir / "discover.txt", bench);
  row["seconds"] = ended.seconds;
  row["processor_seconds"] = ended.processor_seconds;
  if (ended.status == 0) {
    judge(world, dir / "study", row);
  } else {
    row["verdict"] = "failed";
    std::ifstream in(dir / "discover.txt");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    row["says"] = ended.status < 0 ? "over the limit of time" : text.substr(text.size() > 600 ? text.size() - 600 : 0);
  }
  weigh(world, bench, dir, row);
  if (!bench.keep) fs::remove_all(dir);
  return row;
}

}  // namespace strangers
