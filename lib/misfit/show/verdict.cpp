#include "misfit/show/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "misfit/core/display.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/math/statistics.h"
#include "misfit/show/error_changes.h"
#include "misfit/show/rows.h"
#include "misfit/show/verdict_candidate.h"
#include "misfit/show/verdict_estimates.h"
#include "misfit/show/verdict_evidence.h"
#include "misfit/show/verdict_ladder.h"

namespace misfit {
namespace {

/// Not decided: refits were cut off by a limit of their own, which a longer round does not lift.
const char* more_time(SearchOutcome outcome) {
  return outcome == SearchOutcome::not_decided ? " --time-limit 3600 --round-limit 36000" : " --round-limit 3600";
}

const Candidate* accepted(const Discovery& d) {
  const auto found = std::find_if(d.candidates.begin(), d.candidates.end(), [](const Candidate& c) { return c.accepted; });
  return found == d.candidates.end() ? nullptr : &*found;
}

class VerdictBuilder {
 public:
  explicit VerdictBuilder(const VerdictInput& input) : in_(input) {
    fit_ = in_.fits == nullptr ? nullptr : leading_fit(*in_.fits);
    effects_added_ = in_.ladder != nullptr && in_.ladder->rungs.size() > 1;
    if (in_.diagnosis != nullptr) out_.where = where_it_fails(in_.diagnosis->maps);
    if (effects_added_) {
      out_.errors = errors_between(in_.ladder->rungs.front(), in_.ladder->rungs.back(), fit_);
      out_.added = added_with_estimates(*in_.ladder);
    } else if (fit_ != nullptr) {
      out_.errors = errors_of(*fit_);
    }
    add_doubts();
    add_trim();
  }

  Verdict verdict() {
    if (fit_ == nullptr && !effects_added_) {
      no_result();
    } else if (in_.discovery == nullptr) {
      if (!in_.left_out.empty()) {
        outdated();
      } else {
        effects_added_ ? added("whether more is missing has not been looked for", command("discover")) : not_searched();
      }
    } else if (!in_.discovery->sweep_asks.empty()) {
      calibration();
    } else if (const Candidate* best = accepted(*in_.discovery)) {
      const std::string* why = why_taken_off(effect_at(best->effect, best->roles));
      why == nullptr ? missing(*best) : taken_off(*best, *why);
    } else {
      nothing_accepted(*in_.discovery);
    }
    if (fit_ != nullptr && in_.discovery != nullptr && in_.discovery->fixed_parameters && out_.kind != VerdictKind::calibration)
      out_.sentence += " " + in_.discovery->fixed_parameters->front() + ".";  // begins with the parameter's name
    add_parameters();
    return out_;
  }

 private:
  void say(VerdictKind kind, const std::string& sentence, const std::string& next) {
    out_.kind = kind;
    out_.sentence = as_sentence(sentence);
    out_.next = next;
  }
  /// What stands below the sentence.
  void note(const std::string& words) { out_.notes.push_back(as_sentence(words)); }
  /// Of words that begin with the name of an effect, which keeps its small letters.
  void note_of_effect(const std::string& words) {
    if (!words.empty()) out_.notes.push_back(words + ".");
  }
  [[nodiscard]] std::string command(const std::string& verb, const std::string& effect = "") const {
    return misfit_command(verb, in_.study, effect, in_.out);
  }

  /// Of the last model, or of the study's own where nothing was added.
  void add_doubts() {
    const auto& doubts = effects_added_ ? in_.ladder->rungs.back().doubts : fit_ != nullptr ? fit_->doubts : std::nullopt;
    if (doubts) out_.doubts = *doubts;
    if (!effects_added_) return;
    for (std::string& lost : no_longer_determined(in_.ladder->rungs.front(), in_.ladder->rungs.back()))
      out_.doubts.push_back(std::move(lost));
  }
  /// The trim before and after what was added, with the 95 % interval of the last one and what the references say.
  void add_trim() {
    const Rung* last = effects_added_ ? &in_.ladder->rungs.back() : nullptr;
    const std::optional<Estimate> before = last != nullptr ? in_.ladder->rungs.front().trim : fit_ != nullptr ? fit_->trim : std::nullopt;
    if (!before) return;
    out_.trim.emplace();
    out_.trim->kind = ErrorKind::trim;
    out_.trim->before = *before;
    if (last != nullptr) out_.trim->after = last->trim;
    const Estimate& best = out_.trim->after ? *out_.trim->after : *before;
    constexpr double sigmas = 1.96;
    const auto [low, high] = best.interval.value_or(std::pair(best.value - sigmas * best.sigma, best.value + sigmas * best.sigma));
    if (best.sigma > 0.0) out_.trim->remark = "95 %: " + interval_in_display_unit(low, high, best.unit, best.sigma);
    if (in_.comparison == nullptr) return;
    for (const auto& [name, trim] : in_.comparison->reference_trims) {
      constexpr double negligible = 0.1;  // beside the sigma of the fit
      const Estimate shown_trim{trim.value, trim.sigma > negligible * best.sigma ? trim.sigma : 0.0, trim.unit};
      out_.trim->remark += (out_.trim->remark.empty() ? "" : "; ") + name + ": " + briefly(shown_trim);
    }
  }

  /// The same map of the last rung; nullptr: it has none.
  [[nodiscard]] const ForceMap* map_after(const ForceMap& map) const {
    return in_.rung_diagnosis == nullptr ? nullptr : find_map(*in_.rung_diagnosis, map.port, map.quantity);
  }
  /// Of the study's own model, and what the ladder has left of it; the first of several names what was added since.
  [[nodiscard]] std::string place_where_it_fails(const ForceMap& map, bool first) const {
    const ForceMap* after = map_after(map);
    const std::string place = map.sentence + " (" + p_equals(map.p_corrected) + ")";
    if (after == nullptr) return as_sentence(place);
    return as_sentence((first ? "without " + names_added(*in_.ladder) + ", " : "") + place + "; in the last model " +
                       p_equals(after->p_corrected));
  }
  /// The most significant place of each port that has one; empty: the most significant map has none.
  [[nodiscard]] std::string where_it_fails(const std::vector<ForceMap>& maps) const {
    if (maps.empty() || maps.front().sentence.empty()) return "";
    constexpr std::size_t most = 3;
    std::vector<std::string> ports, places;
    for (const ForceMap& map : maps) {
      const bool named = std::find(ports.begin(), ports.end(), map.port) != ports.end();
      if (map.sentence.empty() || named || places.size() == most) continue;
      ports.push_back(map.port);
      places.push_back(place_where_it_fails(map, places.empty()));
    }
    return fmt::format("{}", fmt::join(places, " "));
  }

  /// The model that was identified is the answer where no named effect is to come: a name changes the others' values. After a success they
  /// stand in `added`.
  void add_parameters() {
    const bool others_come =
        out_.kind == VerdictKind::missing || out_.kind == VerdictKind::several_possible || out_.kind == VerdictKind::calibration;
    if (fit_ == nullptr || effects_added_ || others_come) return;
    out_.parameters = numbers_of(fit_->parameters);
  }

  /// What to do with a model that lacks nothing more: other programs take it, on other recordings.
  [[nodiscard]] std::string export_command() const {
    return misfit_command("export", in_.study, "--to json", "") + (in_.out.empty() ? "" : " --run " + shell_word(in_.out));
  }

  void no_result() {
    std::vector<std::string> why;
    if (in_.fits != nullptr) {
      for (const Fit& fit : *in_.fits) why.push_back(fit.method + " " + to_string(fit.status) + ": " + fit.message);
    }
    say(VerdictKind::no_result,
        why.empty() ? "no method was asked for" : "no method gives a result: " + fmt::format("{}", fmt::join(why, "; ")), "");
  }

  /// What diagnose and discover found before does not count any more.
  void outdated() {
    const std::string why = in_.left_out + "; ";
    effects_added_ ? added(why + "whether more is missing is to be looked for again", in_.anew)
                   : say(VerdictKind::not_searched, why + "where the model fails and what it lacks are to be looked for again", in_.anew);
  }

  /// What fits and diagnosis alone say.
  void not_searched() {
    const std::string ask = "; which effect it is has not been looked for";
    if (fit_->force.empty() && fit_->driven) {
      say(VerdictKind::not_searched,
          "something is missing from the model: the residuals of " + fit_->method +
              " are not white, since forces that it does not have drive the motion" + ask,
          command("discover"));
    } else if (fit_->force.empty() && fit_->coloured) {
      say(VerdictKind::not_searched,
          "something may be missing from the model, or the measurement noise is autocorrelated: the residuals of " + fit_->method +
              " are not white; whether an effect is missing has not been looked for",
          command("discover"));
    } else if (!out_.where.empty()) {
      say(VerdictKind::not_searched, "something is missing from the model" + ask, command("discover"));
    } else if (!fit_->force.empty() && in_.diagnosis == nullptr) {
      say(VerdictKind::not_searched, "fitted, not diagnosed yet: whether and where the model fails has not been looked at",
          command("diagnose"));
    } else {
      say(VerdictKind::not_searched,
          "nothing shows that an effect is missing: " + residuals() + "; the effects of the library were not tested", command("discover"));
    }
  }
  [[nodiscard]] std::string residuals() const {
    if (!fit_->force.empty()) return "no map of the missing force is significant";
    return "nothing stands out in the residuals of " + fit_->method;
  }

  void calibration() {
    const std::vector<std::string>& asks = in_.discovery->sweep_asks;
    const double rms = in_.calibration == nullptr ? 0.0 : in_.calibration->rms_px;
    const std::string residual = rms > 0.0 ? fmt::format(" (its residuals are {} RMS)", briefly({rms, 0.0, "px"})) : "";
    const bool flight_too = in_.discovery->outcome == SearchOutcome::camera_against_flight;
    say(VerdictKind::calibration,
        (flight_too ? "the camera comes first: its" : "it is the camera, not the physics: its") +
            std::string(" calibration sweep asks for ") + join_words(asks) + ", which the camera of this study does not have" + residual +
            fmt::format("; estimate {}, too, and run the study again", asks.size() == 1 ? "it" : "them"),
        misfit_command("set", in_.study, shell_word(fmt::format("camera.free=[\"{}\"]", fmt::join(camera_free_with(asks), "\", \""))), "") +
            " && " + command("run"));
  }
  /// What the camera frees, as [camera] free of a study says it, and what its sweep asks for.
  [[nodiscard]] std::vector<std::string> camera_free_with(const std::vector<std::string>& asks) const {
    std::vector<std::string> out;
    const auto add = [&](const std::string& name) {
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    };
    for (const std::string& name : in_.calibration == nullptr ? std::vector<std::string>{} : in_.calibration->names) {
      if (name == "centre_y" || name == "centre_z") add("image_centre");
      if (name == "camera_roll" || name == "pixel_aspect" || name == "lens_k1" || name == "camera_distance") add(name);
    }
    for (const std::string& name : asks) add(name);
    return out;
  }

  /// Of what `discover --auto` has tried beside the last model in vain; nullptr: it has not tried that.
  [[nodiscard]] const std::string* why_taken_off(const std::string& name) const {
    const Rung* last = in_.ladder != nullptr && !in_.ladder->rungs.empty() ? &in_.ladder->rungs.back() : nullptr;
    return last != nullptr && last->why_too_little && last->why_too_little->contains(name) ? &last->why_too_little->at(name) : nullptr;
  }

  /// The search has accepted it, and its rung has gained too little.
  void taken_off(const Candidate& best, const std::string& why) {
    const std::string words = "whether " + std::string(effects_added_ ? "more" : "something") + " is missing is not decided";
    effects_added_ ? added(words, export_command(), VerdictKind::not_decided) : say(VerdictKind::not_decided, words, export_command());
    note_of_effect(effect_at(best.effect, best.roles) + " was accepted, added and taken off again, since once fitted " + why);
  }

  void missing(const Candidate& best) {
    if (!effects_added_) with_candidate(best);
    std::string sentence = best.holds ? hold_in_words(best) : missing_in_words(best, effects_added_);
    if (const std::string change = effects_added_ ? change_by_ladder() : ""; !change.empty())
      sentence += "; with " + names_added(*in_.ladder) + " " + change;
    say(best.group.size() > 1 && !best.holds ? VerdictKind::several_possible : VerdictKind::missing, sentence,
        best.holds ? hold_otherwise(*best.holds) : command("add", best.effect));
    if (best.holds)
      note("the right hold comes first, since what is found beside a wrong one may stand for it");
    else if (best.also)
      note(*best.also);
  }
  /// The command that sets what inputs are between their samples, and runs the study again.
  [[nodiscard]] std::string hold_otherwise(const std::map<std::string, std::string>& holds) const {
    std::string keys;
    for (const auto& [input, hold] : holds) keys += (keys.empty() ? "" : " ") + shell_word("system.hold." + input + "=" + hold);
    return misfit_command("set", in_.study, keys, "") + " && " + command("run") + " --auto";
  }
  /// The random force that the refit with the candidate leaves.
  void with_candidate(const Candidate& best) {
    const auto after = force_strengths(best.force);
    for (ErrorChange& e : out_.errors) {
      if (e.kind != ErrorKind::random_force) continue;
      e.after = strength_in(after, e.before.unit);
      if (e.after) e.remark = not_distinguishable(*e.after);
    }
    std::stable_partition(out_.errors.begin(), out_.errors.end(), [](const ErrorChange& e) { return e.after.has_value(); });
  }

  [[nodiscard]] bool on_ladder(const EffectPlace& curve) const {
    return in_.ladder != nullptr && std::any_of(in_.ladder->rungs.begin(), in_.ladder->rungs.end(),
                                                [&](const Rung& rung) { return rung.added == curve.effect && rung.roles == curve.roles; });
  }

  /// The first curve that `discover --auto` has not tried beside the last model, and that is not in it; nullptr: there is none.
  [[nodiscard]] const EffectPlace* untried(const std::vector<EffectPlace>& curves) const {
    const Rung* last = in_.ladder != nullptr && !in_.ladder->rungs.empty() ? &in_.ladder->rungs.back() : nullptr;
    for (const EffectPlace& curve : curves) {
      const bool tried =
          last != nullptr && last->gained_too_little &&
          std::count(last->gained_too_little->begin(), last->gained_too_little->end(), effect_at(curve.effect, curve.roles)) > 0;
      if (!tried && !on_ladder(curve)) return &curve;
    }
    return nullptr;
  }

  /// Of each that is not untried(): what was tried, and the number that decided.
  void note_curves_in_vain(const std::vector<EffectPlace>& curves) {
    for (const EffectPlace& curve : curves) {
      const std::string name = effect_at(curve.effect, curve.roles);
      const std::string* why = why_taken_off(name);
      if (on_ladder(curve)) {
        note(fmt::format("its curve of unknown form, {}, is in the last model already and leaves this", name));
      } else {
        note(fmt::format("a curve of unknown form in its place, {}, was added and taken off again{}", name,
                         why == nullptr ? "" : ": " + *why));
      }
    }
  }

  /// Only what predicts the held-out data better: else there is no reason to add what was rejected.
  [[nodiscard]] std::string add_rejected(const Candidate& rejected) const {
    if (by_hand(rejected).empty() || !(rejected.held_out_gain.value_or(0.0) > 0.0)) return command("open");
    return command("add", rejected.effect) + (rejected.roles.empty() ? "" : at_place(rejected.roles));
  }

  /// Of the last model; nullptr: what it lacks is there for longer.
  [[nodiscard]] const ForcePulses* pulses_left() const {
    const Diagnosis* last = effects_added_ ? in_.rung_diagnosis : in_.diagnosis;
    return last == nullptr || !last->pulses ? nullptr : &last->pulses->front();
  }
  /// Of pulses a curve of any quantity describes no more than where that happened to be.
  void missing_in_pulses(const ForcePulses& pulses) {
    const std::string words =
        fmt::format("something is {}missing that no effect of the library explains: {}", effects_added_ ? "still " : "", pulses.sentence);
    effects_added_ ? added(words, command("open"), VerdictKind::unknown_form) : say(VerdictKind::unknown_form, words, command("open"));
  }

  /// discover --auto would look for what is missing beside the best one, and has not.
  [[nodiscard]] bool looks_for_two(const Discovery& d) const {
    const Candidate* first = d.candidates.empty() ? nullptr : candidate_short_ahead(d);
    return first != nullptr && first == &d.candidates.front() && why_taken_off(effect_at(first->effect, first->roles)) == nullptr;
  }

  void missing_of_unknown_form(const Discovery& d) {
    const std::string words = fmt::format("something is {}missing that depends on {}: {} that no effect of the library explains",
                                          effects_added_ ? "still " : "", d.unexplained_quantity, unexplained_place(d));
    const EffectPlace* curve = untried(d.unexplained_effects);
    const Candidate* nearest = nearest_of_library(d);
    const bool left_by_curve = std::any_of(d.unexplained_effects.begin(), d.unexplained_effects.end(),
                                           [this](const EffectPlace& place) { return on_ladder(place); });  // between its knots, too
    const std::string next = curve != nullptr ? command("add", curve->effect) + at_place(curve->roles)
                             : nearest != nullptr && !left_by_curve && !effects_added_ ? add_rejected(*nearest)
                                                                                       : command("open");
    effects_added_ ? added(words, next, VerdictKind::unknown_form) : say(VerdictKind::unknown_form, words, next);
    if (!d.unexplained_alike.empty()) note("these data cannot distinguish it from " + join_words(d.unexplained_alike));
    if (nearest != nullptr)
      note(fmt::format("of the library {} comes nearest (drop {}), and leaves {}", effect_at(nearest->effect, nearest->roles),
                       format_value(*nearest->actual_drop), *nearest->remaining));
    if (curve != nullptr) return;
    note_curves_in_vain(d.unexplained_effects);
    note("look where it fails, then write the effect as one line of the study (misfit help study, its formula: misfit help system)");
  }

  void nothing_accepted(const Discovery& d) {
    if (d.outcome == SearchOutcome::not_decided || d.outcome == SearchOutcome::not_finished) {
      const std::string next = command("discover") + more_time(d.outcome);
      if (!effects_added_) return say(VerdictKind::not_decided, d.verdict, next);
      added("whether more is missing is not decided", next, VerdictKind::not_decided);
      note(d.verdict);
    } else if (!d.unexplained_port.empty()) {
      if (const ForcePulses* pulses = pulses_left()) return missing_in_pulses(*pulses);
      if (const Candidate* first = candidate_to_begin_with(d); first != nullptr && first->holds) return missing(*first);
      missing_of_unknown_form(d);
    } else if (effects_added_ && d.outcome == SearchOutcome::best_rejected) {
      const Candidate& best = d.candidates.front();
      added(shows_that_something_is_missing(best) ? "something is still missing, and no effect of the library is accepted"
                                                  : "whether more is missing is not decided",
            add_rejected(best), VerdictKind::not_decided);
      note(best_rejected(best));
      note_of_effect(by_hand(best));
    } else if (d.outcome == SearchOutcome::best_rejected) {
      const Candidate& best = d.candidates.front();
      const bool two = looks_for_two(d);
      say(VerdictKind::not_decided, d.verdict, two ? command("discover") + " --auto" : add_rejected(best));
      two ? note("something else may be missing beside it, with which they do not: --auto looks for both") : note_of_effect(by_hand(best));
    } else if (d.outcome == SearchOutcome::none_suits) {
      say(VerdictKind::not_decided, d.verdict, "misfit help study");
      note("write one as a formula under [effects]");
    } else if (const ForcePulses* pulses = pulses_left()) {
      missing_in_pulses(*pulses);
    } else if (effects_added_) {
      added("nothing more is found missing", export_command());
      if (const std::string doubt = map_in_doubt(in_.rung_diagnosis); !doubt.empty()) note(doubt);
    } else {
      nothing_missing(d);
    }
  }
  /// The random force that drives the motion; of a fit that has none, that which the search had to take beside the model.
  [[nodiscard]] std::vector<ForceStrength> forces_left(const Discovery& d) const {
    constexpr double sigmas = 2.0;
    const bool has_none = fit_->force.empty();
    auto out = has_none ? force_strengths(d.force) : fit_->driven ? force_strengths(fit_->force) : std::vector<ForceStrength>{};
    std::erase_if(out, [&](const ForceStrength& f) {
      return !(f.strength.value > sigmas * f.strength.sigma) || (has_none && !(f.strength.sigma > 0.0));
    });
    return out;
  }
  void nothing_missing(const Discovery& d) {
    if (const std::string why = why_nothing_is_known(*fit_); !why.empty())
      return say(VerdictKind::not_decided, "whether an effect is missing cannot be said: " + why, command("open"));
    for (const std::string& doubt : {motion_in_doubt(in_.comparison), map_in_doubt(in_.diagnosis)}) {
      if (!doubt.empty()) note(doubt);
    }
    const std::size_t tested_alone = effects_tested(d) + curves_tested(d);
    const std::string tested =
        "no effect is found missing" + (tested_alone == 0   ? std::string(", but none of the library was tested")
                                        : tested_alone == 1 ? ": the one that was tested is not needed"
                                                            : ": none of the " + tested_in_words(d) + " that were tested is needed");
    if (const auto forces = forces_left(d); !forces.empty()) {
      say(VerdictKind::random_force, tested + ", and what is left is a random force of " + in_words(forces), export_command());
      note("a disturbance that nothing measures does that, and so would an effect that the library does not have");
    } else {
      say(VerdictKind::nothing_missing, tested, export_command());
    }
  }

  /// What the ladder changes: of the errors where that can be told from chance, else of the map of the force where the study's own model
  /// fails; empty: nothing is known of it.
  [[nodiscard]] std::string change_by_ladder() const {
    const bool fails = !out_.where.empty();
    const ForceMap* before = fails ? &in_.diagnosis->maps.front() : nullptr;
    const ForceMap* after = fails ? map_after(*before) : nullptr;
    if (after != nullptr && (out_.errors.empty() || !is_telling(out_.errors.front())))
      return fmt::format("the missing {} against {} is {} significant ({} before, {} now)", before->port, before->quantity,
                         after->p_corrected > 0.01 ? "no longer" : "still", p_equals(before->p_corrected), p_equals(after->p_corrected));
    if (out_.errors.empty()) return "";
    std::string out = change_in_words(out_.errors.front());
    for (const ErrorChange& e : std::span(out_.errors).subspan(1)) {
      if (clearly_rises(e)) out += ", but " + change_in_words(e);
    }
    return out;
  }
  /// What was added, in clauses, and what comes behind.
  void added(const std::string& rest, const std::string& next, VerdictKind kind = VerdictKind::effect_added) {
    const bool remains = in_.discovery == nullptr || in_.discovery->outcome != SearchOutcome::none_missing;
    std::vector<std::string> clauses = added_in_clauses({*in_.ladder, out_.errors, out_.doubts, remains, change_by_ladder()});
    clauses.push_back(rest);
    say(kind, fmt::format("{}", fmt::join(clauses, "; ")), next);
    if (!out_.doubts.empty()) note("what was added may stand for something else, since the last model is doubtful");
    note_of_effect(begun_in_words(*in_.ladder));
    const bool begins_with_words = clauses.front().starts_with("a ") || clauses.front().starts_with("an ");
    if (!begins_with_words) out_.sentence.replace(0, 1, clauses.front(), 0, 1);  // names of effects keep their small letters
  }

  const VerdictInput& in_;
  const Fit* fit_ = nullptr;
  bool effects_added_ = false;
  Verdict out_;
};

}  // namespace

Verdict verdict_of(const VerdictInput& input) { return VerdictBuilder(input).verdict(); }

}  // namespace misfit
