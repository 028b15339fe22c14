#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/data/fit.h"

namespace misfit {

/// One rung: a model, how well it does, and what made it from its parent.
struct Rung {
  int id = 0, parent = -1;                                  ///< parent −1: the first
  std::string study;                                        ///< path of its study, relative to the run folder
  std::string added;                                        ///< effect, "system:KIND" for a change of system, "" for the first
  std::optional<std::map<std::string, std::string>> roles;  ///< where the effect acts, as far as it was said
  std::string system;                                       ///< kind
  std::string method;
  std::optional<double> predicted_drop, actual_drop, held_out_gain;  ///< against the parent; missing across a change of system or channels
  /// Where the study holds nothing out: the gain in discovery, which fitted both models again without the last quarter of each experiment.
  std::optional<double> gain_of_search;
  double loglik = 0.0;
  std::optional<double> validation_loglik;
  std::map<std::string, Estimate> force;                ///< strength of the random force
  std::map<std::string, Estimate> rms, validation_rms;  ///< per channel, one step ahead
  std::map<std::string, std::vector<double>> k_step;    ///< channel → RMS at 1, 2, 4, 8, 16, 32 samples ahead [unit of rms]
  /// The same of what is held out; missing: nothing is, or it was not asked for.
  std::optional<std::map<std::string, std::vector<double>>> validation_k_step;
  /// RMS per channel of its model fitted and run without a random force; missing: not asked for, or it does not follow the motion.
  std::optional<std::map<std::string, Estimate>> free_rms, validation_free_rms;
  std::optional<Estimate> trim;                               ///< [rad]
  std::map<std::string, Estimate> parameters;                 ///< of the added effect, numbers alone
  std::optional<int> new_parameters;                          ///< free ones that its parent does not have, coefficients of curves too
  std::optional<std::map<std::string, Estimate>> estimates;   ///< of all parameters of its model that are no coefficients of curves
  std::optional<std::vector<std::string>> doubts;             ///< Fit::doubts
  std::optional<std::string> kept;                            ///< "width is fixed at 0.5 rad/s": of the added effect, in words
  std::optional<std::vector<std::string>> gained_too_little;  ///< tried beside this model in vain: effect_at()
  std::optional<std::map<std::string, std::string>> why_too_little;  ///< of each of those, with the number that decided: a clause
  std::optional<std::string> remained;                               ///< Candidate::remaining of what was added all the same
  std::optional<std::map<std::string, std::string>> holds;           ///< Candidate::holds of what was added
  std::optional<std::string> also;                                   ///< other values of what was added that explain hardly less, in words
  std::optional<std::vector<std::string>> alike;  ///< what these data could not tell from it when it was added, as effect_at() says it
  /// By how much its free run is better, in words: why it stays though what is held out is predicted worse one sample ahead.
  std::optional<std::string> stays_for_free_run;
  std::string note;  ///< in words
};
/// Steps of Rung::k_step.
inline constexpr int kLadderSteps[] = {1, 2, 4, 8, 16, kFarAhead};

struct Ladder {
  std::vector<Rung> rungs;
};

/// What the drop of a rung is tested with: its new_parameters, else the number of its parameters.
[[nodiscard]] int parameters_added(const Rung& rung);

/// Nothing of what was added is estimated: it is seen in the measurements themselves (whole steps), so that what is held out does not speak
/// against it.
[[nodiscard]] bool is_seen_in_measurements(const Rung& rung);

/// What discovery says of what is added.
void describe_added(const Candidate& from, Rung& rung);

/// What was added, in words: its key, and its place where that is not its default one.
[[nodiscard]] std::string added_in_words(const Rung& rung);

/// ladder.json: an array.
void write_ladder(const std::filesystem::path& path, const Ladder& ladder);
[[nodiscard]] Ladder read_ladder(const std::filesystem::path& path);

}  // namespace misfit
