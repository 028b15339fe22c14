#include "misfit/sim/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"

namespace misfit {

double finer_tolerance(const std::vector<IntegrationPlan>& plans, double ratio) {
  constexpr double middle = 6.0;
  double error = 0.0, tolerance = 1.0;
  for (const IntegrationPlan& plan : plans) {
    error = std::max(error, plan.error);
    tolerance = std::min(tolerance, plan.tolerance);
  }
  return std::max(std::min(middle * ratio * error, 0.5 * tolerance), kFinestTolerance);
}

IntegrationPlan refined(const IntegrationPlan& plan) {
  IntegrationPlan out = plan;
  out.parts.clear();
  out.first.clear();
  for (std::size_t i = 0; i + 1 < plan.first.size(); ++i) {
    out.first.push_back(out.parts.size());
    double from = 0.0;
    for (const StepPart& part : plan.of(i)) {
      out.parts.push_back({0.5 * (from + part.to), part.implicit});
      out.parts.push_back(part);
      from = part.to;
    }
  }
  if (!plan.first.empty()) out.first.push_back(out.parts.size());
  return out;
}

std::string in_words(const std::vector<IntegrationPlan>& plans, int anew) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max(), most = 0, parts = 0, intervals = 0, implicit = 0;
  for (const IntegrationPlan& plan : plans) {
    for (std::size_t i = 0; i + 1 < plan.first.size(); ++i) {
      const std::span<const StepPart> of = plan.of(i);
      fewest = std::min(fewest, of.size());
      most = std::max(most, of.size());
      for (const StepPart& part : of) implicit += part.implicit ? 1U : 0U;
      parts += of.size();
      ++intervals;
    }
  }
  if (intervals == 0) return "fourth-order Runge-Kutta";
  const auto per = [](std::size_t count, std::size_t all, double digits) {
    return format_value(std::round(digits * static_cast<double>(count) / static_cast<double>(all)) / digits);
  };
  std::string text = "fourth-order Runge-Kutta, ";
  if (implicit > 0) text = "Radau IIA in " + per(100 * implicit, parts, 10.0) + " % of the steps, Runge-Kutta in the others, ";
  text += fewest == most ? std::to_string(most) + (most == 1 ? " step" : " steps") + " per sample interval"
                         : std::to_string(fewest) + " to " + std::to_string(most) + " steps per sample interval, " +
                               per(parts, intervals, 100.0) + " on average";
  if (anew > 0) text += "; planned anew at the estimate, " + std::to_string(anew) + (anew == 1 ? " time" : " times");
  return text;
}

std::string in_words_of(double shift, double tolerance) {
  constexpr double enough = 0.1;
  if (shift > enough && tolerance <= kFinestTolerance)
    return "; its steps err by 1e-12 of the states' ranges, which is as fine as they can be: the data are more exact";
  constexpr double least = 1e-3;
  return "; with steps half as long no estimate would move by more than " + format_value(std::max(std::round(shift / least), 1.0) * least) +
         " sigma";
}

}  // namespace misfit
