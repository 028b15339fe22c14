#include "misfit/compare/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "misfit/compare/curve_difference.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

/// The curve whose zero is the trim; its slope there is the static stability.
constexpr const char* static_curve = "C_m";

bool usable(const Fit& fit) { return fit.status == FitStatus::converged || fit.status == FitStatus::not_converged; }

bool alike(const CurveEstimate& a, const CurveEstimate& b) {
  return a.name == b.name && a.of == b.of && a.of_unit == b.of_unit && a.unit == b.unit;
}

bool alike(const CurveEstimate& a, const Reference& b) {
  return a.name == b.curve && a.of == b.of && a.of_unit == b.of_unit && a.unit == b.unit;
}

MethodSummary summary(const Fit& fit) {
  MethodSummary m{fit.method, fit.status,         fit.message, fit.driven,           fit.trim, {}, {},
                  fit.rms,    fit.validation_rms, fit.loglik,  fit.validation_loglik};
  for (const CurveEstimate& curve : fit.curves) {
    if (!usable(fit) || !fit.trim || !curve.informative || curve.of_unit != fit.trim->unit) continue;
    if (curve.name == static_curve) {
      if (const auto slope = slope_at(curve, fit.trim->value)) m.slopes[curve.name] = *slope;
    } else if (const auto point = visited_point(curve, fit.trim->value)) {
      m.at_trim[curve.name] = {point->value, point->sigma, curve.unit};
    }
  }
  return m;
}

void list_left_out(const Fit& fit, Comparison& c) {
  if (!usable(fit)) {
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

void add_difference(const CurveEstimate& curve, const std::vector<CurvePoint>& points, const Sides& sides, Comparison& c) {
  std::optional<CurveDifference> d = difference(curve, points);
  if (!d) {
    c.not_compared.push_back({fmt::format("{} of {} and {}", curve.name, sides.a, sides.b), "no common visited range with uncertainties"});
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
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < reference.x.size(); ++i) points.push_back({reference.x[i], reference.value[i], reference.sigma[i]});
  for (const CurveEstimate& curve : fit.curves) {
    if (curve.informative && alike(curve, reference)) add_difference(curve, points, {fit.method, reference.name, true}, c);
  }
}

std::string sentence(const TrimDifference& d) {
  const double to_shown = convert(1.0, d.difference.unit, display_unit(d.difference.unit));
  const std::string size = format_value(std::abs(d.difference.value) * to_shown, d.difference.sigma * to_shown);
  const std::string where = d.difference.value < 0.0 ? "below" : "above";
  const std::string sigmas = std::isfinite(d.sigmas) ? fmt::format(" ({:.1f} sigma)", d.sigmas) : " (no uncertainty known)";
  return fmt::format("the trim of {} is {} {} {} that of {}{}", d.a, size, display_unit(d.difference.unit), where, d.b, sigmas);
}

void add_trims(const Estimate& a, const Estimate& b, const Sides& sides, Comparison& c) {
  if (a.unit != b.unit) return;
  const double sigma = std::hypot(a.sigma, b.sigma);
  const double gap = a.value - b.value;
  const double sigmas = sigma > 0.0 ? std::abs(gap) / sigma : std::numeric_limits<double>::quiet_NaN();
  TrimDifference d{sides.a, sides.b, sides.reference, {gap, sigma, a.unit}, sigmas, ""};
  d.sentence = sentence(d);
  c.trims.push_back(std::move(d));
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
    if (!usable(fits[i])) continue;
    for (std::size_t j = i + 1; j < fits.size(); ++j) {
      if (!usable(fits[j])) continue;
      compare_pair(fits[i], fits[j], c);
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
