#include "misfit/formula/measure.h"

#include <fmt/format.h>

#include <cmath>

#include "misfit/core/error.h"

namespace misfit::formula {
namespace {

void multiply(Measure& into, const Measure& by, double power) {
  for (std::size_t i = 0; i < into.unit.dimension.size(); ++i) into.unit.dimension[i] += power * by.unit.dimension[i];
  for (const auto& [symbol, own] : by.symbols) {
    bool known = false;
    for (auto& [have, sum] : into.symbols) {
      if (have != symbol) continue;
      sum += power * own;
      known = true;
    }
    if (!known) into.symbols.emplace_back(symbol, power * own);
  }
}

}  // namespace

std::string Measure::text() const {
  if (truth) return "a condition";
  return unit_text(symbols);
}

Measure measure_of(const std::string& unit) {
  Measure out;
  out.unit = parse_unit(unit);
  if (std::abs(out.unit.to_si - 1.0) > 1e-12 || out.unit.offset != 0.0) {
    const std::string si = unit_in_si(unit);
    throw InputError("[" + unit + "] is not an SI unit: formulas are computed in SI, declare it as \"" + (si.empty() ? "-" : si) +
                     "\"; data may have any unit, and so may values, as \"5 " + unit + "\"");
  }
  for (const auto& [symbol, power] : unit_symbols(unit)) multiply(out, {Unit{}, {{symbol, 1.0}}, false, false}, power);
  return out;
}

Measure product(const Measure& a, double p, const Measure& b, double q) {
  Measure out;
  multiply(out, a, p);
  multiply(out, b, q);
  return out;
}

}  // namespace misfit::formula
