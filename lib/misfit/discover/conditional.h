#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/discover/accept.h"
#include "misfit/discover/unknown_curves.h"

namespace misfit {

/// As verdicts name a candidate: the effect with its place.
[[nodiscard]] std::string label(const Candidate& candidate);

/// Refits of a search, from an estimate.
[[nodiscard]] RefitWork work_from(const FilterEstimate& estimate, const SearchContext& context);

/// Score tests of other effects in the model to which a refitted one has been added. Their results point into this object and the refit.
class ConditionalScores {
 public:
  ConditionalScores(const Refit& in, const SearchContext& context);

  /// At the effect's best cell of the first search; dof 0 where the model describes it already, no value where it cannot be run with it.
  [[nodiscard]] std::optional<ScreeningResult> score(const RankedCandidate& other) const;

  /// At the best of all its cells.
  [[nodiscard]] std::optional<ScreeningResult> best_score(const RankedCandidate& other) const;

 private:
  [[nodiscard]] const CandidateModel* in_list(const RankedCandidate& other) const;
  [[nodiscard]] std::optional<ScreeningResult> score_at(const CandidateModel& candidate_model, const std::vector<double>& at,
                                                        const RankedCandidate& other) const;

  const Refit& in_;
  std::vector<CandidateModel> list_;
  ScoreTest score_;
};

/// Has `other` no significant score in the model with the refitted effect? False where the two cannot be in one model: nothing is tested.
[[nodiscard]] bool adds_nothing(const ConditionalScores& in, const RankedCandidate& other, double p_accept);

/// For a lag or a delay in the refitted model: another one of the plant that is still significant there, and worth a good part of `drop`.
/// Then the past does count, but not in the form of either.
[[nodiscard]] std::optional<UnknownCurve> remaining_memory(const Refit& in, double drop, const std::vector<RankedCandidate>& ranked,
                                                           const SearchContext& context);

}  // namespace misfit
