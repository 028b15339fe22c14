#pragma once

#include <memory>
#include <optional>
#include <string>

#include "misfit/workflow/stages.h"

namespace misfit {

/// The ladder of a study: ladder.json and rungs/NN_EFFECT/ in its run folder. Every rung is a study of its own, with its own results in the
/// out/ beside it.
class ModelLadder {
 public:
  /// Opens the study and its ladder. A ladder of a study or data that have changed since is replaced by a new one; reported on stderr.
  ModelLadder(const Options& options, const Registry& registry);

  [[nodiscard]] Session& root() { return root_; }
  [[nodiscard]] const Ladder& ladder() const { return ladder_; }
  /// The study of the last rung (the root study where there is none), opened. Reported on stderr when it is not the root study.
  [[nodiscard]] Session& last();
  /// The fit of the last rung added here.
  [[nodiscard]] const Fit& last_fit();
  /// Its rung; makes the first one, with its fit, where there is no ladder yet.
  [[nodiscard]] const Rung& last_rung();

  /// A new rung: `effect` (or "system:KIND") added to the last rung. `from`: what discovery says of the effect; without it the rung's note
  /// says why no drop was predicted. What the parent study read from video or pictures is copied. InputError: no such effect, already
  /// there, does not suit the system; RunError: the new model cannot be fitted.
  const Rung& add(const std::string& effect, const std::optional<Candidate>& from);

 private:
  [[nodiscard]] std::string relative_study(const Session& session) const;
  void append(Rung rung);

  Options options_;
  const Registry& registry_;
  Session root_;
  std::unique_ptr<Session> last_;
  Ladder ladder_;
};

/// The options of the command for another study, its results in the out/ beside it.
[[nodiscard]] Options options_for(const Options& options, const std::filesystem::path& study);

/// The report of the study, written anew after its ladder has grown: its path, or on stderr why there is none.
void report_ladder(ModelLadder& ladder);

/// The study's text with the effect added, for `folder`. InputError as ModelLadder::add.
[[nodiscard]] std::string study_with_effect(const Session& session, const std::string& effect, const std::optional<Candidate>& from,
                                            const std::filesystem::path& folder);
/// The study's text with another system: what does not suit it becomes a comment. Names of effects left out go to `left_out`.
[[nodiscard]] std::string study_with_system(const Session& session, const std::string& kind, const std::filesystem::path& folder,
                                            std::vector<std::string>& left_out);

}  // namespace misfit
