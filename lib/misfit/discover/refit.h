#pragma once

#include <optional>

#include "misfit/discover/screen.h"
#include "misfit/fit/filter/k_step.h"
#include "misfit/fit/filter/predictive_loglik.h"

namespace misfit {

/// The model with one effect more, at its own maximum over everything, on the same measurements and with the same roughness weights.
struct Refit {
  bool ok = false;           ///< it could be run; whether a maximum was reached is estimate.converged
  bool out_of_time = false;  ///< not ok: a limit of time was spent before a maximum was reached, which is no evidence against the effect
  std::string why;           ///< of failing
  double drop = 0.0;  ///< 2 [objective(with) − objective(without)], priors on both sides; with what exact derivatives leave where converged
  FilterEstimate estimate;
  ModelRequest request;
  std::map<std::string, Estimate> parameters;               ///< of the effect
  std::vector<std::string> free, fixed;                     ///< its coefficients that are estimated or fixed unlike the effect's file says
  std::string partial;                                      ///< why it is no whole effect (whole_strength.h); empty: it is, or may be
  std::optional<std::map<std::string, std::string>> moved;  ///< its roles, where it acts on its input itself now (whole_strength.h)
  std::map<std::string, std::string> holds;                 ///< Candidate::holds; empty: none
  std::string also;  ///< another explanation that these data hardly tell from this one, in words; empty: none found
};

/// A refit has failed if its drop is below this share of the chi² that its score promised.
inline constexpr double least_of_score = 0.5;

/// What refits have in common.
struct RefitWork {
  const FilterEstimate& without;
  const std::vector<Signals>& experiments;
  const Registry& registry;
  int threads = 0;
  double time_limit = 0.0;  ///< of each refit [s]; 0: none
  /// Where the effects were screened if that is not `without`: one step is made there, and the refit begins with as much less of the random
  /// force as the effect leaves of what is unexplained there.
  const FilterEstimate* screened = nullptr;
  /// Refits begin at the study's own values of what is in the estimate, and the noise is looked for anew.
  bool afresh = false;
  /// An estimate of the same model by other measurements: refits begin at its values of all else, the effect as screened. nullptr: none.
  const FilterEstimate* rest = nullptr;
};

/// For another model beside an estimate: its measurements and their uses, its noise to begin with, its steps of integration; roughness as
/// handed over.
[[nodiscard]] FilterOptions options_like(const FilterEstimate& estimate, int threads);
/// Of that model, with the weights of roughness of the estimate; the effect's own curves follow behind.
[[nodiscard]] std::vector<Penalty> penalties_as_of(const FilterEstimate& from, const Model& model);

/// The model free as the estimate's, and the effect's own coefficients free but for those its file keeps fixed.
[[nodiscard]] Model start_model(const FilterEstimate& without, const ScreeningResult& screening, const Registry& registry);

/// A model whose last effect has another place than that of `from`: its parameters are the same ones in the same order, though their names
/// and units may be others. Values, what is free, and lower bounds are those of `from`.
[[nodiscard]] Model with_the_same_values(Model moved, const Model& from);

/// The effect as refitted, for a start: its values as a cell and amplitudes.
[[nodiscard]] ScreeningResult as_refitted(const ScreeningResult& screening, const Model& refitted);

/// The same with its strengths at 0: a start below which no search ends.
[[nodiscard]] Model off_model(const RefitWork& work, const ScreeningResult& screening);
/// The same with the study's own values of what is in the estimate: the estimate's may be what makes up for the missing effect, together
/// with a random force that hides it, and no way up may lead from there to the maximum with the effect.
[[nodiscard]] Model fresh_model(const RefitWork& work, const ScreeningResult& screening);

/// A model run once with the estimate's noise, or the one given, and that noise fitted about the run in a few steps.
struct NoisyRun {
  double objective = 0.0;
  FilterNoise noise;
};
/// nullopt: the model cannot be run there.
[[nodiscard]] std::optional<NoisyRun> run_once(const RefitWork& work, const Model& model, const std::optional<FilterNoise>& given = {});

/// [log-likelihood] What one free parameter gains by chance once in a hundred times: half of the 99 % quantile of a chi² of one degree of
/// freedom.
inline constexpr double gain_by_chance = 3.32;

/// A refit, and the drop that the score predicts of its effect.
struct PredictedRefit {
  const Refit* refit = nullptr;
  double predicted = 0.0;
};
/// The model without any of these effects at a higher maximum than the estimate: what a refit changes in all else may lead there, where the
/// effect itself explains little. Then everything that was found beside the estimate may be what it lacked itself. Fitted from the highest
/// of where refits have led, without their effects: from where that is higher than the estimate by more than tied_drops/2; and, of a small
/// drop (below 100) that is larger than predicted by more than tied_drops, from where no more than the half of what is predicted is lost:
/// what is more may come of all else. nullopt: from none does the log-likelihood come higher by more than tied_drops/2.
[[nodiscard]] std::optional<FilterEstimate> higher_without(const RefitWork& work, const std::vector<PredictedRefit>& refits);

/// One Gauss–Newton step of all parameters from the estimate with the effect at its screened strength: the model is run there once and the
/// noise fitted about that run, since what is explained leaves the random force.
struct OneStep {
  double drop = 0.0;           ///< never below the score's chi², which holds the noise
  std::optional<Model> model;  ///< where it ended; nullopt: it could not be run, or is no better than the estimate
  FilterNoise noise;           ///< there
};
[[nodiscard]] OneStep one_step(const RefitWork& work, const ScoreTest& score, const ScreeningResult& screening);

/// Begun afresh (RefitWork), from there alone; from another estimate, from there first. Else `from`: where to start, if it ended anywhere.
/// Where no maximum is reached from there, and without it: from the estimate with the effect added to it, which an effect that the other
/// parameters must make room for can throw out of the finite numbers; where that, too, reaches none, or one below the estimate: from the
/// estimate with the effect in it but off, below which the search does not end. Where what was found falls short of what the score promises
/// (least_of_score): with the shapes held as screened first, which are then set free. A width that ends at what the filter resolved goes on
/// down to what it resolves now (refit_sizes.h). A strength at which the effect would be whole (whole_strength.h) is then fixed there if
/// that costs the log-likelihood little (fix_whole_strengths()): from what was found and from the best of the shapes that the screening
/// looked at, the higher of the two. A lag and a pole of the system may have changed places (exchanged_poles.h): the other order is tried.
/// Last, a shape that may drift (CoefficientSpec::drift_of) does if the data ask for it. Throws nothing where its limit of time is spent
/// (Refit::out_of_time).
[[nodiscard]] Refit refit(const RefitWork& work, const ScreeningResult& screening, const OneStep& from = {});

/// The refit of an effect for which no time was left: `drop` is how far it had come.
[[nodiscard]] Refit unfinished(const ScreeningResult& screening, const std::string& spent, std::optional<double> drop = std::nullopt);

/// Free coefficients of its own that the refitted effect has.
[[nodiscard]] int estimated_parameters(const Refit& refit);

/// [log-likelihood] What a held-out gain must exceed: half for each parameter. A superfluous one gains that in the data that it is
/// estimated from, on average, and loses as much in those held out: a margin, not a probability.
[[nodiscard]] double least_held_out_gain(int parameters);

/// What a refit predicts against an estimate: held-out measurements, by their predictive density, and farther ahead than one sample. Where
/// the study holds nothing out, both models are fitted again without the last quarter of every experiment, and judged on it; what is of the
/// estimate is computed once for all.
class HeldOut {
 public:
  /// Keeps pointers to the estimate and the experiments.
  HeldOut(const FilterEstimate& without, const std::vector<Signals>& experiments, int threads)
      : without_(without), experiments_(experiments), threads_(threads) {}

  /// TimeLimitReached: a limit of time was spent in one of these fits.
  [[nodiscard]] double gain(const FilterEstimate& with);
  /// Of the errors of predictions farther ahead than one sample (growth_of_errors()), in what is fitted and what is held out together.
  [[nodiscard]] double growth_ahead(const FilterEstimate& with);

 private:
  [[nodiscard]] double loglik(const FilterEstimate& estimate, const std::vector<double>& steps = {}) const;

  const FilterEstimate& without_;
  const std::vector<Signals>& experiments_;
  int threads_;
  std::optional<double> before_;
  std::optional<KStepErrors> ahead_before_;
};

}  // namespace misfit
