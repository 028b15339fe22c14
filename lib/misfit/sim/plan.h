#pragma once

#include <span>
#include <string>
#include <vector>

namespace misfit {

inline constexpr double kFinestTolerance = 1e-12;  ///< [share of a state's range]: below, rounding adds up to as much

/// One part of a sample interval, advanced in one step; it begins where the part before it ends.
struct StepPart {
  double to = 1.0;        ///< where it ends [share of the interval]
  bool implicit = false;  ///< by Radau IIA (radau.h) instead of Runge–Kutta
  [[nodiscard]] bool operator==(const StepPart&) const = default;
};

/// Into which parts the intervals between the samples of an experiment are divided, and the method of each part (planner.h makes it). It is
/// held while parameters move, so that the discrete map is a smooth function of them.
struct IntegrationPlan {
  std::vector<StepPart> parts;     ///< of all intervals, one after the other
  std::vector<std::size_t> first;  ///< of each interval, then their number; empty: there is no plan
  std::vector<double> rate;        ///< fastest rate at the start of each interval [1/s]
  double tolerance = 0.0;          ///< estimated error of a part, of the range of a state
  double error = 0.0;              ///< mean of what was estimated, the same way
  std::string lack;                ///< in words, where the tolerance is not reached; empty: nowhere

  /// Parts of interval i, between samples i and i + 1; none without a plan or after the last sample.
  [[nodiscard]] std::span<const StepPart> of(std::size_t i) const {
    if (i + 1 >= first.size()) return {};
    return std::span(parts).subspan(first[i], first[i + 1] - first[i]);
  }
  [[nodiscard]] double rate_at(std::size_t i) const { return i < rate.size() ? rate[i] : 0.0; }
};

/// The tolerance at which a plan errs by `ratio` of what the least accurate of these does, of a fit's experiments. A part that is divided
/// errs by a 32nd, so that those of a plan err by a sixth of its tolerance in the middle.
[[nodiscard]] double finer_tolerance(const std::vector<IntegrationPlan>& plans, double ratio);

/// The same with every part in two.
[[nodiscard]] IntegrationPlan refined(const IntegrationPlan& plan);

/// What the plans of a fit cost, in words: "fourth-order Runge-Kutta, 2 to 16 steps per sample interval, 2.4 on average"; `anew`: how often
/// they were made again at an estimate.
[[nodiscard]] std::string in_words(const std::vector<IntegrationPlan>& plans, int anew = 0);
/// What the error of the integration does to estimates: `shift` [sigma] with steps half as long, at so fine a tolerance.
[[nodiscard]] std::string in_words_of(double shift, double tolerance);

}  // namespace misfit
