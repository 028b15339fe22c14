#include "misfit/model/role_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {
namespace {

using Factors = std::vector<std::pair<std::string, double>>;  // symbol, power; in the order met

void multiply(Factors& factors, const std::string& symbol, double power) {
  if (symbol == "-" || symbol == "1" || symbol.empty()) return;
  for (auto& [known, sum] : factors) {
    if (known == symbol) {
      sum += power;
      return;
    }
  }
  factors.emplace_back(symbol, power);
}

/// "m^2" → ("m", 2); "s2" → ("s", 2).
std::pair<std::string, double> symbol_and_power(std::string_view factor) {
  const auto end = factor.find_first_of("^0123456789");
  if (end == std::string_view::npos || end == 0) return {std::string(factor), 1.0};
  const auto power = factor.substr(factor[end] == '^' ? end + 1 : end);
  return {std::string(factor.substr(0, end)), std::stod(std::string(power))};
}

/// Multiplies `factors` by unit^power: '/' divides by the one factor that follows it (units.h). `units` gives the roles in braces.
void multiply_unit(Factors& factors, std::string_view unit, double power, const std::map<std::string, std::string>& units) {
  double sign = 1.0;
  while (!unit.empty()) {
    if (unit.front() == ' ' || unit.front() == '*') {
      unit.remove_prefix(1);
      continue;
    }
    if (unit.front() == '/') {
      sign = -1.0;
      unit.remove_prefix(1);
      continue;
    }
    if (unit.front() == '{') {
      const auto close = unit.find('}');
      if (close == std::string_view::npos) throw InputError("unit '" + std::string(unit) + "': '}' is missing");
      const auto role = units.find(std::string(unit.substr(1, close - 1)));
      if (role != units.end()) multiply_unit(factors, role->second, sign * power, {});
      unit.remove_prefix(close + 1);
    } else {
      const auto end = std::min(unit.size(), unit.find_first_of(" */{"));
      const auto [symbol, own] = symbol_and_power(unit.substr(0, end));
      multiply(factors, symbol, sign * power * own);
      unit.remove_prefix(end);
    }
    sign = 1.0;
  }
}

}  // namespace

std::string bind_unit(const std::string& unit, const std::map<std::string, std::string>& units) {
  if (unit.find('{') == std::string::npos) return unit;
  Factors factors;
  multiply_unit(factors, unit, 1, units);
  std::string above, below;
  for (const auto& [symbol, power] : factors) {
    const double size = std::abs(power);
    if (size == 0.0) continue;
    std::string& side = power > 0.0 ? above : below;
    if (power < 0.0) side += '/';
    if (power > 0.0 && !side.empty()) side += ' ';
    side += symbol;
    if (size != 1.0) side += fmt::format("^{}", size);
  }
  if (above.empty() && below.empty()) return "-";
  return (above.empty() ? "1" : above) + below;
}

}  // namespace misfit
