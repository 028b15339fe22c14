#include "misfit/workflow/estimate/methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/watch.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/inference/curves.h"

namespace misfit {
namespace {

/// What an uncertain inertia does to every C_m.
void add_scale(const Prepared& form, Fit& fit) {
  const Signals& signals = form.experiments.front();
  const ReconstructedStates states = reconstruct_states(form.model, signals);
  const std::ptrdiff_t sample = std::find(states.ok.begin(), states.ok.end(), true) - states.ok.begin();
  if (sample == std::ssize(states.ok)) return;
  const InputTable inputs = input_table(signals, form.model);
  const auto scales = scale_uncertainties(form.model, states.x.row(sample).data(), inputs.at(sample), signals.t[sample]);
  fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
}

void add_notes(const Prepared& prepared, Fit& fit) {
  for (const auto& experiment : prepared.experiments) {
    if (!experiment.notes.empty()) fit.facts["data: " + experiment.name] = fmt::format("{}", fmt::join(experiment.notes, "; "));
  }
}

/// What the rung began with that this study belongs to.
std::optional<ContainedFit> contained_fit_of(const Session& session) {
  const std::filesystem::path file = session.study.folder / kContainedFitFile;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return read_contained_fit(file);
}

}  // namespace

MethodRun Methods::run(const std::string& method) {
  const Watch watch(method, session_.fit_limit(), session_.options.listener.progress_of(method));
  MethodRun out;
  try {
    out = run_in_time(method);
  } catch (const TimeLimitReached& spent) {
    out.at.method = out.at.fitted.fit.method = method;
    out.at.fitted.fit.message = in_words(spent);
    if (!estimator(method).info.deterministic && !estimator(method).info.regression_form) {
      auto work = std::make_shared<FilterWork>();
      work->fit = out.at.fitted.fit;
      out.filter = std::move(work);
    }
  }
  out.at.time_limit = session_.fit_limit();
  out.out_of_time = out.at.fitted.fit.status != FitStatus::converged && watch.spent();
  return out;
}

MethodRun Methods::run_in_time(const std::string& method) {
  const Estimator& method_of_study = estimator(method);
  if (method_of_study.info.regression_form) return {run_in_regression_form(method_of_study), nullptr};
  auto work = std::make_shared<FilterWork>();
  work->prepared = prepared();
  const auto regression = [this]() -> const FittedModel& { return this->regression(); };
  std::optional<ContainedFit> contained = contained_fit_of(session_);
  const ScannedStudy* scanned = contained ? nullptr : this->scanned();  // a rung begins where discovery ended
  if (scanned != nullptr) {
    work->prepared.model = scanned->model;
    contained = scanned->contained;
  }
  Estimation result = method_of_study.run({.model = work->prepared.model,
                                           .experiments = work->prepared.experiments,
                                           .regression = regression,
                                           .threads = session_.options.threads,
                                           .contained = std::move(contained)});
  Fit& fit = result.at.fitted.fit;
  if (scanned != nullptr) fit.facts.insert(scanned->facts.begin(), scanned->facts.end());
  add_notes(work->prepared, fit);
  if (method_of_study.info.deterministic) return {std::move(result.at), nullptr};
  if (work->prepared.model.free_parameters().empty())
    fit.warnings.emplace_back("every parameter is fixed: only the noise and the random force were estimated");
  work->fit = fit;
  work->estimate = std::move(result.filter);
  return {std::move(result.at), std::move(work)};
}

const Prepared& Methods::prepared() {
  if (prepared_) return *prepared_;
  prepared_ = prepare(session_);
  for (const Signals& experiment : prepared_->experiments) {
    for (const std::string& note : experiment.notes) session_.note(experiment.name + ": " + note);
  }
  return *prepared_;
}

const ScannedStudy* Methods::scanned() {
  if (!looked_for_scans_) scanned_ = scanned_study(session_, prepared());
  looked_for_scans_ = true;
  return scanned_ ? &*scanned_ : nullptr;
}

const FittedModel& Methods::regression() {
  if (!regression_) regression_ = equation_error(prepared().model, prepared().experiments);
  return *regression_;
}

FittedMethod Methods::run_in_regression_form(const Estimator& method) {
  std::vector<std::string> left_out;
  const auto form = prepare_regression(session_, left_out);
  FittedMethod out;
  out.method = method.info.name;
  Fit& fit = out.fitted.fit;
  if (!form) {
    fit.method = method.info.name;
    fit.status = FitStatus::declined;
    fit.message = fmt::format("system '{}' has no form for it: {} needs one equation of motion with a static and a damping curve",
                              session_.model.request.system, method.info.name);
    return out;
  }
  SlidingBinOptions bins = bin_options(session_);
  const Fit& regressed = regression().fit;
  if (regressed.status != FitStatus::declined && regressed.status != FitStatus::failed) bins.driven = regressed.says_driven();
  out = method.run({.model = form->model, .experiments = form->experiments, .bins = bins, .threads = session_.options.threads}).at;
  if (form->experiments.size() > 1)
    fit.warnings.push_back("only the first experiment, '" + form->experiments.front().name + "', is used by this method");
  for (const auto& name : left_out) fit.warnings.push_back("effect '" + name + "' is not in the equation of this method");
  add_scale(*form, fit);
  add_notes(*form, fit);
  return out;
}

SlidingBinOptions bin_options(const Session& session) {
  SlidingBinOptions options;
  if (session.study.bin_width > 0.0) options.width = session.study.bin_width;
  if (session.study.bin_step > 0.0) options.step = session.study.bin_step;
  options.three_point_average = !averaged_by_attitude(session);
  return options;
}

}  // namespace misfit
