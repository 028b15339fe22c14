#include <fmt/format.h>

#include <tuple>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/estimators.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/ranks.h"
#include "misfit/report/figures_uncertainty.h"
#include "misfit/workflow/uncertainty/study_chain.h"
#include "misfit/workflow/uncertainty/uncertainty.h"

namespace misfit {
namespace {

constexpr const char* stage = "uncertainty";

const UncertaintyStudy& uncertainty_study(const Session& session) {
  if (!session.study.uncertainty)
    throw InputError({session.study.file.string(), 0, 0},
                     "the section [uncertainty] is missing: it lists what is uncertain, as perturb = { R = \"0.1524 m\" }");
  return *session.study.uncertainty;
}

std::size_t runs_of(const Session& session) { return session.options.runs > 0 ? session.options.runs : session.study.uncertainty->runs; }

/// All that a run depends on but its number: not how many there are, what else is asked for, or what the study is called.
StageInputs inputs_of_run(const Session& session) {
  StageInputs inputs = inputs_of_jobs(
      session, stage, {"uncertainty.runs", "uncertainty.bootstrap", "uncertainty.block", "uncertainty.profile", "uncertainty.starts"});
  inputs["methods"] = fmt::format("{}", fmt::join(session.methods(), " "));
  return inputs;
}

StageInputs inputs_of(const Session& session) {
  StageInputs inputs = inputs_of_run(session);
  inputs["runs"] = std::to_string(runs_of(session));
  return inputs;
}

std::optional<MonteCarloResult> sampled(const Session& session, const StudyChain& chain, const Sampler& sampler) {
  MonteCarloOptions options;
  options.jobs = {session.folder.file("uncertainty"), digest_of(inputs_of_run(session)), runs_of(session), session.options.threads};
  options.shared = chain.numbers().scalars();
  options.progress = session.progress(fmt::format("{}, {} runs", chain.nominal().method, runs_of(session)));
  options.stop = &interrupted();
  return monte_carlo(
      sampler, [&](const std::vector<double>& errors) { return chain.run(errors); }, options);
}

std::vector<std::string> notes_of(const Session& session, const StudyChain& chain, const MonteCarloResult& runs,
                                  const Uncertainty& result) {
  std::vector<std::string> notes = chain.rig().notes();
  notes.emplace_back("The bands contain the propagated uncertainty only; the nominal fit's sigma contains the measurement noise.");
  for (const std::string& note : unfinished_notes(chain.nominal(), runs)) notes.push_back(note);
  if (result.failed > 0) notes.push_back(fmt::format("{} of {} runs gave no result and are left out.", result.failed, result.runs));
  for (const SpreadNumber& n : result.numbers) {
    if (n.count + result.failed < result.runs)
      notes.push_back(fmt::format("{} exists in {} of {} runs only.", n.name, n.count, result.runs));
  }
  for (const SpreadCurve& c : result.curves) {
    if (!c.informative) notes.push_back(fmt::format("{} is not informative: {}.", c.name, c.why));
  }
  const std::string& method = chain.nominal().method;
  if (session.study.experiments.size() > 1 && find_estimator(method)->regression_form)
    notes.push_back(method + " uses the first experiment only.");
  return notes;
}

Uncertainty result_of(const Session& session, const StudyChain& chain, const Sampler& sampler, const MonteCarloResult& runs) {
  Uncertainty out;
  out.method = chain.nominal().method;
  out.runs = runs.runs;
  out.failed = runs.failed;
  out.failures = runs.failures;
  out.seed = session.study.seed;
  out.perturbed = chain.rig().described();
  chain.numbers().fill(runs, sampler.term_names(), out);
  out.notes = notes_of(session, chain, runs, out);
  return out;
}

}  // namespace

StageInputs inputs_of_jobs(const Session& session, const std::string& what, std::vector<std::string> more) {
  for (const char* key : {"study.name", "study.question", "study.methods", "reference"}) more.emplace_back(key);
  StageInputs inputs = inputs_of_fit(session, what, more);
  inputs["seed"] = std::to_string(session.study.seed);
  return inputs;
}

Uncertainty uncertainty_stage(Session& session) {
  uncertainty_study(session);
  attitude_stage(session);
  if (session.folder.up_to_date(stage, inputs_of(session))) return read_uncertainty(session.folder.path());
  const std::unique_ptr<StudyChain> chain = chain_of(session);
  const Sampler sampler(chain->rig().perturbations(), session.study.seed);
  if (!ranks().first()) {
    std::ignore = finished(sampled(session, *chain, sampler));
    return {};
  }
  session.do_stage(stage, inputs_of(session), {"uncertainty.json"}, [&](const std::filesystem::path& dir) {
    const Uncertainty result = result_of(session, *chain, sampler, finished(sampled(session, *chain, sampler)));
    write_uncertainty(dir, result);
    report::write_uncertainty_figures(dir / "figures", result, references(session));
  });
  return read_uncertainty(session.folder.path());
}

std::optional<Uncertainty> known_uncertainty(const Session& session) {
  const auto record = session.folder.stages().find(stage);
  if (!session.study.uncertainty || record == session.folder.stages().end()) return std::nullopt;
  StageInputs now = inputs_of(session);
  // However many runs it was, and by whatever method was asked for.
  const auto& before = record->second.inputs;
  for (const char* key : {"runs", "methods", "seed"}) {
    if (before.contains(key)) now[key] = before.at(key);
  }
  if (!session.folder.up_to_date(stage, now)) return std::nullopt;
  return read_uncertainty(session.folder.path());
}

}  // namespace misfit
