#include <fmt/ranges.h>

#include <cstdlib>

#include "misfit/core/config.h"
#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/estimate/methods.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// resolved.toml. A study that makes no model is refused here, before any method has left a result.
void resolved_stage(Session& session, Methods& methods) {
  auto inputs = inputs_of_fit(session, "resolved");
  inputs["methods"] = fmt::format("{} seed {}", fmt::join(session.methods(), " "), session.study.seed);
  session.do_stage("resolved", inputs, {"resolved.toml"}, [&](const fs::path& dir) { write_resolved(session, methods.prepared(), dir); });
}

constexpr const char* usual_limit_key = "usual_limit";

/// [s] Of a fit that the usual limit cut off; nullopt: it was not.
std::optional<double> limit_that_cut_off(const Session& session, const std::string& stage) {
  const auto known = session.folder.stages().find(stage);
  if (known == session.folder.stages().end()) return std::nullopt;
  const auto limit = known->second.inputs.find(usual_limit_key);
  return limit == known->second.inputs.end() ? std::nullopt : std::optional(std::strtod(limit->second.c_str(), nullptr));
}

}  // namespace

StageInputs inputs_of_fit(const Session& session, const std::string& method, const std::vector<std::string>& without) {
  std::vector<fs::path> files = files_of_attitude(session);
  if (session.study.system_file) files.push_back(*session.study.system_file);
  if (const fs::path contained = session.study.folder / kContainedFitFile; fs::exists(contained)) files.push_back(contained);
  for (const ExperimentStudy& experiment : session.study.experiments) {
    if (experiment.data) files.push_back(*experiment.data);
  }
  for (const auto& [name, curve] : session.study.curves) {
    if (curve.table) files.push_back(*curve.table);
  }
  StageInputs inputs = session.inputs(method + "\n" + config::content_of(session.study.text, without), files);
  if (session.options.time_limit) inputs["time_limit"] = fmt::format("{} s", *session.options.time_limit);
  const std::optional<double> cut_off = limit_that_cut_off(session, "fit/" + method);
  const double limit = session.asked_limit() ? 0.0 : session.usual_limit;
  if (cut_off && limit > 0.0 && limit <= *cut_off) inputs[usual_limit_key] = fmt::format("{} s", *cut_off);  // no more time now than then
  return inputs;
}

std::shared_ptr<const FilterWork> filter_work(Session& session) {
  if (!session.filter) {
    const std::string method = random_force_estimator().name;
    session.note(method + " once more: the next stage needs more of it than the run folder keeps");
    session.filter = Methods(session).run(method).filter;
  }
  if (!session.filter->estimate)
    throw RunError(session.filter->fit.method + " " + to_string(session.filter->fit.status) + ": " + session.filter->fit.message);
  return session.filter;
}

std::vector<Fit> fit_stage(Session& session) { return fit_stage(session, session.methods()); }

std::vector<Fit> fit_stage(Session& session, const std::vector<std::string>& names) {
  attitude_stage(session);
  std::vector<Fit> fits;
  Methods methods(session);
  resolved_stage(session, methods);
  const ProgressFn progress = session.progress("fit");
  for (std::size_t k = 0; k < names.size(); ++k) {
    stop_if_interrupted();
    const std::string stage = "fit/" + names[k];
    StageInputs inputs = inputs_of_fit(session, names[k]);
    session.do_stage(stage, inputs, {stage + "/fit.json"}, [&](const fs::path& dir) {
      MethodRun run = methods.run(names[k]);
      inputs.erase(usual_limit_key);
      if (run.out_of_time && !session.asked_limit()) inputs[usual_limit_key] = fmt::format("{} s", session.usual_limit);  // recorded so
      if (run.filter) session.filter = std::move(run.filter);
      write_fit(dir / stage, run.at.fitted.fit);
    });
    fits.push_back(read_fit(session.folder.file(stage)));
    if (session.options.listener.fitted) session.options.listener.fitted(fits.back());
    progress(k + 1, names.size());
  }
  return fits;
}

std::vector<fs::path> files_of_fits(const Session& session, const std::vector<Fit>& fits) {
  std::vector<fs::path> files;
  for (const auto& fit : fits) {
    const std::vector<fs::path> own = session.files_of_stage("fit/" + fit.method);
    files.insert(files.end(), own.begin(), own.end());
  }
  return files;
}

std::vector<fs::path> files_of_filter(const Session& session) {
  return session.files_of_stage(std::string("fit/") + random_force_estimator().name);
}

bool filter_declined(Session& session) { return !fit_stage(session, {random_force_estimator().name}).front().usable(); }

void refuse_declined(Session& session) {
  const Fit fit = fit_stage(session, {random_force_estimator().name}).front();
  throw RunError(fit.method + " " + to_string(fit.status) + ", so there are no innovations to test: " + fit.message);
}

}  // namespace misfit
