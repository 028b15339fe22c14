#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "misfit/workflow/stages.h"

namespace misfit {

/// The ladder of a study: ladder.json and rungs/NN_EFFECT/ in its run folder. Every rung is a study of its own, with its own results in the
/// out/ beside it.
class ModelLadder {
 public:
  /// Opens the study and its ladder. A ladder of a study (comments and references aside) or of files of it that have changed
  /// since is replaced by a new one; a note says so.
  ModelLadder(const SessionOptions& options, const Registry& registry);

  [[nodiscard]] Session& root() { return root_; }
  [[nodiscard]] const Ladder& ladder() const { return ladder_; }
  /// The study of the last rung (the root study where there is none), opened. A note says so when it is not the root study.
  [[nodiscard]] Session& last();
  /// The fit of the last rung added here.
  [[nodiscard]] const Fit& last_fit();
  /// Its rung; makes the first one, with its fit, where there is no ladder yet.
  const Rung& last_rung();

  /// A new rung: `effect` (or "system:KIND") added to the last rung. `from`: what discovery says of the effect; without it the rung's note
  /// says why no drop was predicted. What the parent study read from video or pictures is copied. InputError: no such effect, already
  /// there, does not suit the system; RunError: the new model cannot be fitted.
  const Rung& add(const std::string& effect, const std::optional<Candidate>& from);

  /// Takes the rung that is asked for (its number or its effect) and all that were added after it off the ladder. What they have computed
  /// is kept: their folders are renamed to rungs/removed_NN_EFFECT. Returns these. InputError: there is no such rung, or it is the study's
  /// own model.
  std::vector<std::filesystem::path> remove(const std::string& asked);

  /// Notes of what was added and taken off again, as effect_at() says it, that it gains too little beside the last rung's model, and why.
  void gained_too_little(const std::string& effect, const std::string& why);

  /// Notes why the last rung stays though its predictions of what is held out are worse one sample ahead (why_free_run_is_better()).
  void stays_for_free_run(const std::string& why);

  /// Where the study asks for output_error, and that of its own model follows the motion, that of the last rung, too: errors of free runs
  /// before and after.
  void compare_free_runs();

  /// Of what was added, seen from the second horizon: where the study asks for output_error and the model below the last rung
  /// follows the motion by it, why the last rung's free run is worse (it no longer follows, or its errors grow by more than 3 %, of what is
  /// held out 5 %); else empty.
  [[nodiscard]] std::string why_free_run_is_worse();
  /// By how much the errors of that free run fall with the last rung; empty where they do not by a tenth, in what is fitted and in what is
  /// held out: the held-out likelihood of a filter whose linearisation is poor (a level at a lid) says less than they do.
  [[nodiscard]] std::string why_free_run_is_better();

  /// From now on a rung's fit has a time limit where nobody gives one (usual_limit()): nobody waits for it.
  void limit_fits() { limits_fits_ = true; }

 private:
  /// By output_error, of the model below the last rung and of that.
  struct FreeRuns {
    Fit before, after;
  };
  /// nullopt: the study does not ask for them, or the model below does not follow the motion.
  std::optional<FreeRuns> free_runs_of_last();
  [[nodiscard]] std::string relative_study(const Session& session) const;
  /// [s] That its fit took; 0: it is not there.
  [[nodiscard]] double seconds_of_fit(const Rung& rung) const;
  /// The study of a rung that is to be added.
  struct NewStudy {
    int id = 0;
    bool system = false;  ///< it has another system instead of one more effect
    std::string name;     ///< of the effect or the system
    std::string place;    ///< its folder in the run folder
    std::string text;
    std::vector<std::string> left_out;  ///< effects that do not suit its system
    std::optional<Candidate> from;      ///< what discovery says of the effect
  };
  [[nodiscard]] NewStudy new_study(const std::string& effect, const std::optional<Candidate>& from);
  /// Written to its folder with the parent's estimate beside it, to begin with where it has the parent's system.
  [[nodiscard]] std::unique_ptr<Session> open(const NewStudy& study, const Session& parent, const FilterWork& parent_work);
  void append(Rung rung);
  void store();
  /// Renames the folder of a rung; nullopt: it has none of its own. WriteError.
  [[nodiscard]] std::optional<std::filesystem::path> kept_aside(const Rung& rung) const;

  SessionOptions options_;
  const Registry& registry_;
  Session root_;
  std::unique_ptr<Session> last_;
  bool limits_fits_ = false;
  Ladder ladder_;
};

/// Growth of the longest predictions' errors (growth_of_errors()), the larger one of what is fitted and of what is held out.
[[nodiscard]] double largest_growth(const Rung& before, const Rung& after);

/// What discovery says of the effect for the last rung: roles, where to start, the drop it predicts. Asked before the effect is added, so
/// that the prediction is one. nullopt for a change of system, which no discovery ranks. InputError as ModelLadder::add and
/// predict_effect().
[[nodiscard]] std::optional<Candidate> prediction_for(ModelLadder& ladder, const std::string& effect, const AskedPlace& place = {});

/// Of these the rung with this number or effect. InputError with the nearest name; `asked_by` begins it.
[[nodiscard]] const Rung& find_rung(std::span<const Rung> rungs, const std::string& number_or_effect, const std::string& asked_by);

/// The best accepted candidate that is an effect of the library, so that one line adds it to a study.
[[nodiscard]] std::optional<Candidate> accepted_candidate(const Discovery& discovery, const Registry& registry);

/// What happens while a ladder is extended. Empty functions: nobody listens.
struct LadderListener {
  std::function<void(const Discovery&)> discovered;
  std::function<void(const Rung&)> added;
};

/// discover --auto (lib/misfit/README.md, 6.5): adds the accepted effect and searches again, or where none is accepted the one to begin
/// with (candidate_to_begin_with), or else a curve of unknown form, until nothing more is gained or 12 rounds are done. A rung whose drop
/// may be chance is taken off again, and so is an effect added here that later ones have made needless (leaving.h), those above it being
/// added again without it; one of its alternatives takes its place where that explains clearly more now. Of a needless effect that somebody
/// else added, a note.
void extend_ladder(ModelLadder& ladder, const Registry& registry, const LadderListener& listener = {});

/// The same options for another study, its results in the out/ beside it.
[[nodiscard]] SessionOptions options_for(const SessionOptions& options, const std::filesystem::path& study);

/// Diagnoses the study's own model and that of the last rung: where the force was missing, before and after.
void diagnose_rungs(ModelLadder& ladder);

/// Diagnoses both and writes the report of the study with its ladder; the path of the page.
std::filesystem::path write_report(ModelLadder& ladder);

/// The same after the ladder has grown: a note has the path, or why there is none.
void report_ladder(ModelLadder& ladder);

/// The study's text with the effect added, for `folder`. InputError as ModelLadder::add.
[[nodiscard]] std::string study_with_effect(const Session& session, const std::string& effect, const std::optional<Candidate>& from,
                                            const std::filesystem::path& folder);
/// The study's text with another system: what does not suit it becomes a comment. Names of effects left out go to `left_out`.
[[nodiscard]] std::string study_with_system(const Session& session, const std::string& kind, const std::filesystem::path& folder,
                                            std::vector<std::string>& left_out);

}  // namespace misfit
