#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/ranked.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/discover/verdict.h"

namespace misfit {

/// What a search works on, for testing again in another model.
struct SearchContext {
  const FilterEstimate& estimate;
  const Registry& registry;
  const std::vector<Signals>& experiments;
  const DiscoverOptions& options;
  double families = 1.0;  ///< that a p-value is corrected for
};

/// The acceptance rule of discovery: at most one of the refitted candidates, which stand in front, best first. Its steps, with their
/// numbers and formulas in lib/misfit/README.md, 6.5:
///   4. Refusals: `judge` notes the first reason against each.
///   5. Choice: of the others the first that leaves no lack of fit (`first_without_lack_of_fit`), though not past one that explains more
///      than twice as much (`not_past_a_larger_one`). Those that leave some may only imitate the missing effect.
///   6. A second effect (`first_with_a_second_effect`): if all leave some, the first of which it removes what is left.
///   7. A pair instead (`or_a_better_pair`): two effects whose sum looks like the chosen one.
///   8. Group (`find_groups`): those that these data cannot distinguish from the first. An accepted one stands first from here on
///      (`move_to_front`), and every other refitted one has the reason why it is not accepted (`explain_others`).
///   9. Nothing accepted: what remains may depend on a quantity in a way that no named effect describes (`unexplained_force`).
/// Acceptance is marked in `ranked` (Candidate::accepted, of the first one); returned is what step 9 finds. `narrow`: curves that follow
/// what changes over short ways, past which no choice is made either; of step 5 alone.
[[nodiscard]] std::optional<Unexplained> accept_best(std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown,
                                                     const SearchContext& context, const std::vector<UnknownCurve>& narrow = {});

/// What is missing where it is this curve: one of `unknown`.
[[nodiscard]] Unexplained unexplained_by(const UnknownCurve& curve, const std::vector<UnknownCurve>& unknown, const SearchContext& context);

/// Corrected for all families of the search, below the p-value of acceptance?
[[nodiscard]] bool is_significant(const UnknownCurve& curve, const SearchContext& context);

/// A curve of unknown form promises more than twice as much as any candidate, where all were screened: of those that are not refitted yet,
/// or were refused, none is likely to explain it.
[[nodiscard]] bool is_of_unknown_form(const std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown,
                                      const SearchContext& context);

}  // namespace misfit
