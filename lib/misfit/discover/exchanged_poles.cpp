#include "misfit/discover/exchanged_poles.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"
#include "misfit/model/memory.h"

namespace misfit {
namespace {

/// d(rates)/d(states) of the system's own states.
Eigen::MatrixXd linearised_system(const Model& model, const FilterEstimate& estimate) {
  const FilterTrace& trace = estimate.traces.front();
  const FilterData& data = estimate.data.front();
  const std::size_t middle = (data.first + trace.samples) / 2;
  Evaluator evaluator(model);
  const int n = model.states(), own = model.system_states();
  const Eigen::VectorXd x = trace.filtered(middle);
  std::vector<double> dx(n), D(n * kRowStride);
  Slots slots;
  evaluator.linearise_rates({x.data(), data.inputs.at(middle), data.signals->t[middle]}, slots, dx.data(), D.data());
  Eigen::MatrixXd out(own, own);
  for (Eigen::Index i = 0; i < own; ++i) {
    for (Eigen::Index j = 0; j < own; ++j) out(i, j) = D[i * kRowStride + j];
  }
  return out;
}

/// -1/pole of the real, stable poles [s].
std::vector<double> real_time_constants(const Model& model, const FilterEstimate& estimate) {
  const Eigen::MatrixXd A = linearised_system(model, estimate);
  if (!A.allFinite()) return {};
  std::vector<double> out;
  const Eigen::VectorXcd poles = eigenvalues(A);
  for (const std::complex<double>& pole : poles) {
    constexpr double rounding = 1e-9;  // of the pole
    if (std::abs(pole.imag()) <= rounding * std::abs(pole) && pole.real() < 0.0) out.push_back(-1.0 / pole.real());
  }
  return out;
}

/// NaN where there is none.
double nearest_constant(const std::vector<double>& all, double to) {
  double out = std::nan("");
  for (const double constant : all) {
    if (!std::isfinite(out) || std::abs(std::log(constant / to)) < std::abs(std::log(out / to))) out = constant;
  }
  return out;
}

}  // namespace

int time_constant_of(const Model& model) {
  const BoundEffect& bound = model.effects.back();
  const EffectSpec& spec = bound.effect->spec();
  const bool in_series =
      std::any_of(spec.coefficients.begin(), spec.coefficients.end(), [](const CoefficientSpec& k) { return k.whole != 0.0; });
  if (!has_linear_memory(*bound.effect) || !in_series) return -1;
  int out = -1;
  for (const BoundCoefficient& c : bound.coefficients) {
    if (c.parameter < 0 || model.parameters[c.parameter].unit != "s") continue;
    if (out >= 0) return -1;
    out = c.parameter;
  }
  return out >= 0 && model.parameters[out].free ? out : -1;
}

std::vector<double> time_constants_of_system(const FilterEstimate& estimate) {
  const std::vector<double>& t = estimate.data.front().signals->t;
  if (t.size() < 3) return {};
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  const double least = 0.5 * median(std::move(steps)), most = 0.5 * (t.back() - t.front());
  std::vector<double> out = real_time_constants(estimate.model, estimate);
  std::erase_if(out, [&](double constant) { return constant < least || constant > most; });
  return out;
}

std::optional<MovedPole> moved_pole(const FilterEstimate& estimate, double constant, double wanted) {
  constexpr double small = 0.01, least_exponent = 0.2, close = 1e-3;  // of a logarithm
  Model model = estimate.model;
  const auto constant_with = [&](int parameter, double value) {
    const double before = std::exchange(model.parameters[parameter].value, value);
    const double out = nearest_constant(real_time_constants(model, estimate), constant);
    model.parameters[parameter].value = before;
    return out;
  };
  MovedPole out;
  double exponent = 0.0;  // of the constant as a power of the parameter
  const int own = model.effects.back().coefficients.empty() ? -1 : time_constant_of(model);
  for (const int i : model.free_parameters()) {
    const double value = model.parameters[i].value;
    if (i == own || model.parameters[i].curve >= 0 || value == 0.0) continue;
    const double there = std::log(constant_with(i, value * (1.0 + small)) / constant) / std::log1p(small);
    if (std::isfinite(there) && std::abs(there) > std::abs(exponent)) {
      exponent = there;
      out = {i, value};
    }
  }
  if (!(std::abs(exponent) > least_exponent)) return std::nullopt;
  const Parameter& p = model.parameters[out.parameter];
  for (int step = 0; step < 20; ++step) {
    const double at = constant_with(out.parameter, out.value), off = std::log(wanted / at);
    if (std::abs(off) < close) return out;
    constexpr double longest = 1.0;  // of the logarithm
    out.value = std::clamp(out.value * std::exp(std::clamp(off / exponent, -longest, longest)), p.lower, p.upper);
    constant = at;
  }
  return std::nullopt;
}

std::string exchange_in_words(const FilterEstimate& estimate, const FilterEstimate& other, int time) {
  const std::vector<Parameter>&here = estimate.model.parameters, &there = other.model.parameters;
  int most = -1;
  double largest = 0.0;
  for (const int i : estimate.model.free_parameters()) {
    const double change = std::abs(there[i].value - here[i].value) / std::max(std::abs(here[i].value), std::abs(there[i].value));
    const auto sigma = standard_error_of(estimate.model, estimate.covariance, i);
    constexpr double known = 5.0;  // sigmas: the relative change of what may be 0 says nothing
    if (i == time || here[i].curve >= 0 || !(change > largest) || !sigma || std::abs(here[i].value) < known * *sigma) continue;
    largest = change;
    most = i;
  }
  std::string out =
      "a second solution is about as good: " + there[time].name + " = " + in_display_unit(there[time].value, there[time].unit);
  constexpr double same = 0.05;
  if (most >= 0 && largest > same) out += " with " + there[most].name + " = " + in_display_unit(there[most].value, there[most].unit);
  return out + " (its drop is " + (other.objective > estimate.objective ? "higher" : "lower") + " by " +
         format_value(2.0 * std::abs(estimate.objective - other.objective)) +
         "); these data do not tell which time constant is the effect's";
}

}  // namespace misfit
