#include "misfit/inference/short_record.h"

#include <limits>

#include "misfit/math/statistics.h"

namespace misfit {

void add_student_intervals(double degrees, Fit& fit) {
  constexpr double two_sided = 0.975;
  if (!(degrees >= 1.0)) return;
  const double t = student_quantile(two_sided, degrees);
  const auto add = [t](Estimate& e) {
    if (e.sigma > 0.0) e.interval = {e.value - t * e.sigma, e.value + t * e.sigma};
  };
  for (auto& [name, estimate] : fit.parameters) add(estimate);
  if (fit.trim) add(*fit.trim);
  if (const auto covariance = fit.facts.find("covariance"); covariance != fit.facts.end())
    covariance->second += "; 95 % intervals are by Student's t";
}

void withhold_sigmas(const std::string& why, Fit& fit) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto withhold = [](Estimate& e) {
    e.sigma = 0.0;
    e.interval.reset();
  };
  for (auto* estimates : {&fit.parameters, &fit.noise, &fit.force}) {
    for (auto& [name, estimate] : *estimates) withhold(estimate);
  }
  if (fit.trim) withhold(*fit.trim);
  for (auto& [name, sigma] : fit.plain_sigmas) sigma = 0.0;
  for (auto& curve : fit.curves) curve.sigma.assign(curve.sigma.size(), unknown);
  fit.covariance.setConstant(unknown);
  fit.warnings.push_back(why);
}

}  // namespace misfit
