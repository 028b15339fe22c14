#include "misfit/attitude/stencil.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/missing.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

// Are all steps from sample `first` to sample `last` even?
bool even_between(const std::vector<bool>& even, std::size_t first, std::size_t last) {
  return std::all_of(even.begin() + first, even.begin() + last, [](bool e) { return e; });
}

}  // namespace

std::vector<bool> even_steps(const std::vector<double>& t, double tolerance) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  const double usual = median(steps);
  std::vector<bool> even;
  for (const double step : steps) even.push_back(std::abs(step - usual) <= tolerance * usual);
  return even;
}

std::array<double, 5> derivative_weights(const std::vector<double>& t, std::size_t i) {
  std::array<double, 5> d{};
  for (std::size_t k = 0; k < 5; ++k) d[k] = t[i - 2 + k] - t[i];
  std::array<double, 5> w{};
  for (std::size_t k = 0; k < 5; ++k) {  // L_k'(0) of the Lagrange polynomial that is 1 at d_k and 0 at the others; d_2 = 0
    if (k == 2) continue;
    w[k] = 1.0 / d[k];
    for (std::size_t j = 0; j < 5; ++j) {
      if (j != k && j != 2) w[k] *= -d[j] / (d[k] - d[j]);
    }
    w[2] -= w[k];  // a constant has no derivative
  }
  return w;
}

std::vector<double> three_point_average(const std::vector<double>& f, const std::vector<bool>& even) {
  std::vector<double> average(f.size(), kMissing);
  for (std::size_t i = 1; i + 1 < f.size(); ++i) {
    if (even_between(even, i - 1, i + 1)) average[i] = (f[i - 1] + f[i] + f[i + 1]) / 3.0;
  }
  return average;
}

std::vector<double> five_point_derivative(const std::vector<double>& f, const std::vector<double>& t, const std::vector<bool>& even) {
  std::vector<double> derivative(f.size(), kMissing);
  for (std::size_t i = 2; i + 2 < f.size(); ++i) {
    if (!even_between(even, i - 2, i + 2)) continue;
    const std::array<double, 5> w = derivative_weights(t, i);
    double sum = 0.0;
    for (std::size_t k = 0; k < 5; ++k) sum += w[k] * f[i - 2 + k];
    derivative[i] = sum;
  }
  return derivative;
}

}  // namespace misfit
