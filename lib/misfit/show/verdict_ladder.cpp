#include "misfit/show/verdict_ladder.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/text.h"
#include "misfit/data/candidates.h"
#include "misfit/show/error_changes.h"

namespace misfit {
namespace {

/// What the likelihood says of what a rung added. Of the hold: it is late by half a sampling interval, which is the hold of an input and
/// nothing that is missing. A part: something remained beside it, and still does at the end of the ladder, so that it may only look like
/// what is missing; so may a curve of unknown form. Far ahead: what is held out is predicted worse one sample ahead, and the free run is
/// better. Untested: no likelihood compares it with the model before (another system, or a comparison that was cut off).
enum class Evidence { needed, of_the_hold, a_part, far_ahead, untested, predicts_worse, chance };

/// A curve: it may take up a part of anything.
bool is_of_unknown_form(const Rung& rung) {
  return rung.added == "unknown_force" || rung.added == "unknown_error" || rung.added == "unknown_variation";
}

Evidence evidence_for(const Rung& rung, bool something_remains) {
  if (!rung.actual_drop) return Evidence::untested;
  if (explains_no_more_than_chance(rung)) return Evidence::chance;
  if (rung.holds) return Evidence::of_the_hold;
  if (!is_seen_in_measurements(rung) && rung.held_out_gain && *rung.held_out_gain < 0.0)
    return rung.stays_for_free_run ? Evidence::far_ahead : Evidence::predicts_worse;
  const bool takes_up_a_rest = rung.remained || is_of_unknown_form(rung);
  return takes_up_a_rest && something_remains ? Evidence::a_part : Evidence::needed;
}

/// What is said of one effect, and of several.
struct Words {
  const char *of_one, *of_several;
};

Words words_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::of_the_hold:
      return {" is half a sampling interval late: it is the hold of an input that is wrong, not the model",
              " are half a sampling interval late: it is the hold of an input that is wrong, not the model"};
    case Evidence::a_part:
      return {" explains a part of what is missing", " explain a part of what is missing"};
    case Evidence::far_ahead:
      return {" was added, and stays for the free run, though one sample ahead what is held out is predicted worse with it",
              " were added, and stay for the free run, though one sample ahead what is held out is predicted worse with them"};
    case Evidence::untested:
      return {" was added, and no likelihood compares it with the model before",
              " were added, and no likelihood compares them with the models before"};
    case Evidence::predicts_worse:
      return {" was added, and what is held out is predicted worse with it",
              " were added, and what is held out is predicted worse with them"};
    case Evidence::chance:
      return {" was added and explains no more than chance does", " were added and explain no more than chance does"};
    case Evidence::needed:
      break;
  }
  return {" was missing", " were missing"};
}

/// With what was added an RMS error is larger, and none is smaller.
bool gets_worse(const std::vector<ErrorChange>& errors) {
  constexpr double hardly = 3.0;  // [%]
  bool rises = false, falls = false;
  for (const ErrorChange& e : errors) {
    if (e.kind != ErrorKind::rms_error || e.within_sigma()) continue;
    rises = rises || e.per_cent().value_or(0.0) > hardly;
    falls = falls || e.per_cent().value_or(0.0) < 0.0;
  }
  return rises && !falls;
}

/// Of several rungs the first that no test accepted by itself: what came after it was chosen beside it. nullptr: there is none.
const Rung* begun_with(const Ladder& ladder) {
  constexpr std::size_t several = 3;  // the study's own model among them
  const auto found = std::find_if(ladder.rungs.begin(), ladder.rungs.end(), [](const Rung& r) { return r.remained.has_value(); });
  return ladder.rungs.size() < several || found == ladder.rungs.end() ? nullptr : &*found;
}

Words words_of_needed(const AddedWork& work) {
  if (gets_worse(work.errors)) return {" was added", " were added"};
  const bool doubtful = !work.doubts.empty() || begun_with(work.ladder) != nullptr;
  return doubtful ? Words{" describes what was missing", " describe what was missing"} : words_of(Evidence::needed);
}

std::size_t effects_added(const Ladder& ladder) {
  return static_cast<std::size_t>(
      std::count_if(ladder.rungs.begin(), ladder.rungs.end(), [](const Rung& rung) { return !rung.added.empty(); }));
}

}  // namespace

namespace {

/// An effect by its name; a curve of unknown form by what it is.
std::string rung_in_words(const Rung& rung) {
  const auto role = [&](const char* name) { return rung.roles && rung.roles->contains(name) ? rung.roles->at(name) : std::string(); };
  const auto curve = [&](const char* place, const char* of, bool error, bool parameter) {
    const std::string at = role(place), with = role(of);
    if (at.empty() || with.empty()) return added_in_words(rung);
    return fmt::format("{} that depends on {} ({}, a curve)", unexplained_place(at, error, parameter), with, rung.added);
  };
  if (rung.added == "unknown_force") return curve("port", "of", false, false);
  if (rung.added == "unknown_error") return curve("output", "of", true, false);
  if (rung.added == "unknown_variation") return curve("parameter", "with", false, true);
  return added_in_words(rung);
}

}  // namespace

std::string names_added(const Ladder& ladder) {
  std::vector<std::string> names;
  for (const Rung& rung : ladder.rungs) {
    if (!rung.added.empty()) names.push_back(added_in_words(rung));
  }
  return join_words(names);
}

std::vector<std::string> added_in_clauses(const AddedWork& work) {
  std::vector<std::string> out;
  bool explains = false;  // anything more than chance does
  for (const Evidence evidence : {Evidence::needed, Evidence::of_the_hold, Evidence::a_part, Evidence::far_ahead, Evidence::untested,
                                  Evidence::predicts_worse, Evidence::chance}) {
    std::vector<std::string> names;
    for (const Rung& rung : work.ladder.rungs) {
      if (!rung.added.empty() && evidence_for(rung, work.something_remains) == evidence) names.push_back(rung_in_words(rung));
    }
    if (names.empty()) continue;
    const Words words = evidence == Evidence::needed ? words_of_needed(work) : words_of(evidence);
    out.push_back(join_words(names) + (names.size() == 1 ? words.of_one : words.of_several));
    explains = explains || evidence != Evidence::chance;
  }
  if (work.change.empty() || !explains) return out;
  const char* with = out.size() > 1 ? "all that was added" : effects_added(work.ladder) == 1 ? "it" : "them";
  out.front() += fmt::format(": with {} {}", with, work.change);
  return out;
}

std::string begun_in_words(const Ladder& ladder) {
  const Rung* first = begun_with(ladder);
  if (first == nullptr) return "";
  return added_in_words(*first) + " was begun with though by itself it left a lack of fit, so that it may stand for something else";
}

}  // namespace misfit
