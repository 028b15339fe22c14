#include "misfit/workflow/methods.h"

#include <algorithm>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/inference/curves.h"

namespace misfit {
namespace {

/// What an uncertain inertia does to every C_m.
void add_scale(const Prepared& form, Fit& fit) {
  const Signals& signals = form.experiments.front();
  const ReconstructedStates states = reconstruct_states(form.model, signals);
  const auto known = std::find(states.ok.begin(), states.ok.end(), true) - states.ok.begin();
  if (known == static_cast<std::ptrdiff_t>(states.ok.size())) return;
  const InputTable inputs = input_table(signals, form.model.inputs());
  const auto sample = static_cast<std::size_t>(known);
  const auto scales = scale_uncertainties(form.model, states.x.row(known).data(), inputs.at(sample), signals.t[sample]);
  fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
}

void add_notes(const Prepared& prepared, Fit& fit) {
  for (const auto& experiment : prepared.experiments) {
    for (const auto& note : experiment.notes) fit.facts["data: " + experiment.name + ": " + note] = note;
  }
}

}  // namespace

Fit Methods::run(const std::string& method) {
  if (method == "sliding_bin") return run_sliding_bin();
  if (method == "equation_error") return regression().fit;
  if (method == "output_error") return run_output_error().fit;
  session_.filter = run_filter_error();
  return session_.filter->fit;
}

std::shared_ptr<const FilterWork> Methods::run_filter_error() {
  auto work = std::make_shared<FilterWork>();
  work->prepared = prepared();
  FilterOptions options;
  options.threads = session_.options.threads;
  FilterError result = filter_error(started().from, work->prepared.experiments, options);
  work->fit = std::move(result.fit);
  work->estimate = std::move(result.estimate);
  add_notes(work->prepared, work->fit);
  if (work->prepared.model.free_parameters().empty())
    work->fit.warnings.emplace_back("every parameter is fixed: only the noise and the random force were estimated");
  return work;
}

const Prepared& Methods::prepared() {
  if (!prepared_) prepared_ = prepare(session_);
  return *prepared_;
}

const FittedModel& Methods::regression() {
  if (!regression_) {
    regression_ = equation_error(prepared().model, prepared().experiments);
    add_notes(prepared(), regression_->fit);
  }
  return *regression_;
}

Fit Methods::run_sliding_bin() {
  std::vector<std::string> left_out;
  const auto form = prepare_regression(session_, left_out);
  if (!form) return no_regression_form(session_);
  Fit fit = sliding_bin(form->model, form->experiments.front(), bin_options(session_));
  if (form->experiments.size() > 1)
    fit.warnings.push_back("only the first experiment, '" + form->experiments.front().name + "', is used by this method");
  for (const auto& name : left_out) fit.warnings.push_back("effect '" + name + "' is not in the equation of this method");
  add_scale(*form, fit);
  add_notes(*form, fit);
  return fit;
}

TrajectoryStart Methods::started() {
  return trajectory_start(prepared().model, prepared().experiments, [this]() -> const FittedModel& { return regression(); });
}

FittedModel Methods::run_output_error() {
  auto [start, regressed] = started();
  if (!regressed && start.model.free_parameters().empty()) {
    start.fit.method = "output_error";
    return start;
  }
  OutputErrorStart options;
  options.from_regression = regressed;
  FittedModel out = output_error(start, prepared().experiments, options);
  add_notes(prepared(), out.fit);
  return out;
}

SlidingBinOptions bin_options(const Session& session) {
  SlidingBinOptions options;
  if (session.study.bin_width > 0.0) options.width = session.study.bin_width;
  if (session.study.bin_step > 0.0) options.step = session.study.bin_step;
  options.three_point_average = !averaged_by_attitude(session);
  return options;
}

Fit no_regression_form(const Session& session) {
  Fit fit;
  fit.method = "sliding_bin";
  fit.status = FitStatus::declined;
  fit.message = "system '" + session.model.request.system +
                "' has no form for it: sliding_bin needs one equation of motion with a static and a damping curve";
  return fit;
}

}  // namespace misfit
