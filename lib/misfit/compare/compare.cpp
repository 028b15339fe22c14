#include "misfit/compare/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "misfit/compare/curve_difference.h"
#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/data/estimators.h"

namespace misfit {
namespace {

bool alike(const CurveEstimate& a, const CurveEstimate& b) {
  return a.name == b.name && a.of == b.of && a.of_unit == b.of_unit && a.unit == b.unit;
}

bool alike(const CurveEstimate& a, const Reference& b) {
  return a.name == b.curve && a.of == b.of && a.of_unit == b.of_unit && a.unit == b.unit;
}

MethodSummary summary(const Fit& fit) {
  MethodSummary m{fit.method,         fit.status, fit.message,           fit.driven, fit.trim, {}, {}, fit.rms,
                  fit.validation_rms, fit.loglik, fit.validation_loglik, {}};
  for (const auto& [name, estimate] : fit.parameters) {
    if (fit.usable() && !is_curve_coefficient(name)) m.parameters[name] = estimate;
  }
  for (const CurveEstimate& curve : fit.curves) {
    if (!fit.usable() || !fit.trim || !curve.informative || curve.of_unit != fit.trim->unit) continue;
    if (curve.trimmed) {  // its slope there is the static stability
      if (const auto slope = slope_at(curve, fit.trim->value)) m.slopes[curve.name] = *slope;
    } else if (const auto point = visited_point(curve, fit.trim->value)) {
      m.at_trim[curve.name] = {point->value, point->sigma, curve.unit};
    }
  }
  return m;
}

void list_left_out(const Fit& fit, Comparison& c) {
  if (!fit.usable()) {
    c.not_compared.push_back({fit.method, to_string(fit.status) + (fit.message.empty() ? "" : ": " + fit.message)});
    return;
  }
  for (const CurveEstimate& curve : fit.curves) {
    if (!curve.informative)
      c.not_compared.push_back({fit.method + " " + curve.name, "not informative" + (curve.why.empty() ? "" : ": " + curve.why)});
  }
}

struct Sides {
  std::string a, b;
  bool reference = false;
};

void add_difference(const CurveEstimate& curve, const std::vector<CurveValue>& points, const Sides& sides, Comparison& c) {
  std::optional<CurveDifference> d = difference(curve, points);
  if (!d) {
    c.not_compared.push_back(
        {fmt::format("{} of {} and {}", curve.name, sides.a, sides.b), "no common operating range with uncertainties"});
    return;
  }
  d->a = sides.a;
  d->b = sides.b;
  d->reference = sides.reference;
  c.curves.push_back(std::move(*d));
}

void compare_pair(const Fit& a, const Fit& b, Comparison& c) {
  for (const CurveEstimate& curve : a.curves) {
    for (const CurveEstimate& other : b.curves) {
      if (curve.informative && other.informative && alike(curve, other)) {
        add_difference(curve, visited_points(other), {a.method, b.method}, c);
      }
    }
  }
}

void compare_reference(const Fit& fit, const Reference& reference, Comparison& c) {
  std::vector<CurveValue> points;
  for (std::size_t i = 0; i < reference.x.size(); ++i) points.push_back({reference.x[i], reference.value[i], reference.sigma[i]});
  for (const CurveEstimate& curve : fit.curves) {
    if (curve.informative && alike(curve, reference)) add_difference(curve, points, {fit.method, reference.name, true}, c);
  }
}

std::string sentence(const std::string& what, const Sides& sides, const Estimate& difference, double sigmas) {
  const std::string size = in_display_unit(std::abs(difference.value), difference.unit, difference.sigma);
  const std::string where = difference.value < 0.0 ? "below" : "above";
  const std::string significance = std::isfinite(sigmas) ? fmt::format(" ({:.1f} sigma)", sigmas) : " (no uncertainty known)";
  return fmt::format("{} of {} is {} {} that of {}{}", what, sides.a, size, where, sides.b, significance);
}

void add_trims(const Estimate& a, const Estimate& b, const Sides& sides, Comparison& c) {
  if (a.unit != b.unit) return;
  const double sigma = std::hypot(a.sigma, b.sigma);
  const double gap = a.value - b.value;
  const double sigmas = sigma > 0.0 ? std::abs(gap) / sigma : std::numeric_limits<double>::quiet_NaN();
  const Estimate difference{gap, sigma, a.unit};
  c.trims.push_back({.a = sides.a,
                     .b = sides.b,
                     .reference = sides.reference,
                     .difference = difference,
                     .sigmas = sigmas,
                     .sentence = sentence("the trim", sides, difference, sigmas)});
}

bool differentiates(const std::string& method) {
  const EstimatorInfo* info = find_estimator(method);
  return info != nullptr && !info->has_likelihood;
}

/// What a trajectory without a random force and one with it can each get wrong where they differ.
bool differ_in_the_random_force(const std::string& a, const std::string& b) {
  const EstimatorInfo *one = find_estimator(a), *other = find_estimator(b);
  return one != nullptr && other != nullptr && one->has_likelihood && other->has_likelihood && one->deterministic != other->deterministic;
}

/// A regression takes the noise of its differentiated measurements, and what a local polynomial smooths away, into its parameters: its
/// sigmas know nothing of that. Nor does that of a model with a random force know what the force has taken over, or that of a model without
/// one what an unmodelled force has done to it.
void add_parameters(const Fit& a, const Fit& b, Comparison& c) {
  for (const auto& [name, one] : a.parameters) {
    const auto other = b.parameters.find(name);
    if (is_curve_coefficient(name) || other == b.parameters.end() || other->second.unit != one.unit) continue;
    const Estimate difference{one.value - other->second.value, std::hypot(one.sigma, other->second.sigma), one.unit};
    if (!(difference.sigma > 0.0)) continue;
    ParameterDifference d{.parameter = name,
                          .a = a.method,
                          .b = b.method,
                          .difference = difference,
                          .sigmas = std::abs(difference.value) / difference.sigma,
                          .sentence = ""};
    constexpr double min_sigmas = 3.0;
    if (d.sigmas > min_sigmas) {
      d.sentence = sentence(name, {a.method, b.method}, difference, d.sigmas) + ": they cannot both be right";
      for (const Fit* fit : {&a, &b}) {
        if (differentiates(fit->method))
          d.sentence += "; " + fit->method + " is biased by numerical differentiation, which its sigma does not cover";
      }
      if (differ_in_the_random_force(a.method, b.method)) {
        d.sentence +=
            fmt::format("; either the random force of {} has taken over part of a slow effect, or a force that the model lacks biases {}",
                        random_force_estimator().name, trajectory_estimator().name);
      }
    }
    c.parameters.push_back(std::move(d));
  }
}

}  // namespace

Comparison compare(const std::vector<Fit>& fits, const std::vector<Reference>& references) {
  Comparison c;
  for (const Reference& reference : references) {
    if (reference.trim) c.reference_trims[reference.name] = *reference.trim;
  }
  for (std::size_t i = 0; i < fits.size(); ++i) {
    c.methods.push_back(summary(fits[i]));
    list_left_out(fits[i], c);
    if (!fits[i].usable()) continue;
    for (std::size_t j = i + 1; j < fits.size(); ++j) {
      if (!fits[j].usable()) continue;
      compare_pair(fits[i], fits[j], c);
      add_parameters(fits[i], fits[j], c);
      if (fits[i].trim && fits[j].trim) add_trims(*fits[i].trim, *fits[j].trim, {fits[i].method, fits[j].method}, c);
    }
    for (const Reference& reference : references) {
      compare_reference(fits[i], reference, c);
      if (fits[i].trim && reference.trim) add_trims(*fits[i].trim, *reference.trim, {fits[i].method, reference.name, true}, c);
    }
  }
  return c;
}

}  // namespace misfit
