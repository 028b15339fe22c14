#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "misfit/data/estimators.h"
#include "misfit/fit/filter/k_step.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

/// In every experiment and channel it leaves less than half of the motion's own size.
bool follows_the_motion(const Fit& fit) {
  constexpr double most = 0.5;
  return fit.usable() && std::all_of(fit.predictions.begin(), fit.predictions.end(),
                                     [](const ChannelPrediction& p) { return !p.nrmse || *p.nrmse < most; });
}

/// By output_error, if it is among the methods of the study: what was fitted before must not matter.
bool asks_for_free_runs(const Session& session) {
  const std::vector<std::string>& methods = session.study.methods;
  return std::find(methods.begin(), methods.end(), trajectory_estimator().name) != methods.end();
}

/// RMS over the channels of (after/before); 1 where nothing can be compared.
double growth_of_rms(const std::map<std::string, Estimate>& before, const std::map<std::string, Estimate>& after) {
  const auto alone = [](const std::map<std::string, Estimate>& errors) {
    std::map<std::string, std::vector<double>> out;
    for (const auto& [channel, error] : errors) out[channel] = {error.value};
    return out;
  };
  return growth_of_errors(alone(before), alone(after));
}

}  // namespace

double largest_growth(const Rung& before, const Rung& after) {
  const double fitted = growth_of_errors(before.k_step, after.k_step);
  if (!before.validation_k_step || !after.validation_k_step) return fitted;
  return std::max(fitted, growth_of_errors(*before.validation_k_step, *after.validation_k_step));
}

std::optional<ModelLadder::FreeRuns> ModelLadder::free_runs_of_last() {
  if (ladder_.rungs.size() < 2 || !asks_for_free_runs(root_)) return std::nullopt;
  const std::string trajectory = trajectory_estimator().name;
  const Rung& rung = ladder_.rungs.back();
  const Rung& parent = *std::find_if(ladder_.rungs.begin(), ladder_.rungs.end(), [&](const Rung& r) { return r.id == rung.parent; });
  std::unique_ptr<Session> below;
  if (parent.parent >= 0) below = std::make_unique<Session>(options_for(options_, root_.folder.file(parent.study)), registry_);
  Fit before = fit_stage(below ? *below : root_, {trajectory}).front();
  if (!follows_the_motion(before)) return std::nullopt;
  return FreeRuns{std::move(before), fit_stage(last(), {trajectory}).front()};
}

std::string ModelLadder::why_free_run_is_worse() {
  const std::optional<FreeRuns> runs = free_runs_of_last();
  if (!runs) return "";
  const auto& [before, after] = *runs;
  if (!after.usable())
    return "the free run, which followed the motion without it, no longer does: " + after.message.substr(0, after.message.find(": "));
  constexpr double hardly = 1.03, hardly_held_out = 1.05;  // as of predictions (why_not_kept)
  if (const double growth = growth_of_rms(before.rms, after.rms); growth > hardly)
    return fmt::format("the errors of the free run grow by {:.0f} %", 100.0 * (growth - 1.0));
  const double growth = growth_of_rms(before.validation_rms, after.validation_rms);
  return growth > hardly_held_out ? fmt::format("of what is held out, the errors of the free run grow by {:.0f} %", 100.0 * (growth - 1.0))
                                  : "";
}

std::string ModelLadder::why_free_run_is_better() {
  const std::optional<FreeRuns> runs = free_runs_of_last();
  if (!runs || !runs->after.usable() || runs->after.validation_rms.empty()) return "";
  constexpr double clearly = 0.9;
  const double fitted = growth_of_rms(runs->before.rms, runs->after.rms),
               held_out = growth_of_rms(runs->before.validation_rms, runs->after.validation_rms);
  if (fitted > clearly || held_out > clearly) return "";
  return fmt::format("the errors of the free run fall by {:.0f} %, of what is held out by {:.0f} %", 100.0 * (1.0 - fitted),
                     100.0 * (1.0 - held_out));
}

void ModelLadder::stays_for_free_run(const std::string& why) {
  ladder_.rungs.back().stays_for_free_run = why;
  store();
}

void ModelLadder::compare_free_runs() {
  const std::string trajectory = trajectory_estimator().name;
  if (ladder_.rungs.size() < 2 || !asks_for_free_runs(root_)) return;
  const Fit before = fit_stage(root_, {trajectory}).front();
  if (!follows_the_motion(before)) return;
  const Fit after = fit_stage(last(), {trajectory}).front();
  if (!after.usable()) return root_.note("the free run of the last rung is not known: " + after.message);
  const auto keep = [](const Fit& fit, Rung& rung) {
    rung.free_rms = fit.rms;
    if (!fit.validation_rms.empty()) rung.validation_free_rms = fit.validation_rms;
  };
  keep(before, ladder_.rungs.front());
  keep(after, ladder_.rungs.back());
  store();
}

}  // namespace misfit
