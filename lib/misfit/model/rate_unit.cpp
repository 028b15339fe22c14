#include "misfit/model/rate_unit.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "misfit/core/units.h"

namespace misfit {

bool is_per_time(const std::string& unit) {
  constexpr std::array<std::string_view, 4> times = {"s", "ms", "min", "h"};
  double power = 0.0;
  for (const auto& [symbol, exponent] : unit_symbols(unit)) {
    if (symbol == "Hz") power -= exponent;
    if (std::find(times.begin(), times.end(), symbol) != times.end()) power += exponent;
  }
  return power == -1.0;
}

}  // namespace misfit
