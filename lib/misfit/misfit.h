#pragma once

// misfit for C++ programs: what the verbs do, by the same code and with the same files in the same run folder, without a command line and
// without a word on the terminal. tests/package/identify.cpp is an example. Link misfit::workflow and, for the systems and effects that
// come with misfit (misfit_models_registry.h), misfit::models.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

/// A study and the ladder of models that grows from it. Everything throws InputError if the study or what is asked is wrong, and RunError
/// if the data, the model or the disk do not allow it. What was done before, in this process or an earlier one, and has not changed since
/// is read from the run folder. Not thread-safe; the work itself runs on options.threads threads, with the same answer for any number.
class Identification {
 public:
  /// Opens a study (SessionOptions: {"folder/study.toml"} is enough) and its ladder. `registry`: the systems and effects that there are; it
  /// must outlive this object. RunError if another process works in the run folder.
  Identification(const SessionOptions& options, const Registry& registry) : registry_(registry), ladder_(options, registry) {}

  /// The model as it is by now, that of the last rung, fitted by each method of the study. Look at Fit::status: a method that declines or
  /// fails is not an exception. Curves and parameters are in SI; sigma is the standard error.
  [[nodiscard]] std::vector<Fit> fit() { return fit_stage(ladder_.last()); }
  /// The same by one method.
  [[nodiscard]] Fit fit(const std::string& method) { return fit_stage(ladder_.last(), {method}).front(); }
  /// Effects that the model may be missing, ranked, with a verdict. RunError if filter_error declines, on whose residuals it rests.
  [[nodiscard]] Discovery discover() { return discovered(ladder_.last()); }
  /// The effect that discovery accepts; nullopt if it accepts none, or only a dependence of unknown form.
  [[nodiscard]] std::optional<Candidate> accepted(const Discovery& discovery) const { return accepted_candidate(discovery, registry_); }
  /// A new rung: the model with the effect (or "system:KIND" instead of its system), a study of its own below the run folder, fitted by
  /// filter_error. The rung says what log-likelihood and errors have become; all that follows works on the new model.
  const Rung& add(const std::string& effect) { return ladder_.add(effect, prediction_for(ladder_, effect)); }
  /// The same with the bindings and start values that discovery found.
  const Rung& add(const Candidate& candidate) { return ladder_.add(candidate.effect, candidate); }
  /// What `discover --auto` does: rungs until nothing more is gained (extend_ladder()).
  void extend() { extend_ladder(ladder_, registry_); }
  /// The rungs so far.
  [[nodiscard]] const Ladder& ladder() const { return ladder_.ladder(); }
  /// Figures and report.html of the study with its ladder; the path of the page.
  std::filesystem::path report() { return write_report(ladder_); }
  /// The study of the last rung, for all other stages: workflow/stages.h, workflow/simulate.h.
  [[nodiscard]] Session& session() { return ladder_.last(); }

 private:
  const Registry& registry_;
  ModelLadder ladder_;
};

/// The curve of that name: x [of_unit], value and sigma [unit]; its 95 % band is value ± 1.96 sigma, to be used where `count` is not 0.
/// InputError if the fit has no such curve.
[[nodiscard]] inline const CurveEstimate& curve(const Fit& fit, const std::string& name) {
  const auto found = std::find_if(fit.curves.begin(), fit.curves.end(), [&](const CurveEstimate& c) { return c.name == name; });
  if (found != fit.curves.end()) return *found;
  std::vector<std::string> names;
  for (const CurveEstimate& c : fit.curves) names.push_back(c.name);
  throw InputError("the fit by " + fit.method + " has no curve '" + name + "'" + suggest(name, names));
}

}  // namespace misfit
