#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/fit/trajectory_start.h"
#include "misfit/workflow/stages.h"

namespace misfit {

/// The methods of a study on its data. They share the prepared model and the regression that starts the others: each is made when first
/// asked for. Nothing is written.
class Methods {
 public:
  explicit Methods(Session& session) : session_(session) {}

  [[nodiscard]] Fit run(const std::string& method);
  [[nodiscard]] std::shared_ptr<const FilterWork> run_filter_error();
  [[nodiscard]] FittedModel run_output_error();
  [[nodiscard]] const FittedModel& regression();
  [[nodiscard]] const Prepared& prepared();

 private:
  [[nodiscard]] Fit run_sliding_bin();
  [[nodiscard]] TrajectoryStart started();

  Session& session_;
  std::optional<Prepared> prepared_;
  std::optional<FittedModel> regression_;
};

/// What the study says of bins, for a channel that the attitude has averaged or not.
[[nodiscard]] SlidingBinOptions bin_options(const Session& session);

/// The words with which sliding_bin declines a system that has no form for it.
[[nodiscard]] Fit no_regression_form(const Session& session);

}  // namespace misfit
