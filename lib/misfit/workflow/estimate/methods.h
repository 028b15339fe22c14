#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/methods.h"
#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/fit/trajectory_start.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/estimate/scanned_starts.h"

namespace misfit {

/// What a method made of the study's data; `filter` where its model has a random force.
struct MethodRun {
  FittedMethod at;  ///< at.fitted.fit is the fit
  std::shared_ptr<const FilterWork> filter;
  bool out_of_time = false;  ///< cut off by the time limit of the session
};

/// The methods of a study on its data. They share the prepared model and the regression that starts the others: each is made when first
/// asked for. Nothing is written.
class Methods {
 public:
  explicit Methods(Session& session) : session_(session) {}

  /// Within the time limit of the session; a fit that had come to nothing when it was spent says so (failed).
  [[nodiscard]] MethodRun run(const std::string& method);
  [[nodiscard]] const Prepared& prepared();

 private:
  [[nodiscard]] MethodRun run_in_time(const std::string& method);
  /// nullptr: the study has no effect to scan.
  [[nodiscard]] const ScannedStudy* scanned();
  [[nodiscard]] const FittedModel& regression();
  [[nodiscard]] FittedMethod run_in_regression_form(const Estimator& method);

  Session& session_;
  std::optional<Prepared> prepared_;
  std::optional<ScannedStudy> scanned_;
  bool looked_for_scans_ = false;
  std::optional<FittedModel> regression_;
};

/// What the study says of bins, for a channel that the attitude has averaged or not.
[[nodiscard]] SlidingBinOptions bin_options(const Session& session);

}  // namespace misfit
