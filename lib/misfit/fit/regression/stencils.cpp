#include "misfit/fit/regression/stencils.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace misfit {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double step_tolerance = 0.2;  // of the mean step

/// Mean step over samples first … last; NaN if the steps are too uneven for weights that assume even ones.
double even_step(const std::vector<double>& t, std::size_t first, std::size_t last) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    shortest = std::min(shortest, t[i + 1] - t[i]);
    longest = std::max(longest, t[i + 1] - t[i]);
  }
  const double mean = (t[last] - t[first]) / static_cast<double>(last - first);
  return longest - shortest < step_tolerance * mean ? mean : nan_value;
}

struct Weights {
  std::array<double, 5> rate, acceleration;  // on f₋₂ … f₂, for h = 1
};

Weights weights_of(Stencils stencils) {
  if (stencils == Stencils::fourth_order) {
    return {{1.0 / 12.0, -8.0 / 12.0, 0.0, 8.0 / 12.0, -1.0 / 12.0}, {-1.0 / 12.0, 16.0 / 12.0, -30.0 / 12.0, 16.0 / 12.0, -1.0 / 12.0}};
  }
  return {{-0.2, -0.1, 0.0, 0.1, 0.2}, {1.0 / 3.0, -1.0 / 3.0, 0.0, -1.0 / 3.0, 1.0 / 3.0}};
}

}  // namespace

std::vector<double> average_of_three(const std::vector<double>& t, const std::vector<double>& f) {
  std::vector<double> mean(f.size(), nan_value);
  for (std::size_t i = 1; i + 1 < f.size(); ++i) {
    if (std::isfinite(even_step(t, i - 1, i + 1))) mean[i] = (f[i - 1] + f[i] + f[i + 1]) / 3.0;
  }
  return mean;
}

StencilMotion stencil_motion(const std::vector<double>& t, const std::vector<double>& f, Stencils stencils) {
  const Weights weights = weights_of(stencils);
  const std::vector<double> missing(f.size(), nan_value);
  StencilMotion out{missing, missing, missing};
  for (std::size_t i = 2; i + 2 < f.size(); ++i) {
    const double h = even_step(t, i - 2, i + 2);
    double rate = 0.0, acceleration = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      rate += weights.rate[k] * f[i + k - 2];
      acceleration += weights.acceleration[k] * f[i + k - 2];
    }
    rate /= h;
    acceleration /= h * h;
    if (!std::isfinite(rate) || !std::isfinite(acceleration)) continue;  // 0 × NaN is NaN: the middle sample counts too
    out.level[i] = f[i];
    out.rate[i] = rate;
    out.acceleration[i] = acceleration;
  }
  return out;
}

}  // namespace misfit
