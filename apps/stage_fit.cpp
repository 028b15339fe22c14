#include <algorithm>
#include <chrono>

#include "apps/stages.h"
#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/progress.h"
#include "misfit/core/text.h"
#include "misfit/fit/curves.h"
#include "misfit/fit/filter_error.h"
#include "misfit/fit/output_error.h"
#include "misfit/fit/sliding_bin.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// The methods share the prepared model and the regression that starts the others: each is made when first asked for.
class Methods {
 public:
  explicit Methods(Session& session) : session_(session) {}

  Fit run(const std::string& method) {
    if (method == "sliding_bin") return run_sliding_bin();
    if (method == "equation_error") return regression().fit;
    if (method == "output_error") return run_output_error();
    session_.filter = run_filter_error();
    return session_.filter->fit;
  }

  std::shared_ptr<const FilterWork> run_filter_error() {
    auto work = std::make_shared<FilterWork>();
    work->prepared = prepared();
    FilterOptions options;
    options.threads = session_.options.threads;
    FilterError result = filter_error(started().first, work->prepared.experiments, options);
    work->fit = std::move(result.fit);
    work->estimate = std::move(result.estimate);
    add_notes(work->prepared, work->fit);
    if (work->prepared.model.free_parameters().empty())
      work->fit.warnings.emplace_back("every parameter is fixed: only the noise and the random force were estimated");
    return work;
  }

  const Prepared& prepared() {
    if (!prepared_) prepared_ = prepare(session_);
    return *prepared_;
  }

 private:
  const FittedModel& regression() {
    if (!regression_) {
      regression_ = equation_error(prepared().model, prepared().experiments);
      add_notes(prepared(), regression_->fit);
    }
    return *regression_;
  }

  Fit run_sliding_bin() {
    std::vector<std::string> left_out;
    const auto form = prepare_regression(session_, left_out);
    if (!form) {
      Fit fit;
      fit.method = "sliding_bin";
      fit.status = FitStatus::declined;
      fit.message = "system '" + session_.model.request.system +
                    "' has no form for it: sliding_bin needs one equation of motion with a static and a damping curve";
      return fit;
    }
    SlidingBinOptions options;
    if (session_.study.bin_width > 0.0) options.width = session_.study.bin_width;
    if (session_.study.bin_step > 0.0) options.step = session_.study.bin_step;
    options.three_point_average = !averaged_by_attitude(session_);
    Fit fit = sliding_bin(form->model, form->experiments.front(), options);
    if (form->experiments.size() > 1)
      fit.warnings.push_back("only the first experiment, '" + form->experiments.front().name + "', is used by this method");
    for (const auto& name : left_out) fit.warnings.push_back("effect '" + name + "' is not in the equation of this method");
    add_scale(*form, fit);
    add_notes(*form, fit);
    return fit;
  }

  /// What an uncertain inertia does to every C_m (DESIGN 5).
  static void add_scale(const Prepared& form, Fit& fit) {
    const Signals& signals = form.experiments.front();
    const ReconstructedStates states = reconstruct_states(form.model, signals);
    const auto known = std::find(states.ok.begin(), states.ok.end(), true) - states.ok.begin();
    if (known == static_cast<std::ptrdiff_t>(states.ok.size())) return;
    const InputTable inputs = input_table(signals, form.model.inputs());
    const auto sample = static_cast<std::size_t>(known);
    const auto scales = scale_uncertainties(form.model, states.x.row(known).data(), inputs.at(sample), signals.t[sample]);
    fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
  }

  /// The regression with every shape (a clock angle, a frequency) where the study puts it: linear, so that no start is lost in a valley of
  /// another shape. Its parameters are then as free as the study says.
  FittedModel with_shapes_kept() {
    const Model& asked = prepared().model;
    Model kept = asked;
    bool any = false;
    for (auto& p : kept.parameters) {
      const bool shape = p.free && p.curve < 0 && p.kind == CoefficientKind::shape;
      if (shape) p.free = false;
      any = any || shape;
    }
    if (!any) return regression();
    FittedModel start = equation_error(kept, prepared().experiments);
    for (std::size_t i = 0; i < asked.parameters.size(); ++i) start.model.parameters[i].free = asked.parameters[i].free;
    std::vector<Penalty> penalties = curve_penalties(start.model);
    for (std::size_t k = 0; k < penalties.size(); ++k) penalties[k].lambda = start.penalties[k].lambda;
    start.penalties = std::move(penalties);
    return start;
  }

  /// Where the trajectory methods start, and whether the regression gave it.
  std::pair<FittedModel, bool> started() {
    FittedModel start = with_shapes_kept();
    const bool regressed = start.fit.status != FitStatus::declined && start.fit.status != FitStatus::failed;
    // Of a regression on driven motion only the static curve means something (DESIGN 5).
    if (regressed && start.fit.driven) damping_to_zero(start.model);
    return {std::move(start), regressed};
  }

  Fit run_output_error() {
    auto [start, regressed] = started();
    if (!regressed && start.model.free_parameters().empty()) {
      start.fit.method = "output_error";
      return start.fit;
    }
    OutputErrorStart options;
    options.from_regression = regressed;
    Fit fit = output_error(start, prepared().experiments, options).fit;
    add_notes(prepared(), fit);
    return fit;
  }

  static void damping_to_zero(Model& model) {
    const Curve* damping = model.find_curve(model.system->spec().damping_curve);
    if (damping == nullptr) return;
    for (int i = 0; i < damping->spline.size(); ++i) model.parameters[static_cast<std::size_t>(damping->first + i)].value = 0.0;
  }

  static void add_notes(const Prepared& prepared, Fit& fit) {
    for (const auto& experiment : prepared.experiments) {
      for (const auto& note : experiment.notes) fit.facts["data: " + experiment.name + ": " + note] = note;
    }
  }

  Session& session_;
  std::optional<Prepared> prepared_;
  std::optional<FittedModel> regression_;
};

std::map<std::string, std::string> inputs_of(const Session& session, const std::string& method) {
  std::vector<fs::path> files;
  if (session.study.system_file) files.push_back(*session.study.system_file);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (experiment.data) files.push_back(*experiment.data);
    if (!has_track(experiment)) continue;
    files.push_back(track_files(session, e).track);
    files.push_back(session.folder.file(e == 0 ? "attitude.csv" : "attitude_" + experiment.name + ".csv"));
  }
  if (session.study.has_camera) files.push_back(session.folder.file("camera.json"));
  for (const auto& [name, curve] : session.study.curves) {
    if (curve.table) files.push_back(*curve.table);
  }
  return session.inputs(method + "\n" + session.study.text, files);
}

std::vector<std::string> outputs_of(const fs::path& run_folder, const fs::path& dir) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(dir)) out.push_back(entry.path().lexically_relative(run_folder).string());
  out.emplace_back("resolved.toml");
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::shared_ptr<const FilterWork> filter_work(Session& session) {
  if (!session.filter) {
    session.say("estimating filter_error again for what follows");
    session.filter = Methods(session).run_filter_error();
  }
  if (!session.filter->estimate)
    throw RunError("filter_error " + to_string(session.filter->fit.status) + ": " + session.filter->fit.message);
  return session.filter;
}

std::vector<Fit> fit_stage(Session& session) { return fit_stage(session, session.methods()); }

std::vector<Fit> fit_stage(Session& session, const std::vector<std::string>& names) {
  static_cast<void>(attitude_stage(session));
  std::vector<Fit> fits;
  Methods methods(session);
  Progress progress("fit", session.options.quiet);
  for (std::size_t k = 0; k < names.size(); ++k) {
    stop_if_interrupted();
    const std::string stage = "fit/" + names[k];
    const fs::path dir = session.folder.file(stage);
    const auto inputs = inputs_of(session, names[k]);
    if (session.folder.up_to_date(stage, inputs)) {
      fits.push_back(read_fit(dir));
    } else {
      const auto begin = std::chrono::steady_clock::now();
      const Prepared& prepared = methods.prepared();  // a study that makes no model is refused before any method has left a result
      fits.push_back(methods.run(names[k]));
      fs::remove_all(dir);
      make_writable_folder(dir);
      write_fit(dir, fits.back());
      write_resolved(session, prepared);
      session.folder.record({stage, session.options.command, inputs, outputs_of(session.folder.path(), dir),
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), "", ""});
    }
    progress.update(k + 1, names.size());
  }
  return fits;
}

}  // namespace misfit
