#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "misfit/discover/accept.h"
#include "misfit/discover/refit_jobs.h"

namespace misfit {

/// Which of the ranked candidates of a search are refitted, wave by wave (lib/misfit/README.md, 6.5, step 1). After each wave the ranking
/// is sorted by the evidence so far.
class RefitWaves {
 public:
  /// Keeps references to everything that the context refers to, to `score` (of the estimate), to `models` (all candidates) and to `ranked`.
  /// RunError, of every wave: the search was stopped.
  RefitWaves(const SearchContext& context, const ScoreTest& score, const std::vector<CandidateModel>& models,
             std::vector<RankedCandidate>& ranked, ProgressFn progress);

  /// Sensors that lose the sign of their output, where the measurements go better with signs (with_signs()): no score shows them, and the
  /// model that was fitted to sizes is far off. Begun with it fitted to the measurements with signs.
  void refit_where_signs_are_lost();
  /// Outputs that are read in whole steps, where these are coarse: the score of a sawtooth promises little of what reading them so gains.
  /// True: they are found.
  bool refit_where_steps_are_coarse();
  /// Of such an output.
  [[nodiscard]] bool reads_coarse_steps(const RankedCandidate& e) const;
  /// Those with a predicted drop above half of the best.
  void refit_the_best();
  /// One step of a time constant, a threshold or a width tells little of what it explains at its maximum, nor one of a sign that a sensor
  /// loses, or not: a tenth of what another one explains, there.
  void refit_the_significant_beyond_a_step();
  /// The forces that explain most of the free run, each at least a fifth of it, begun from there: down to the first that one step ahead has
  /// found already.
  void refit_what_the_free_run_shows();
  /// A refit that ends far below what the score promised, or nowhere, has failed: that is no evidence against its effect. What else is
  /// free in the estimate may be where it is to make up for the missing effect. Not of those that promise less than half of what another
  /// one explains, past which they would not be chosen.
  void refit_what_fell_short();
  /// An effect with two edges one of which nothing visits is refused, and may be one with the other edge alone, whose score promises little
  /// from far below: those at the same port that are significant and not refitted yet.
  void refit_beside_an_edge_not_visited();
  /// Beside a significant effect, those of which one step told so little that they are not: lags and delays beside one of these, which are
  /// nearly alike at their maxima, and what is far from linear and nearly significant. Forgotten again where they explain less than the
  /// significant one.
  void refit_what_promises_little();
  /// Further waves, where nothing is accepted yet. False: there is none, or none gains.
  bool refit_the_other_nominated();
  bool refit_the_other_significant_ones();
  /// The first few significant ones: none could be accepted as it is; and of those that the free run nominates, what went elsewhere.
  bool refit_afresh();
  /// Where the random force is slow (slow_force.h), it may stand for what is missing, and leaves a score next to nothing of it, so that
  /// something else may be significant: those that would be significant if they were the only ones.
  bool refit_what_a_slow_force_hides();
  void refit_alone(const RankedCandidate& candidate);

  /// higher_without(), from the refits from which it was not looked for yet.
  [[nodiscard]] std::optional<FilterEstimate> higher();
  /// Effects whose refits were cut off.
  [[nodiscard]] const std::vector<std::string>& unfinished() const { return unfinished_; }

 private:
  /// Some refits, begun together.
  struct Wave {
    std::function<const ScreeningResult*(const RankedCandidate&)> begin;  ///< where a candidate's refit begins; nullptr: it is not in it
    const char* name = "";                                                ///< of its stored jobs
    const FilterEstimate* screened = nullptr;                             ///< RefitWork::screened
    const ScoreTest* score = nullptr;                                     ///< nullptr: the estimate's
    const FilterEstimate* rest = nullptr;                                 ///< RefitWork::rest
  };
  /// Some refits once more, from the study's own values of all else.
  struct Again {
    std::function<bool(const RankedCandidate&)> wanted;
    bool as_refitted = false;  ///< the effect begins as it was refitted; else as it was screened
    const char* name = "";     ///< of the stored jobs
  };

  [[nodiscard]] double best_predicted() const;
  [[nodiscard]] bool significant(const RankedCandidate& e) const;
  [[nodiscard]] bool significant_in_screening(const RankedCandidate& e) const;
  [[nodiscard]] static bool may_explain_as(const RankedCandidate* most, const RankedCandidate& e, double promised, double most_more);
  [[nodiscard]] bool was_cut_off(const RankedCandidate& e) const;
  [[nodiscard]] bool is_nominated(const RankedCandidate& e) const;
  /// Nominated and refitted, but its refit does not explain the free run, or ended nowhere.
  [[nodiscard]] bool went_elsewhere(const RankedCandidate& e) const;
  bool refit_nominated(const std::vector<const ScreeningResult*>& nominated, const char* name);
  void require_of_free_run(RankedCandidate& e);
  void forget_refit(RankedCandidate& e, const char* why) const;
  bool refit_again(const Again& again);
  bool refit_wave(const Wave& wave);
  [[nodiscard]] std::optional<FilterEstimate> fitted_to(const std::vector<Signals>& experiments) const;
  std::vector<SteppedRefit> refitted(const RefitWork& work, const ScoreTest& score, const std::vector<const ScreeningResult*>& effects,
                                     const char* name);
  void store_refit(RankedCandidate& e);

  SearchContext context_;
  const ScoreTest& score_;
  const std::vector<CandidateModel>& models_;
  std::vector<RankedCandidate>& ranked_;
  ProgressFn progress_;
  std::optional<FilterEstimate> calm_;             ///< free_run()
  std::optional<ScoreTest> calm_score_;            ///< there
  std::vector<ScreeningResult> calm_screening_;    ///< there
  std::vector<const ScreeningResult*> nominated_;  ///< of these, the best first
  std::vector<std::string> unfinished_;
};

}  // namespace misfit
