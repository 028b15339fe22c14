#include "misfit/show/verdict_candidate.h"

#include <fmt/format.h>

#include <vector>

#include "misfit/core/shell_word.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

std::string with_values(const Candidate& best) {
  const std::string values = best.parameters.empty() ? "" : ", with " + parameters_in_words(best);
  return effect_at(best.effect, best.roles) + values + " (" + p_equals(best.p_value) + ")";
}

}  // namespace

std::string missing_in_words(const Candidate& best, bool still) {
  if (best.group.size() > 1)
    return "one of " + join_words(best.group) + " is missing, and these data cannot say which: best fits " + with_values(best);
  return (still ? "still missing: " : "missing: ") + with_values(best);
}

std::string hold_in_words(const Candidate& best) {
  std::vector<std::string> inputs;
  for (const auto& [input, hold] : *best.holds) inputs.push_back(input);
  const bool one = inputs.size() == 1, held = best.holds->begin()->second == "zero_order";
  return fmt::format(
      "between {} samples {} {} {}, where the model takes {} as {}: half a sampling interval is what {} needs to make up for that",
      one ? "its" : "their", join_words(inputs), one ? "is rather" : "are rather", held ? "constant" : "straight", one ? "it" : "them",
      held ? "a straight line" : "constant", with_values(best));
}

std::string by_hand(const Candidate& rejected) {
  if (rejected.why.find("the held-out log-likelihood") != std::string::npos) return "";
  return effect_at(rejected.effect, rejected.roles) + " can be added by hand, to compare the errors before and after";
}

const Candidate* nearest_of_library(const Discovery& d) {
  if (d.candidates.empty()) return nullptr;
  const Candidate& first = d.candidates.front();
  return first.remaining && first.actual_drop ? &first : nullptr;
}

std::string at_place(const std::map<std::string, std::string>& roles) {
  std::string out;
  for (const std::string& word : words_of_place(roles)) out += " --at " + shell_word(word);
  return out;
}

}  // namespace misfit
