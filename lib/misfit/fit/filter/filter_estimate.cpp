#include "misfit/fit/filter/filter_estimate.h"

#include <memory>

#include "misfit/fit/filter/filter_search.h"

namespace misfit {
namespace {

using Searches = std::vector<std::pair<double, std::unique_ptr<FilterSearch>>>;  ///< with their heights

/// A few rounds from each start; the highest first. Those from which the model cannot be run are left out.
Searches begin_all(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments, const FilterOptions& options) {
  constexpr int first_rounds = 6;
  Searches out;
  for (const FilterStart& start : starts) {
    auto search = std::make_unique<FilterSearch>(start, experiments, options);
    try {
      search->approach(first_rounds);
    } catch (const RunError&) {
      continue;
    }
    const double height = search->height();
    if (std::isfinite(height)) out.emplace_back(height, std::move(search));
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  return out;
}

/// False: the model cannot be run where it ended.
bool finished(FilterSearch& search) {
  try {
    search.finish();
    return true;
  } catch (const RunError&) {
    return false;
  }
}

FilterEstimate from_one(const FilterStart& start, const std::vector<Signals>& experiments, const FilterOptions& options) {
  FilterSearch search(start, experiments, options);
  search.approach(FilterSearch::all_rounds);
  search.finish();
  FilterEstimate out = search.take();
  if (!search.replaced().empty()) out.notes.push_back(search.replaced());
  return out;
}

/// Log density of measurements that count in `a` and not in `b`: what one has set aside as outliers must not decide which is higher.
double not_shared(const FilterEstimate& a, const FilterEstimate& b) {
  double sum = 0.0;
  for (std::size_t e = 0; e < a.data.size(); ++e) {
    for (std::size_t i = 0; i < a.data[e].use.size(); ++i) {
      if (a.data[e].use[i] == SampleRole::counted && b.data[e].use[i] != SampleRole::counted) sum += log_density(a.traces[e], i);
    }
  }
  return sum;
}

/// Worth going on beside the highest: neither clearly lower, nor as high and so at the same maximum.
bool may_end_higher(const Searches& searches, std::size_t k) {
  constexpr double clearly_lower = 10.0, same = 0.5;  // [log-likelihood]
  constexpr std::size_t most = 2;
  const double below = searches.front().first - searches[k].first;
  return k == 0 || (k < most && below <= clearly_lower && below >= same);
}

}  // namespace

std::vector<IntegrationPlan> plans_of(const FilterEstimate& estimate) {
  std::vector<IntegrationPlan> out;
  for (const auto& data : estimate.data) out.push_back(data.inputs.plan);
  return out;
}

FilterEstimate estimate_filter(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  if (starts.size() == 1) return from_one(starts.front(), experiments, options);
  const Searches searches = begin_all(starts, experiments, options);
  const bool all_replaced = std::all_of(searches.begin(), searches.end(), [](const auto& s) { return !s.second->replaced().empty(); });
  std::optional<FilterEstimate> best;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < searches.size(); ++k) {
    FilterSearch& search = *searches[k].second;
    if ((!may_end_higher(searches, k) && !(search.floor() > highest)) || !finished(search)) continue;
    const double height = search.height();
    FilterEstimate there = search.take();
    if (all_replaced) there.notes.push_back(search.replaced());
    if (best && height - not_shared(there, *best) <= highest - not_shared(*best, there)) continue;
    highest = height;
    best = std::move(there);
  }
  if (best) return std::move(*best);
  return from_one(starts.front(), experiments, options);
}

FilterEstimate estimate_filter(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  return estimate_filter({{start, std::move(penalties), {}}}, experiments, options);
}

}  // namespace misfit
