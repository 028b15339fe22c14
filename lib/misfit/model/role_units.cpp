#include "misfit/model/role_units.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/units.h"

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

/// The power that stands behind a role, "^0.5" or "^(1/2)", taken off the front of `rest`; 1 if there is none.
double take_power(std::string_view& rest) {
  if (rest.empty() || rest.front() != '^') return 1.0;
  const auto end = rest.starts_with("^(") ? std::min(rest.size(), rest.find(')') + 1) : std::min(rest.size(), rest.find_first_of(" */{"));
  const auto factors = unit_symbols("m" + std::string(rest.substr(0, end)));  // as of a unit: its grammar is known in one place
  rest.remove_prefix(end);
  return factors.empty() ? 0.0 : factors.front().second;
}

/// Multiplies `factors` by `unit`: '/' divides by the one factor that follows it (units.h). `units` gives the roles in braces.
void multiply_unit(Factors& factors, std::string_view unit, const std::map<std::string, std::string>& units) {
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
      if (close == std::string_view::npos) throw InputError("unit '" + shown(unit) + "': '}' is missing");
      const auto role = units.find(std::string(unit.substr(1, close - 1)));
      unit.remove_prefix(close + 1);
      const double power = sign * take_power(unit);
      if (role != units.end()) {
        for (const auto& [symbol, own] : unit_symbols(role->second)) multiply(factors, symbol, power * own);
      }
    } else {
      const auto end = std::min(unit.size(), unit.find_first_of(" */{"));
      for (const auto& [symbol, own] : unit_symbols(unit.substr(0, end))) multiply(factors, symbol, sign * own);
      unit.remove_prefix(end);
    }
    sign = 1.0;
  }
}

using Roles = std::map<std::string, std::string>;

/// The role whose own unit it is, "{port}", with how it is shown.
Roles::const_iterator alone(const std::string& unit, const Roles& units) {
  return unit.find('}') == unit.size() - 1 ? units.find(unit.substr(1, unit.size() - 2)) : units.end();
}

}  // namespace

std::string bind_unit(const std::string& unit, const std::map<std::string, std::string>& units) {
  if (unit.find('{') == std::string::npos) return unit;
  if (const auto role = alone(unit, units); role != units.end()) return role->second;
  Factors factors;
  multiply_unit(factors, unit, units);
  return unit_text(factors);
}

}  // namespace misfit
