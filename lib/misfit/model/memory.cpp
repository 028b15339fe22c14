#include "misfit/model/memory.h"

#include <cmath>
#include <vector>

namespace misfit {
namespace {

/// Rates of the own states of an example: as it is, and with one own state moved to either side.
struct MovedRates {
  std::vector<double> at, ahead, behind;
};

std::vector<double> rates_of(const Effect& effect, const Example& example, std::size_t moved, double by) {
  const std::size_t states = effect.spec().states.size(), ports = effect.spec().ports.size();
  std::vector<double> z = example.states, out(ports + states, 0.0);
  z[moved] += by;
  effect.evaluate({example.quantities.data(), example.coefficients.data(), z.data(), example.constants.data(), example.t}, out.data());
  return {out.begin() + static_cast<std::ptrdiff_t>(ports), out.end()};
}

/// Of every example and own state.
std::vector<MovedRates> moved_rates(const Effect& effect) {
  constexpr double by = 0.7;
  std::vector<MovedRates> out;
  for (const Example& example : effect.examples()) {
    for (std::size_t z = 0; z < effect.spec().states.size(); ++z)
      out.push_back({rates_of(effect, example, z, 0.0), rates_of(effect, example, z, by), rates_of(effect, example, z, -by)});
  }
  return out;
}

bool is_constant(const MovedRates& rates) { return rates.at == rates.ahead && rates.at == rates.behind; }

bool is_linear(const MovedRates& rates) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < rates.at.size(); ++i) {
    const double size = std::abs(rates.ahead[i]) + std::abs(rates.behind[i]);
    if (std::abs(rates.ahead[i] - 2.0 * rates.at[i] + rates.behind[i]) > rounding * size) return false;
  }
  return true;
}

}  // namespace

bool has_linear_memory(const Effect& effect) {
  const std::vector<MovedRates> rates = moved_rates(effect);
  return !std::all_of(rates.begin(), rates.end(), is_constant) && std::all_of(rates.begin(), rates.end(), is_linear);
}

bool only_adds_up(const Effect& effect) {
  const std::vector<MovedRates> rates = moved_rates(effect);
  return !rates.empty() && std::all_of(rates.begin(), rates.end(), is_constant);
}

}  // namespace misfit
