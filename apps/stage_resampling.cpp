// Block bootstrap and profile likelihood of [uncertainty].

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "apps/methods.h"
#include "apps/print.h"
#include "apps/stages.h"
#include "misfit/core/error.h"
#include "misfit/core/progress.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/fit/filter_error.h"
#include "misfit/fit/held.h"
#include "misfit/report/figures_intervals.h"
#include "misfit/uncertainty/bootstrap.h"
#include "misfit/uncertainty/profile.h"

namespace misfit {
namespace {

constexpr const char* stage = "resampling";

bool usable(const Fit& fit) { return fit.status == FitStatus::converged || fit.status == FitStatus::not_converged; }

/// A method's fit as replicas and profiles start from it.
struct Started {
  FittedMethod from;
  Fit fit;
  double objective = 0.0;  ///< penalised log-likelihood, where the method has one
};

Started started(Methods& methods, const std::string& method) {
  Started out;
  out.from.method = method;
  if (method == "equation_error") out.from.fitted = methods.regression();
  if (method == "output_error") out.from.fitted = methods.run_output_error();
  out.fit = out.from.fitted.fit;
  if (method != "filter_error") return out;
  const auto work = methods.run_filter_error();
  out.fit = work->fit;
  if (!work->estimate) return out;
  out.from.fitted.model = work->estimate->model;
  out.from.fitted.penalties = work->estimate->penalties;
  out.from.fitted.fit = work->fit;
  out.from.noise = work->estimate->noise;
  out.from.around = work->estimate->around;
  out.from.use.emplace();
  for (const auto& data : work->estimate->data) out.from.use->push_back(data.use);
  return out;
}

Bootstrap bootstrapped(const Session& session, const Started& s, const std::vector<Signals>& experiments) {
  const UncertaintyStudy& wishes = *session.study.uncertainty;
  BootstrapOptions options;
  options.runs = static_cast<std::size_t>(wishes.bootstrap);
  options.seed = static_cast<unsigned long long>(session.study.seed);
  options.block = static_cast<int>(wishes.block);
  const Resampled what = s.from.method == "output_error" ? Resampled::residuals : Resampled::rows;
  const BlockBootstrap bootstrap(
      s.fit, experiments, what, [&](const std::vector<Signals>& replica) { return fit_again(s.from, replica); }, options);
  Progress progress(fmt::format("bootstrap of {}, {} runs", s.from.method, wishes.bootstrap), session.options.quiet);
  Bootstrap out = block_bootstrap(
      bootstrap, session.options.threads, [&](std::size_t done, std::size_t total) { progress.update(done, total); }, &interrupted());
  return out;
}

ProfileRequest request_for(const Started& s, const std::vector<Signals>& experiments, const std::string& parameter) {
  HeldFit at_best(s.from, experiments, parameter);  // says what is wrong with the name
  const Estimate& e = s.fit.parameters.at(parameter);
  const Parameter& p = s.from.fitted.model.parameters[static_cast<std::size_t>(s.from.fitted.model.find_parameter(parameter))];
  const std::optional<double> objective = at_best(e.value);
  if (!objective) throw RunError("profile of " + parameter + ": " + s.from.method + " cannot be fitted again where it ended");
  const auto plain = s.fit.plain_sigmas.find(parameter);
  ProfileRequest r{s.from.method, parameter, e.unit, e.value, *objective, e.sigma, plain == s.fit.plain_sigmas.end() ? 0.0 : plain->second,
                   p.lower,       p.upper,   {}};
  r.from_best = [&s, &experiments, parameter] {
    auto held = std::make_shared<HeldFit>(s.from, experiments, parameter);
    return HeldMaximum([held](double value) { return (*held)(value); });
  };
  return r;
}

std::vector<LikelihoodProfile> profiled(const Session& session, const Started& s, const std::vector<Signals>& experiments) {
  std::vector<ProfileRequest> requests;
  for (const auto& parameter : session.study.uncertainty->profile) requests.push_back(request_for(s, experiments, parameter));
  Progress progress("profiles of " + s.from.method, session.options.quiet);
  return profile_likelihood(
      requests, session.options.threads, [&](std::size_t done, std::size_t total) { progress.update(done, total); }, &interrupted());
}

std::map<std::string, std::string> inputs_of(const Session& session) {
  const UncertaintyStudy& wishes = *session.study.uncertainty;
  std::map<std::string, std::string> inputs = inputs_of_fit(session, stage);
  inputs["methods"] = fmt::format("{}", fmt::join(session.methods(), " "));
  inputs["seed"] = std::to_string(session.study.seed);
  inputs["bootstrap"] = fmt::format("{} runs, block {}", wishes.bootstrap, wishes.block);
  inputs["profile"] = fmt::format("{}", fmt::join(wishes.profile, " "));
  return inputs;
}

}  // namespace

bool asks_for_resampling(const Study& study) {
  return study.uncertainty && (study.uncertainty->bootstrap > 0 || !study.uncertainty->profile.empty());
}

Resampling resampling_stage(Session& session) {
  const UncertaintyStudy& wishes = *session.study.uncertainty;
  const std::filesystem::path dir = session.folder.path();
  if (session.folder.up_to_date(stage, inputs_of(session)))
    return {wishes.bootstrap > 0 ? read_bootstrap(dir) : std::vector<Bootstrap>{},
            wishes.profile.empty() ? std::vector<LikelihoodProfile>{} : read_profiles(dir)};
  const auto begin = std::chrono::steady_clock::now();
  Resampling out;
  Methods methods(session);
  for (const auto& method : session.methods()) {
    if (method == "sliding_bin") continue;  // its bins are no model that could be run or held
    const Started s = started(methods, method);
    if (!usable(s.fit)) throw RunError(method + " " + to_string(s.fit.status) + ": " + s.fit.message);
    const std::vector<Signals>& experiments = methods.prepared().experiments;
    if (wishes.bootstrap > 0) out.bootstraps.push_back(bootstrapped(session, s, experiments));
    if (wishes.profile.empty() || method == "equation_error") continue;  // a regression has no likelihood of the motion
    for (auto& profile : profiled(session, s, experiments)) out.profiles.push_back(std::move(profile));
  }
  if (out.bootstraps.empty() && out.profiles.empty())
    throw RunError("none of the methods asked for can be resampled: equation_error, output_error and filter_error can");
  std::vector<std::string> outputs;
  if (wishes.bootstrap > 0) {
    write_bootstrap(dir, out.bootstraps);
    outputs = {"bootstrap.json", "bootstrap.csv"};
  }
  if (!wishes.profile.empty()) {
    write_profiles(dir, out.profiles);
    outputs.emplace_back("profile.json");
  }
  for (const auto& file : report::write_interval_figures(session.folder.file("figures"), out.bootstraps, out.profiles))
    outputs.push_back("figures/" + file);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  session.folder.record({stage, session.options.command, inputs_of(session), outputs, seconds, "", ""});
  return out;
}

std::string resampling_text(const Resampling& r) {
  std::string out;
  const auto shown = [](double value, const std::string& unit) { return convert(value, unit, display_unit(unit)); };
  for (const auto& b : r.bootstraps) {
    out += fmt::format("\nblock bootstrap of {}: {} runs of {}, blocks of {} samples{}\n", b.method, b.runs, b.how, b.block,
                       b.failed > 0 ? fmt::format(", {} gave no fit", b.failed) : "");
    for (const auto& n : b.numbers) {
      out += fmt::format("  {:<24} {:>12.6g} {:<6} sigma {:<10.3g} (fit: {:<10.3g}) 95 %: {:.6g} to {:.6g}\n", n.name,
                         shown(n.value, n.unit), display_unit(n.unit), shown(n.sigma, n.unit), shown(n.fit_sigma, n.unit),
                         shown(n.lower, n.unit), shown(n.upper, n.unit));
    }
  }
  for (const auto& p : r.profiles) {
    const auto end = [&](bool found, double value) { return found ? fmt::format("{:.6g}", shown(value, p.unit)) : std::string("?"); };
    out += fmt::format("\nprofile of {}, {}: {:.6g} {}, 95 %: {} to {} (fit ± 1.96 sigma: {:.6g} to {:.6g})\n", p.parameter, p.method,
                       shown(p.best, p.unit), display_unit(p.unit), end(p.lower_found, p.lower), end(p.upper_found, p.upper),
                       shown(p.best - 1.96 * p.sigma, p.unit), shown(p.best + 1.96 * p.sigma, p.unit));
    for (const auto& words : p.words) out += "  " + words + "\n";
  }
  return out;
}

}  // namespace misfit
