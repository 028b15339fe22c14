#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit {

/// What an effect adds to the forces of one experiment; where it acts on no port, the force that does the same.
struct AddedForce {
  std::string experiment;
  std::vector<double> t;
  std::vector<std::string> ports, port_units;  ///< those on which it is not always 0
  std::vector<std::vector<double>> force;      ///< per port
};

/// What a candidate is: `generic`, of any unit; `unknown`, a curve of unknown form.
enum class CandidateFamily { physics, generic, sensor, unknown };
inline constexpr std::array<const char*, 4> candidate_family_names = {"physics", "generic", "sensor", "unknown"};
[[nodiscard]] std::string to_string(CandidateFamily family);

/// One thing that the model could lack.
struct Candidate {
  int rank = 0;        ///< 1 = first
  std::string effect;  ///< key, or unknown_curve_key()
  CandidateFamily family = CandidateFamily::physics;
  std::vector<std::string> ports;
  std::map<std::string, std::string> roles;  ///< bindings that differ from the defaults, as a study would write them
  double score = 0.0;                        ///< chi² of the score test at the best cell
  int dof = 1;
  double predicted_drop = 0.0;
  std::optional<double> actual_drop;                        ///< after refitting; missing: not refitted
  std::optional<double> held_out_gain;                      ///< of the held-out log-likelihood
  std::optional<std::map<std::string, std::string>> holds;  ///< inputs that are rather held otherwise, and how: that is what it looks like
  std::optional<std::string> also;                          ///< other values that explain hardly less, or what `holds` says, in words
  /// What is still significant beside it, the only reason against it: "an unknown surface dv/dt(y, u)".
  std::optional<std::string> remaining;
  /// Factor by which predictions farther ahead than one sample get worse with it, the only reason against it (growth_of_errors()): what is
  /// held out gains.
  std::optional<double> grows_ahead;
  double p_value = 1.0;            ///< corrected for cells scanned and families
  std::vector<std::string> group;  ///< effects that these data cannot distinguish from this one, itself included; empty: alone
  bool absorbed = false;           ///< by the free parameters (1 − R² < 0.01), and not clearly significant: not tested
  bool accepted = false;
  std::string why;                             ///< of being accepted or not, in words
  std::map<std::string, Estimate> parameters;  ///< at the refit, else one Gauss–Newton step
  /// Parameters of the model that it can take over, and their values: fixed when it is added, since both could not be estimated.
  std::map<std::string, Estimate> fixed_in_model;
  std::vector<double> knots;              ///< of its curve, closer together than usual [SI]; empty: as usual
  std::vector<std::string> free, fixed;   ///< its coefficients that the refit estimated or fixed unlike the effect says itself
  std::map<std::string, Estimate> force;  ///< random force per port after refitting
  /// Where the refit ended, for whoever begins there: all parameters of the model with the effect in their order [SI], and logarithms of
  /// the noise (NoiseVector). Empty: not refitted.
  std::vector<double> refit_values, refit_log_noise;
  std::vector<AddedForce> added;  ///< at the refit, by experiment; empty: not refitted, or it adds none
};

/// An effect and what its roles are bound to, as a study would write them.
struct EffectPlace {
  std::string effect;
  std::map<std::string, std::string> roles;
};

/// An effect that could not be looked for, and why.
struct NotTried {
  EffectPlace place;
  std::string reason;
};

/// What a curve of unknown form is called among the candidates: "unknown:PORT(QUANTITY)".
[[nodiscard]] std::string unknown_curve_key(const std::string& port, const std::string& quantity);

/// "overflow (level = x1, port = dx1/dt)"; the key alone where all roles are the defaults.
[[nodiscard]] std::string effect_at(const std::string& effect, const std::map<std::string, std::string>& roles);
/// The same as words of a command: {"level=x1", "port=dx1/dt"}; {"default"} where all roles are the defaults.
[[nodiscard]] std::vector<std::string> words_of_place(const std::map<std::string, std::string>& roles);
[[nodiscard]] inline std::vector<std::string> words_of_place(const Candidate& candidate) { return words_of_place(candidate.roles); }

/// "input_tau = 0.060 ± 0.002 s, lagged_gain = 1 (fixed)".
[[nodiscard]] std::string parameters_in_words(const Candidate& candidate);

/// "best candidate lag (drop 50, family-wise p = 1e-9), rejected: its strength is not determined".
[[nodiscard]] std::string best_rejected(const Candidate& candidate);
/// What is refused by another condition than its significance: is something missing all the same? Below a family-wise p of 1e-4, which
/// of models that lack nothing one in ten thousand has.
[[nodiscard]] bool shows_that_something_is_missing(const Candidate& rejected);

/// What a search for missing effects ends with.
enum class SearchOutcome {
  none_missing,          ///< no candidate is significant
  accepted,              ///< one is
  unknown_form,          ///< something is missing that no effect of the library explains
  best_rejected,         ///< the best candidate is significant, but fails another condition
  none_suits,            ///< no effect of the library suits the system
  not_decided,           ///< none is accepted, but refits were cut off
  not_finished,          ///< the search itself was cut off, none accepted by then
  camera_incomplete,     ///< the calibration sweep asks for parameters that the camera of the study does not have
  camera_against_flight  ///< the same, and the flight gives evidence of more
};
inline constexpr std::array<const char*, 9> search_outcome_names = {"none_missing",  "accepted",          "unknown_form",
                                                                    "best_rejected", "none_suits",        "not_decided",
                                                                    "not_finished",  "camera_incomplete", "camera_against_flight"};

/// What could be missing, best first.
struct Discovery {
  std::vector<Candidate> candidates;
  SearchOutcome outcome = SearchOutcome::none_missing;
  std::string verdict;                    ///< one sentence: what to add, or that nothing is missing, or that no known effect explains it
  std::vector<std::string> sentences;     ///< further remarks: groups and what would separate them, phantoms, calibration against flight
  std::vector<std::string> tried;         ///< families and cells that were looked at, in words
  std::vector<NotTried> not_tried;        ///< effects that suit the system, but could not be assembled into the model
  std::map<std::string, Estimate> force;  ///< random force before
  std::string unexplained_port,
      unexplained_quantity;  ///< where a force of unknown form depends on what, if that is the verdict; else empty
  /// Effects that would add it to the model as a curve of one quantity: of the one that explains most alone first. Empty: nothing is
  /// unexplained, or it is not of that kind.
  std::vector<EffectPlace> unexplained_effects;
  std::vector<std::string> unexplained_alike;  ///< what these data cannot tell from it: "a change of R0 that depends on soc"
  bool unexplained_error = false;              ///< not a force: an error of the output unexplained_port
  bool unexplained_parameter = false;          ///< not a force: a change of the parameter unexplained_port
  /// Numbers of the system that the study fixes and that, freed, would explain about as much as the best effect does, in words: the most
  /// significant first; missing: none.
  std::optional<std::vector<std::string>> fixed_parameters;
  std::vector<std::string> sweep_asks;  ///< camera parameters that the calibration sweep asks for and the camera of the study does not have
  double seconds = 0.0;
};

/// Log-likelihood that a refitted candidate gains on the measurements of the estimation and on those held out.
[[nodiscard]] double gain_in_all(const Candidate& candidate);

/// Something else remains beside each of them, and none is accepted: the one to begin with, that with the largest gain
/// (gain_in_all) of those that act where the model fails (where that is an error of an output, any force: what it leaves looks like one),
/// but not a part of what is unexplained (a parameter that changes along a line with the quantity of which it is found to be a curve).
/// nullptr: there is none, a curve of unknown form explains more (more than twice as much, where none can be added in its place), or a
/// refitted candidate that is refused more than twice as much.
[[nodiscard]] const Candidate* candidate_to_begin_with(const Discovery& discovery);
/// The same once the curve of unknown form has been added in vain: it explains nothing of what is held out, so that it stands in nobody's
/// way, and the others as where none can be added.
[[nodiscard]] std::optional<Candidate> candidate_after_the_curve(const Discovery& discovery);

/// None is accepted, and one explains more of what is measured and of what is held out than any other, but predicts worse farther ahead by
/// itself (`grows_ahead`, by no more than twice): what it lacks beside it may be missing, too. Dry friction that alone has to hold what a
/// friction growing with the load holds is too large for the motion. nullptr: there is none, or something that is refused explains more
/// than twice as much, as in candidate_to_begin_with().
[[nodiscard]] const Candidate* candidate_short_ahead(const Discovery& discovery);
/// Of a search with such an effect in the model, what may be missing beside it: effects accepted or refused for a lack of fit alone, which
/// gain on what is held out; those that gain most in all first, three at most.
[[nodiscard]] std::vector<Candidate> candidates_beside(const Discovery& discovery);

/// Effects of the library that were tested: no curves of unknown form, and none that the model already describes.
[[nodiscard]] std::size_t effects_tested(const Discovery& discovery);
/// The curves of unknown form.
[[nodiscard]] std::size_t curves_tested(const Discovery& discovery);
/// "20 effects and 20 curves of unknown form"; where an effect was tested at several places: "3 effects at 5 places and …".
[[nodiscard]] std::string tested_in_words(const Discovery& discovery);

/// Of each effect that could not be looked for: "overflow: not tried: input 'u' is not recorded".
[[nodiscard]] std::vector<std::string> not_tried_in_words(const Discovery& discovery);

/// "a force on dw/dt"; where it is an error of an output or a change of a parameter: "an error of V", "a change of Bl".
[[nodiscard]] std::string unexplained_place(const std::string& port, bool error, bool parameter);
[[nodiscard]] std::string unexplained_place(const Discovery& discovery);

/// candidates.json (an array), discovery.json (outcome, verdict, sentences, tried) and added_force.csv (added_force_NAME.csv for further
/// experiments; none where no candidate adds a force): columns t and "RANK PORT".
void write_discovery(const std::filesystem::path& dir, const Discovery& discovery);
[[nodiscard]] Discovery read_discovery(const std::filesystem::path& dir);

}  // namespace misfit
