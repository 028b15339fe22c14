#include "misfit/fit/filter/filter_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "misfit/fit/filter/filter_search.h"
#include "misfit/fit/filter/free_approach.h"

namespace misfit {
namespace {

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

/// The searches for one maximum, from one start or several.
class StartedSearches {
 public:
  StartedSearches(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments, const FilterOptions& options)
      : starts_(starts), experiments_(experiments), options_(options) {}

  FilterEstimate run() {
    try {
      begin_freely();
      const auto others = std::count_if(starts_.begin(), starts_.end(), [](const FilterStart& start) { return !start.freely; });
      return others == 1 && !freely_ ? from_first() : from_all();
    } catch (const TimeLimitReached& spent) {
      const SuspendedTimeLimit writing_up;
      return best_when(spent);
    }
  }

 private:
  using Begun = std::pair<double, FilterSearch*>;  ///< height after the first rounds
  static constexpr int first_rounds = 6;

  void begin_freely() {
    const auto start = std::find_if(starts_.begin(), starts_.end(), [](const FilterStart& s) { return s.freely; });
    if (start == starts_.end()) return;
    FilterSearch& search = begin(*start);
    try {
      search.approach_freely(first_rounds);
      if (const double height = search.height(); std::isfinite(height)) freely_.emplace(height, &search);
    } catch (const RunError&) {  // the other starts remain
    }
  }

  FilterSearch& begin(const FilterStart& start) {
    searches_.push_back(std::make_unique<FilterSearch>(start, experiments_, options_));
    return *searches_.back();
  }

  FilterEstimate from_first() {
    FilterSearch& search = begin(starts_.front());
    search.approach(FilterSearch::all_rounds);
    search.finish();
    FilterEstimate out = search.take();
    if (!search.replaced().empty()) out.notes.push_back(search.replaced());
    return out;
  }

  FilterEstimate from_all() {
    const std::vector<Begun> begun = begin_all();
    const bool all_replaced = std::all_of(begun.begin(), begun.end(), [](const auto& s) { return !s.second->replaced().empty(); });
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < begun.size(); ++k) {
      FilterSearch& search = *begun[k].second;
      if ((!may_end_higher(begun, k) && !(search.floor() > highest)) || !finished(search)) continue;
      const double height = search.height();
      FilterEstimate there = search.take();
      if (all_replaced) there.notes.push_back(search.replaced());
      if (best_ && height - not_shared(there, *best_) <= highest - not_shared(*best_, there)) continue;
      highest = height;
      best_ = std::move(there);
    }
    if (best_) return std::move(*best_);
    return from_first();
  }

  /// A few rounds from each start; the highest first. Those from which the model cannot be run are left out; others are tried in their
  /// place unless the model runs from a contained fit, which is nearer to the maximum than what they begin with.
  std::vector<Begun> begin_all() {
    std::vector<Begun> out;
    bool contained_runs = false;
    for (const FilterStart& start : starts_) {
      if (start.freely) continue;
      FilterSearch& search = begin(start);
      try {
        search.approach(first_rounds, contained_runs ? FilterSearch::Unrunnable::refused : FilterSearch::Unrunnable::replaced);
      } catch (const RunError&) {
        continue;
      }
      const double height = search.height();
      if (!std::isfinite(height)) continue;
      out.emplace_back(height, &search);
      contained_runs = contained_runs || start.noise.has_value();
    }
    if (freely_) out.push_back(*freely_);
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    return out;
  }

  /// Worth going on beside the highest: neither clearly lower, nor as high and so at the same maximum.
  static bool may_end_higher(const std::vector<Begun>& begun, std::size_t k) {
    constexpr double clearly_lower = 10.0, same = 0.5;  // [log-likelihood]
    constexpr std::size_t most = 2;
    const double below = begun.front().first - begun[k].first;
    return k == 0 || (k < most && below <= clearly_lower && below >= same);
  }

  /// False: the model cannot be run where it ended.
  static bool finished(FilterSearch& search) {
    try {
      search.finish();
      return true;
    } catch (const RunError&) {
      return false;
    }
  }

  /// The end of a search that was finished, else the best point that any has come to.
  FilterEstimate best_when(const TimeLimitReached& spent) {
    if (best_) {
      best_->notes.push_back(std::string("a search from another start was not finished: ") + spent.what());
      return std::move(*best_);
    }
    std::stable_sort(searches_.begin(), searches_.end(), [](const auto& a, const auto& b) { return a->reached() > b->reached(); });
    for (const auto& search : searches_) {
      if (search->cut_off(spent)) return search->take();
    }
    throw TimeLimitReached(in_words(spent));
  }

  const std::vector<FilterStart>& starts_;
  const std::vector<Signals>& experiments_;
  const FilterOptions& options_;
  std::vector<std::unique_ptr<FilterSearch>> searches_;
  std::optional<Begun> freely_;
  std::optional<FilterEstimate> best_;
};

}  // namespace

std::vector<IntegrationPlan> plans_of(const FilterEstimate& estimate) {
  std::vector<IntegrationPlan> out;
  for (const auto& data : estimate.data) out.push_back(data.inputs.plan);
  return out;
}

FilterEstimate estimate_filter(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  try {
    return StartedSearches(starts, experiments, options).run();
  } catch (const DivergesWhereHeldOut&) {
    FilterOptions whole = options;
    whole.whole_runs = true;
    return StartedSearches(starts, experiments, whole).run();
  }
}

FilterEstimate estimate_filter(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  return estimate_filter({{start, std::move(penalties), {}}}, experiments, options);
}

FilterEstimate estimate_freely(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                               const FilterOptions& options) {
  LikelihoodAscent at(start, std::move(penalties), experiments, options);
  settle_freely(at);
  if (!at.linearise_whole()) throw RunError(at.failure());
  FilterEstimate out = std::move(at.out);
  out.model.set_theta(at.theta);
  const std::vector<double> all = out.forced.model.values_at(at.theta);
  for (std::size_t i = 0; i < all.size(); ++i) out.forced.model.parameters[i].value = all[i];
  out.objective = at.objective;
  return out;
}

bool follows_freely(const Model& model, const std::vector<Signals>& experiments) {
  LikelihoodAscent at(model, curve_penalties(model), experiments, {});
  return follows_freely(at);
}

}  // namespace misfit
