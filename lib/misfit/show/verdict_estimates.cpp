#include "misfit/show/verdict_estimates.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/text.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

std::string values_of(const Estimates& parameters) {
  std::vector<std::string> out;
  for (const auto& [name, e] : parameters) out.push_back(name + " = " + shown(e));
  return join_words(out);
}

/// What the last model estimates beside what was added.
Estimates others_of_last(const Ladder& ladder) {
  const Rung& last = ladder.rungs.back();
  Estimates out = last.estimates.value_or(Estimates{});
  for (const Rung& rung : ladder.rungs) {
    if (rung.added.empty()) continue;
    for (const auto& [name, estimate] : rung.parameters) out.erase(name);
  }
  return out;
}

}  // namespace

std::string numbers_of(const Estimates& parameters) {
  constexpr std::size_t most = 12;
  std::vector<std::string> out;
  for (const auto& [name, e] : parameters) {
    if (!is_curve_coefficient(name)) out.push_back(name + " = " + shown(e));
  }
  const std::size_t more = out.size() > most ? out.size() - most : 0;
  out.resize(out.size() - more);
  if (more > 0) out.push_back(std::to_string(more) + " more");
  return join_words(out);
}

/// Estimated in the study's own model, or in a rung, and not in the last model: what was added took over what they do.
std::vector<std::string> fixed_on_the_way(const Ladder& ladder) {
  std::vector<std::string> out;
  const Rung& last = ladder.rungs.back();
  if (!last.estimates) return out;
  for (const Rung& rung : ladder.rungs) {
    if (&rung == &last || !rung.estimates) continue;
    for (const auto& [name, estimate] : *rung.estimates) {
      if (!last.estimates->contains(name) && std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
  }
  return out;
}

std::vector<std::string> added_with_estimates(const Ladder& ladder) {
  std::vector<std::string> out;
  const Rung& last = ladder.rungs.back();
  for (const Rung& rung : ladder.rungs) {
    const bool seen = is_seen_in_measurements(rung);
    if (rung.added.empty() || (rung.parameters.empty() && !seen)) continue;
    Estimates now = rung.parameters;
    for (auto& [name, estimate] : now) {
      if (last.estimates && last.estimates->contains(name)) estimate = last.estimates->at(name);
    }
    std::string line = added_in_words(rung) + ": " + values_of(now);
    if (&rung != &last && values_of(now) != values_of(rung.parameters))
      line += fmt::format(" in the last model ({} in rung {})", values_of(rung.parameters), rung.id);
    if (rung.kept) line += (seen ? "" : "; ") + *rung.kept;
    if (rung.held_out_gain) line += "; held-out gain " + shown_gain(rung.held_out_gain);
    if (rung.stays_for_free_run) line += "; " + *rung.stays_for_free_run;
    if (rung.also) line += "; " + *rung.also;
    if (rung.alike) line += "; when it was added these data could not tell it from " + join_words(*rung.alike);
    out.push_back(line);
  }
  if (const std::string rest = numbers_of(others_of_last(ladder)); !rest.empty())
    out.push_back((out.empty() ? "parameters of the last model: " : "other parameters of the last model: ") + rest);
  if (const std::vector<std::string> fixed = fixed_on_the_way(ladder); !fixed.empty())
    out.push_back("fixed on the way: " + join_words(fixed) + "; the sigmas of the others are those beside these values");
  return out;
}

}  // namespace misfit
