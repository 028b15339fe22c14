#include <algorithm>
#include <filesystem>
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

}  // namespace

double largest_growth(const Rung& before, const Rung& after) {
  const double fitted = growth_of_errors(before.k_step, after.k_step);
  if (!before.validation_k_step || !after.validation_k_step) return fitted;
  return std::max(fitted, growth_of_errors(*before.validation_k_step, *after.validation_k_step));
}

void ModelLadder::compare_free_runs() {
  const std::string trajectory = trajectory_estimator().name;
  const auto& methods = root_.study.methods;
  if (ladder_.rungs.size() < 2 || std::find(methods.begin(), methods.end(), trajectory) == methods.end()) return;
  if (!std::filesystem::exists(root_.folder.file("fit/" + trajectory + "/fit.json"))) return;  // nobody has asked for it yet
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
