#include "misfit/discover/unfinished.h"

#include <algorithm>

#include "misfit/core/text.h"

namespace misfit {
namespace {

bool any_accepted(const Discovery& discovery) {
  return std::any_of(discovery.candidates.begin(), discovery.candidates.end(), [](const Candidate& c) { return c.accepted; });
}

}  // namespace

void say_unfinished(const std::vector<std::string>& effects, Discovery& discovery) {
  if (effects.empty()) return;
  const std::string cut_off = std::string(effects.size() > 1 ? "the refits" : "the refit") + " of " + join_words(effects) +
                              (effects.size() > 1 ? " were" : " was") + " not finished within the time limit";
  if (any_accepted(discovery)) {
    discovery.sentences.push_back(cut_off + ": tested again once the accepted effect is added");
  } else {
    discovery.outcome = SearchOutcome::not_decided;
    discovery.verdict = "Not decided: " + cut_off + ", which says nothing against " + (effects.size() > 1 ? "them" : "it") +
                        ". Of the rest: " + discovery.verdict;
  }
}

void say_cut_off(const std::string& spent, bool screened, Discovery& discovery) {
  if (any_accepted(discovery)) {
    discovery.sentences.push_back(
        spent +
        ": the test for effects that these data cannot tell from the accepted one is incomplete (more time: --round-limit SECONDS)");
    return;
  }
  const std::string where = screened ? " after the candidates were tested one by one: which of them is missing is not decided"
                                     : " before all candidates were tested: nothing can be said of any";
  discovery.outcome = SearchOutcome::not_finished;
  discovery.verdict = "Not finished: " + spent + where + " (more time: --round-limit SECONDS, or time_limit of [discover]).";
}

}  // namespace misfit
