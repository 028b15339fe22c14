#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/ladder.h"
#include "misfit/data/verdict.h"

namespace misfit {

// What a verdict says of a ladder.

/// "backlash and coulomb_friction": all that was added.
[[nodiscard]] std::string names_added(const Ladder& ladder);

struct AddedWork {
  const Ladder& ladder;
  const std::vector<ErrorChange>& errors;  ///< between the study's own model and the last
  const std::vector<std::string>& doubts;  ///< Verdict::doubts
  bool something_remains = false;          ///< beside the last model, or that has not been looked for
  std::string change;                      ///< "the random force falls from …"; empty: nothing is known of it
};

/// "a was missing: with all that was added the error falls", "b was added and explains no more than chance does": what was needed first.
/// Where the model is doubtful, or begun with an effect that no test accepted, it "describes what was missing"; where an RMS error rises by
/// more than 3 % and none falls, it "was added".
[[nodiscard]] std::vector<std::string> added_in_clauses(const AddedWork& work);

/// "a was begun with though …": of several rungs, one that no test accepted by itself; empty: there is none.
[[nodiscard]] std::string begun_in_words(const Ladder& ladder);

}  // namespace misfit
