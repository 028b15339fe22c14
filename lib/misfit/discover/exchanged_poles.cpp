#include "misfit/discover/exchanged_poles.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// d(rates)/d(states) of the system's own states.
Eigen::MatrixXd linearised_system(const FilterEstimate& estimate) {
  const Model& model = estimate.model;
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

}  // namespace

int time_constant_of(const Model& model) {
  const BoundEffect& bound = model.effects.back();
  if (bound.effect->spec().states.empty()) return -1;
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
  const Eigen::MatrixXd A = linearised_system(estimate);
  if (!A.allFinite()) return {};
  std::vector<double> out;
  const Eigen::VectorXcd poles = Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
  for (Eigen::Index i = 0; i < poles.size(); ++i) {
    const std::complex<double> pole = poles[i];
    constexpr double rounding = 1e-9;  // of the pole
    if (std::abs(pole.imag()) > rounding * std::abs(pole) || !(pole.real() < 0.0)) continue;
    const double constant = -1.0 / pole.real();
    if (constant >= least && constant <= most) out.push_back(constant);
  }
  return out;
}

std::string exchange_in_words(const FilterEstimate& estimate, const FilterEstimate& other, int time) {
  const std::vector<Parameter>&here = estimate.model.parameters, &there = other.model.parameters;
  int most = -1;
  double largest = 0.0;
  for (const int i : estimate.model.free_parameters()) {
    const double change = std::abs(there[i].value - here[i].value) / std::max(std::abs(here[i].value), std::abs(there[i].value));
    if (i == time || here[i].curve >= 0 || !(change > largest)) continue;
    largest = change;
    most = i;
  }
  std::string out = there[time].name + " = " + in_display_unit(there[time].value, there[time].unit);
  constexpr double same = 0.05;
  if (most >= 0 && largest > same) out += " with " + there[most].name + " = " + in_display_unit(there[most].value, there[most].unit);
  return out + " explains hardly less (a drop lower by " + format_value(2.0 * (estimate.objective - other.objective)) + ")";
}

}  // namespace misfit
