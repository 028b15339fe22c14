#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/stages.h"

namespace misfit {

/// The ladder of a study: ladder.json and rungs/NN_EFFECT/ in its run folder. Every rung is a study of its own, with its own results in the
/// out/ beside it.
class Climb {
 public:
  /// Opens the study and its ladder. A ladder of a study or data that have changed since is begun anew; said on stderr.
  Climb(const Options& options, const Registry& registry);

  [[nodiscard]] Session& original() { return original_; }
  [[nodiscard]] const Ladder& ladder() const { return ladder_; }
  /// The study of the last rung (the original where there is none), opened. Said on stderr when it is not the original.
  [[nodiscard]] Session& top();
  /// The fit of the last rung added here.
  [[nodiscard]] const Fit& top_fit();
  /// Its rung; makes the first one, with its fit, where there is no ladder yet.
  [[nodiscard]] const Rung& top_rung();

  /// A new rung: `effect` (or "system:KIND") added to the top. `from`: what discovery says of the effect; without it the rung's note says
  /// why no drop was predicted. What the study below read from video or pictures is copied. InputError: no such effect, already there, does
  /// not suit the system; RunError: the new model cannot be fitted.
  const Rung& add(const std::string& effect, const std::optional<Candidate>& from);

 private:
  [[nodiscard]] std::string relative_study(const Session& session) const;
  void append(Rung rung);

  Options options_;
  const Registry& registry_;
  Session original_;
  std::unique_ptr<Session> top_;
  Ladder ladder_;
};

/// The options of the command for another study, its results in the out/ beside it.
[[nodiscard]] Options options_for(const Options& options, const std::filesystem::path& study);

/// The report of the study, written anew after its ladder has grown: its path, or in words on stderr why there is none.
void report_ladder(Climb& climb);

/// The study's text with the effect added, for `folder`. InputError as Climb::add.
[[nodiscard]] std::string study_with_effect(const Session& session, const std::string& effect, const std::optional<Candidate>& from,
                                            const std::filesystem::path& folder);
/// The study's text with another system: what does not suit it becomes a comment. Names of effects left out go to `left_out`.
[[nodiscard]] std::string study_with_system(const Session& session, const std::string& kind, const std::filesystem::path& folder,
                                            std::vector<std::string>& left_out);

}  // namespace misfit
