#include "misfit/calibrate/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

using Members = std::vector<bool>;  // one per candidate group: is it in the model?

SweepFit fit_with(const SelectionTask& task, const Members& in) {
  SweepModel model = task.base;
  for (std::size_t g = 0; g < in.size(); ++g) {
    if (in[g]) model.free.insert(model.free.end(), task.candidates[g].parameters.begin(), task.candidates[g].parameters.end());
  }
  std::sort(model.free.begin(), model.free.end());
  return fit_sweep(task.data, model);
}

// The test of freeing `group`: `without` and `with` are least-squares fits of nested models to the same data.
CameraTest compare(const CameraGroup& group, const SweepFit& without, const SweepFit& with, std::size_t candidates) {
  CameraTest test;
  test.name = group.name;
  for (const std::size_t p : group.parameters) {
    test.parameters.emplace_back(camera_parameter_names[p]);
    test.values.push_back(with.determined ? camera_entry(with.camera, p) : std::numeric_limits<double>::quiet_NaN());
    test.sigmas.push_back(with.sigma(p));
  }
  if (!with.determined || with.data <= with.free.size()) return test;
  const double tiny = std::numeric_limits<double>::min();
  const double gain = std::max(0.0, without.rss - with.rss);
  const auto freed = static_cast<double>(group.parameters.size());
  const auto left = static_cast<double>(with.data - with.free.size());
  test.drop = static_cast<double>(with.data) * std::log(std::max(tiny, without.rss) / std::max(tiny, std::min(without.rss, with.rss)));
  test.p_value = sidak(f_tail((gain / freed) / std::max(tiny, with.rss / left), freed, left), static_cast<double>(candidates));
  return test;
}

bool acceptable(const SelectionTask& task, const CameraTest& test, const SweepFit& with) {
  return test.p_value < task.threshold && with.determined && with.inside && with.converged;
}

// One round of forward selection: tests every group not yet selected against `selection.fit` and adds the best acceptable one. False if
// none is.
bool free_best(const SelectionTask& task, Members& in, Selection& selection) {
  std::size_t best = in.size();
  SweepFit best_fit;
  for (std::size_t g = 0; g < in.size(); ++g) {
    if (in[g]) continue;
    Members trial = in;
    trial[g] = true;
    const SweepFit with = fit_with(task, trial);
    selection.tests[g] = compare(task.candidates[g], selection.fit, with, in.size());
    if (!acceptable(task, selection.tests[g], with)) continue;
    if (best < in.size() && selection.tests[g].drop <= selection.tests[best].drop) continue;
    best = g;
    best_fit = with;
  }
  if (best == in.size()) return false;
  in[best] = true;
  selection.tests[best].selected = true;
  selection.fit = best_fit;
  return true;
}

// Drops what became unnecessary, the least significant first, and gives those that stay their final estimates.
void prune(const SelectionTask& task, Members& in, Selection& selection) {
  while (true) {
    std::size_t worst = in.size();
    double worst_p = task.threshold;
    SweepFit worst_fit;
    for (std::size_t g = 0; g < in.size(); ++g) {
      if (!in[g]) continue;
      Members trial = in;
      trial[g] = false;
      const SweepFit without = fit_with(task, trial);
      const CameraTest final_test = compare(task.candidates[g], without, selection.fit, in.size());
      selection.tests[g] = final_test;
      selection.tests[g].selected = true;
      if (final_test.p_value < worst_p) continue;
      worst = g;
      worst_p = final_test.p_value;
      worst_fit = without;
    }
    if (worst == in.size()) return;
    in[worst] = false;
    selection.tests[worst].selected = false;
    selection.fit = worst_fit;
  }
}

}  // namespace

Selection select_parameters(const SelectionTask& task) {
  Members in(task.candidates.size(), false);
  Selection selection{fit_with(task, in), std::vector<CameraTest>(task.candidates.size())};
  while (free_best(task, in, selection)) {
  }
  prune(task, in, selection);
  return selection;
}

}  // namespace misfit
