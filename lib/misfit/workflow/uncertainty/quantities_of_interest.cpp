#include "misfit/workflow/uncertainty/quantities_of_interest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "misfit/compare/curve_difference.h"
#include "misfit/data/curve_coefficient.h"

namespace misfit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const CurveEstimate* find_curve(const Fit& fit, const std::string& name) {
  const auto found = std::find_if(fit.curves.begin(), fit.curves.end(), [&](const CurveEstimate& c) { return c.name == name; });
  return found == fit.curves.end() ? nullptr : &*found;
}

/// The static curve's slope at the trim, or another curve's value there.
std::optional<Estimate> at_trim(const CurveEstimate& curve, const Fit& fit, const std::string& static_curve) {
  if (!fit.trim || curve.of_unit != fit.trim->unit) return std::nullopt;
  if (curve.name == static_curve) return slope_at(curve, fit.trim->value);
  const auto point = visited_point(curve, fit.trim->value);
  return point ? std::optional<Estimate>({point->value, point->sigma, curve.unit}) : std::nullopt;
}

std::string name_at_trim(const std::string& curve, const std::string& static_curve) {
  return curve == static_curve ? "slope of " + curve : curve + " at the trim";
}

/// Linear between the neighbouring points of the curve; NaN outside them. Both in rising order.
std::vector<double> values_at(const CurveEstimate* curve, const std::vector<double>& places) {
  std::vector<double> out(places.size(), nan);
  if (curve == nullptr || curve->x.size() < 2) return out;
  const std::vector<double>& x = curve->x;
  std::size_t right = 1;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] < x.front() || places[i] > x.back()) continue;
    while (right + 1 < x.size() && x[right] < places[i]) ++right;
    const double share = (places[i] - x[right - 1]) / (x[right] - x[right - 1]);
    out[i] = curve->value[right - 1] + share * (curve->value[right] - curve->value[right - 1]);
  }
  return out;
}

SpreadCurve spread_curve(const CurveEstimate& curve) {
  const auto seen = [](double count) { return count > 0.0; };
  const auto first = std::find_if(curve.count.begin(), curve.count.end(), seen) - curve.count.begin();
  const auto behind = curve.count.rend() - std::find_if(curve.count.rbegin(), curve.count.rend(), seen);
  SpreadCurve out{curve.name, curve.of, curve.of_unit, curve.unit, {}, {}, {}, {}, {}, curve.informative, curve.why, curve.trimmed};
  for (auto i = first; i < behind; ++i) {
    out.x.push_back(curve.x[i]);
    out.nominal.push_back(curve.value[i]);
  }
  return out;
}

}  // namespace

QuantitiesOfInterest::QuantitiesOfInterest(const Fit& nominal, const Fit& run, std::string static_curve)
    : static_curve_(std::move(static_curve)) {
  const auto add = [&](const std::string& name, const Estimate& e) {
    SpreadNumber number;
    number.name = name;
    number.unit = e.unit.empty() ? "-" : e.unit;
    number.nominal = e.value;
    number.nominal_sigma = e.sigma;
    numbers_.push_back(std::move(number));
  };
  if (nominal.trim) add("trim", *nominal.trim);
  for (const CurveEstimate& curve : nominal.curves) {
    if (const auto value = at_trim(curve, nominal, static_curve_)) add(name_at_trim(curve.name, static_curve_), *value);
    curves_.push_back(spread_curve(curve));
  }
  for (const auto& [name, estimate] : nominal.parameters) {
    if (!is_curve_coefficient(name) && run.parameters.contains(name)) add(name, estimate);
  }
}

std::vector<double> QuantitiesOfInterest::scalars_of(const Fit& fit) const {
  std::map<std::string, double> values;
  if (fit.trim) values["trim"] = fit.trim->value;
  for (const CurveEstimate& curve : fit.curves) {
    if (const auto value = at_trim(curve, fit, static_curve_)) values[name_at_trim(curve.name, static_curve_)] = value->value;
  }
  for (const auto& [name, estimate] : fit.parameters) values[name] = estimate.value;
  std::vector<double> out;
  for (const SpreadNumber& number : numbers_) out.push_back(values.contains(number.name) ? values.at(number.name) : nan);
  return out;
}

std::vector<double> QuantitiesOfInterest::evaluate(const Fit& fit) const {
  std::vector<double> out = scalars_of(fit);
  for (const SpreadCurve& curve : curves_) {
    const std::vector<double> values = values_at(find_curve(fit, curve.name), curve.x);
    out.insert(out.end(), values.begin(), values.end());
  }
  out.push_back(fit.status == FitStatus::converged ? 0.0 : 1.0);
  return out;
}

void QuantitiesOfInterest::fill(const MonteCarloResult& result, const std::vector<std::string>& terms, Uncertainty& out) const {
  out.numbers = numbers_;
  out.curves = curves_;
  for (std::size_t i = 0; i < out.numbers.size(); ++i) {
    SpreadNumber& number = out.numbers[i];
    number.mean = result.numbers[i].mean;
    number.sigma = result.numbers[i].sigma;
    number.count = result.numbers[i].count;
    const VarianceShares& shares = result.shares[i];
    number.rest = shares.rest;
    for (std::size_t t = 0; t < shares.share.size(); ++t)
      number.shares.push_back({terms[t], shares.share[t], shares.sigma[t], shares.effect[t]});
  }
  std::size_t at = out.numbers.size();
  for (SpreadCurve& curve : out.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i, ++at) {
      curve.mean.push_back(result.numbers[at].mean);
      curve.sigma.push_back(result.numbers[at].sigma);
      curve.count.push_back(static_cast<double>(result.numbers[at].count));
    }
  }
}

std::vector<std::string> unfinished_notes(const Fit& nominal, const MonteCarloResult& runs) {
  std::vector<std::string> notes;
  if (nominal.status != FitStatus::converged) notes.push_back("The nominal fit has not converged (" + nominal.message + ").");
  const Moments& last = runs.numbers.back();
  const long unfinished = std::lround(last.mean * static_cast<double>(last.count));
  if (unfinished > 0)
    notes.push_back(std::to_string(unfinished) + " of " + std::to_string(runs.runs) +
                    " runs had not converged; mean and sigma include their last iterates.");
  return notes;
}

}  // namespace misfit
