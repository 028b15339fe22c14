#include "misfit/inference/driven.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "misfit/core/text.h"
#include "misfit/inference/states.h"

namespace misfit {
namespace {

/// Median size of the averages over `samples` neighbours, all known: single wild ones, as of a clock angle where the tilt vanishes, do not
/// count. NaN where nowhere so many neighbours are known.
double median_average(const std::vector<double>& values, std::size_t samples) {
  std::vector<double> sizes;
  double sum = 0.0;
  std::size_t known = 0;  // up to here
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      known = 0, sum = 0.0;
      continue;
    }
    sum += values[i];
    if (++known > samples) sum -= values[i - samples];
    if (known >= samples) sizes.push_back(std::abs(sum) / static_cast<double>(samples));
  }
  return median(std::move(sizes));
}

/// NaN where the other is.
std::vector<double> where_known(std::vector<double> values, const std::vector<double>& other) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(other[i])) values[i] = other[i];
  }
  return values;
}

}  // namespace

bool DrivenTest::tested() const { return !std::isnan(share) && !std::isnan(times_noise); }

bool DrivenTest::driven() const {
  constexpr double above_noise = 4.0;
  return tested() && times_noise > above_noise && !deterministic();
}

DrivenTest test_driven(const EquationResiduals& equation) {
  constexpr int fewest_lags = 5;
  DrivenTest test;
  test.averaged = std::max(equation.half_period, 1);
  test.whiteness = whiteness(on_even_grid(equation.t, equation.residual), equation.stencil_reach,
                             std::max(equation.stencil_reach + fewest_lags, equation.half_period));
  const auto average = [&](const std::vector<double>& values) {
    return median_average(on_even_grid(equation.t, where_known(values, equation.residual)), test.averaged);
  };
  const double residual = average(equation.residual), acceleration = average(equation.acceleration);
  test.share = acceleration == 0.0 ? 0.0 : residual / acceleration;
  if (!test.tested() || test.deterministic()) return test;
  const double noise = average(equation.of_noise());
  test.times_noise = noise == 0.0 ? std::numeric_limits<double>::infinity() : residual / noise;
  return test;
}

std::string in_words(const DrivenTest& test) {
  if (!test.tested()) {
    return fmt::format("residuals are not tested for a force: nowhere are {} of them, half a period, known without a gap; at {}",
                       test.averaged, in_words(test.whiteness));
  }
  const std::string noise = test.deterministic() ? "" : fmt::format(", {:.2g} times what measurement noise makes", test.times_noise);
  return fmt::format("residuals averaged over {} samples are {:.2g} of the averaged acceleration{}; at {}", test.averaged, test.share,
                     noise, in_words(test.whiteness));
}

Signals with_more_noise(const SystemSpec& system, const Signals& signals) {
  constexpr unsigned seed = 1;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals out = signals;
  const auto add = [&](Signal& channel) {
    const double sigma = measurement_noise(channel.values);
    if (!(sigma > 0.0)) return;
    for (double& value : channel.values) value += sigma * normal(random);
  };
  for (Signal& channel : out.measured) add(channel);
  for (std::size_t k = 0; k < out.inputs.size(); ++k) {
    if (system.inputs[k].hold != Hold::zero_order) add(out.inputs[k]);
  }
  return out;
}

}  // namespace misfit
