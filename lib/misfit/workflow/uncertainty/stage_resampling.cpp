// Block bootstrap, profile likelihood and random starts of [uncertainty].

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/profile_objective.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/ranks.h"
#include "misfit/report/figures_intervals.h"
#include "misfit/uncertainty/bootstrap.h"
#include "misfit/uncertainty/multi_start.h"
#include "misfit/uncertainty/profile.h"
#include "misfit/workflow/estimate/methods.h"
#include "misfit/workflow/uncertainty/uncertainty.h"

namespace misfit {
namespace {

constexpr const char* stage = "resampling";

StageInputs inputs_of(const Session& session) {
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  StageInputs inputs = inputs_of_fit(session, stage);
  inputs["methods"] = fmt::format("{}", fmt::join(session.methods(), " "));
  inputs["seed"] = std::to_string(session.study.seed);
  inputs["bootstrap"] = fmt::format("{} runs, block {}", uncertainty.bootstrap, uncertainty.block);
  inputs["starts"] = std::to_string(uncertainty.starts);
  inputs["profile"] = fmt::format("{}", fmt::join(uncertainty.profile, " "));
  return inputs;
}

/// One method after the other. The first rank alone summarises; whatever happens there, all ranks come to the same stored jobs, or the
/// program ends.
class ResamplingJob {
 public:
  explicit ResamplingJob(Session& session) : session_(session), uncertainty_(*session.study.uncertainty), methods_(session) {}

  Resampling run() {
    for (const std::string& method : session_.methods()) {
      if (estimator(method).info.regression_form) {
        note(method, "it has no parametric model to resample or profile");
        continue;
      }
      resample(method);
    }
    if (ranks().first() && out_.bootstraps.empty() && out_.profiles.empty() && out_.starts.empty())
      throw RunError(fmt::format("no method asked for could be resampled: {}", fmt::join(out_.notes, "; ")));
    return std::move(out_);
  }

 private:
  void note(const std::string& method, const std::string& why) { out_.notes.push_back(method + " is not resampled: " + why); }

  /// What is wrong with this method alone is a note; what is wrong with the machine is thrown.
  bool attempt(const std::string& method, const std::function<void()>& action) {
    try {
      action();
      return true;
    } catch (const MachineError&) {
      throw;
    } catch (const RunError& error) {
      note(method, error.what());
    }
    return false;
  }

  void resample(const std::string& method) {
    FittedMethod from;
    const Fit& fit = from.fitted.fit;
    const bool fitted = attempt(method, [&] {
      from = methods_.run(method).at;
      if (!fit.usable()) throw RunError(to_string(fit.status) + ": " + fit.message);
    });
    if (!fitted) return;
    if (fit.status == FitStatus::not_converged)
      out_.notes.push_back(method + " has not converged (" + fit.message + "): resampling starts from its last iterate");
    if (uncertainty_.bootstrap > 0) add_bootstrap(from);
    if (!uncertainty_.profile.empty() && has_likelihood(method)) add_profiles(from);
    if (uncertainty_.starts > 0 && has_likelihood(method)) add_starts(from);
  }

  /// `settings`: what of [uncertainty] a job's result depends on. Other methods do not matter to it, nor how many runs there are.
  [[nodiscard]] StoredJobs jobs(const std::string& what, const std::string& method, const std::string& settings,
                                std::size_t count = 0) const {
    StageInputs inputs = inputs_of_jobs(session_, stage, {"uncertainty"});
    inputs["methods"] = method;
    inputs["settings"] = settings;
    return {session_.folder.file(what + "_" + method), digest_of(inputs), count, session_.options.threads};
  }

  void add_bootstrap(const FittedMethod& from) {
    BootstrapOptions options;
    options.runs = uncertainty_.bootstrap;
    options.seed = session_.study.seed;
    options.block = {static_cast<int>(uncertainty_.block), from.fitted.equation_residuals};
    const EstimatorInfo& info = estimator(from.method).info;
    const Resampled what = info.has_likelihood && info.deterministic ? Resampled::residuals : Resampled::rows;
    const FitReplica refit = [&](const std::vector<Signals>& replica) { return fit_again(from, replica); };
    std::optional<BlockBootstrap> bootstrap;
    if (!attempt(from.method, [&] { bootstrap.emplace(from.fitted.fit, methods_.prepared().experiments, what, refit, options); })) return;
    const ProgressFn progress = session_.progress(fmt::format("bootstrap of {}, {} runs", from.method, uncertainty_.bootstrap));
    const auto results = finished(stored_runs([&](std::size_t k) { return bootstrap->run(k); },
                                              jobs("bootstrap", from.method, fmt::format("block {}", uncertainty_.block), options.runs),
                                              progress, &interrupted()));
    if (ranks().first()) attempt(from.method, [&] { out_.bootstraps.push_back(bootstrap->summary(results)); });
  }

  void add_profiles(const FittedMethod& from) {
    std::vector<ProfileRequest> requests;
    for (const std::string& parameter : uncertainty_.profile)
      attempt(from.method, [&] { requests.push_back(request_for(from, parameter)); });
    if (requests.empty()) return;
    const ProgressFn progress = session_.progress("profiles of " + from.method);
    for (auto& profile : finished(stored_profiles(
             requests, jobs("profile", from.method, fmt::format("{}", fmt::join(uncertainty_.profile, " "))), progress, &interrupted())))
      out_.profiles.push_back(std::move(profile));
  }

  void add_starts(const FittedMethod& from) {
    MultiStartOptions options;
    options.runs = uncertainty_.starts;
    options.seed = session_.study.seed;
    const std::vector<Signals>& experiments = methods_.prepared().experiments;
    const SearchFrom search = [&](const RandomStart& start) {
      const Maximisation end = maximise_from(from, {start.values, start.noise_factors}, experiments);
      return Maximum{end.objective, end.why, end.at.fitted.model.values()};
    };
    std::optional<MultiStarts> starts;
    const bool possible = attempt(from.method, [&] {
      const Maximisation best = maximise_near(from, experiments);
      if (!best.objective) throw RunError("starts: the refit at the estimate failed: " + best.why);
      starts.emplace(FoundMaximum{from.fitted.fit, from.fitted.model, *best.objective}, search, options);
    });
    if (!possible) return;
    const ProgressFn progress = session_.progress(fmt::format("{} random starts of {}", uncertainty_.starts, from.method));
    const auto results = finished(stored_runs([&](std::size_t k) { return starts->run(k); },
                                              jobs("starts", from.method, "from the model's typical sizes, noise too", options.runs),
                                              progress, &interrupted()));
    if (ranks().first()) attempt(from.method, [&] { out_.starts.push_back(starts->summary(results)); });
  }

  ProfileRequest request_for(const FittedMethod& from, const std::string& parameter) {
    const std::vector<Signals>& experiments = methods_.prepared().experiments;
    const auto found = std::find(from.fitted.fit.names.begin(), from.fitted.fit.names.end(), parameter);
    if (found == from.fitted.fit.names.end()) throw RunError("profile of " + parameter + ": it is not free in this fit");
    ProfileObjective at_best(from, experiments, parameter);
    const Estimate& e = from.fitted.fit.parameters.at(parameter);
    const Parameter& p = from.fitted.model.parameters[from.fitted.model.find_parameter(parameter)];
    const std::optional<double> objective = at_best(e.value);
    if (!objective) throw RunError("profile of " + parameter + ": the refit at the estimate failed");
    if (!(e.sigma > 0.0)) throw RunError("profile of " + parameter + ": the fit gives no sigma, hence no step size");
    const auto plain = from.fitted.fit.plain_sigmas.find(parameter);
    ProfileRequest r{
        from.method, parameter, e.unit, e.value, *objective, e.sigma, plain == from.fitted.fit.plain_sigmas.end() ? 0.0 : plain->second,
        p.lower,     p.upper,   {}};
    r.from_best = [&from, &experiments, parameter] {
      auto held = std::make_shared<ProfileObjective>(from, experiments, parameter);
      return MaximumAtFixedValue([held](double value) { return (*held)(value); });
    };
    return r;
  }

  Session& session_;
  const UncertaintyStudy& uncertainty_;
  Methods methods_;
  Resampling out_;
};

void write(const Session& session, const std::filesystem::path& dir, const Resampling& r) {
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  write_resampling_notes(dir, r.notes);
  if (uncertainty.bootstrap > 0) write_bootstrap(dir, r.bootstraps);
  if (!uncertainty.profile.empty()) write_profiles(dir, r.profiles);
  if (uncertainty.starts > 0) write_multi_starts(dir, r.starts);
  report::write_interval_figures(dir / "figures", r);
}

Resampling read(const Session& session) {
  const std::filesystem::path dir = session.folder.path();
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  return {uncertainty.bootstrap > 0 ? read_bootstrap(dir) : std::vector<Bootstrap>{},
          uncertainty.profile.empty() ? std::vector<LikelihoodProfile>{} : read_profiles(dir), read_resampling_notes(dir),
          uncertainty.starts > 0 ? read_multi_starts(dir) : std::vector<MultiStart>{}};
}

}  // namespace

bool asks_for_resampling(const Study& study) {
  if (!study.uncertainty) return false;
  const UncertaintyStudy& uncertainty = *study.uncertainty;
  return uncertainty.bootstrap > 0 || !uncertainty.profile.empty() || uncertainty.starts > 0;
}

void check_profile_names(Session& session) {
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  if (uncertainty.profile.empty()) return;
  const std::vector<std::string> asked = session.methods();
  if (std::none_of(asked.begin(), asked.end(), has_likelihood)) {
    throw InputError(uncertainty.where_profile, fmt::format("profile: {} has no likelihood of the motion; {} have", fmt::join(asked, ", "),
                                                            estimators_with_likelihood()));
  }
  const Model model = prepare(session).model;
  for (const std::string& name : uncertainty.profile) {
    if (const std::string why = why_no_profile(model, name); !why.empty())
      throw InputError(uncertainty.where_profile, "profile: '" + name + "' " + why);
  }
}

Resampling resampling_stage(Session& session) {
  if (!ranks().first()) {
    if (!session.folder.up_to_date(stage, inputs_of(session))) ResamplingJob(session).run();
    return {};
  }
  session.do_stage(stage, inputs_of(session), {"resampling.json"},
                   [&](const std::filesystem::path& dir) { write(session, dir, ResamplingJob(session).run()); });
  return read(session);
}

std::optional<Resampling> known_resampling(const Session& session) {
  const auto record = session.folder.stages().find(stage);
  if (!asks_for_resampling(session.study) || record == session.folder.stages().end()) return std::nullopt;
  StageInputs now = inputs_of(session);
  // By whatever methods were asked for.
  const auto& before = record->second.inputs;
  for (const char* key : {"methods", "seed"}) {
    if (before.contains(key)) now[key] = before.at(key);
  }
  if (!session.folder.up_to_date(stage, now)) return std::nullopt;
  return read(session);
}

}  // namespace misfit
