#pragma once

#include <string>
#include <utility>
#include <vector>

#include "misfit/core/units.h"

namespace misfit::formula {

/// The unit of a part of a formula: exponents for comparing, symbols for printing.
struct Measure {
  Unit unit;                                            ///< to_si is 1: formulas are computed in SI
  std::vector<std::pair<std::string, double>> symbols;  ///< "V" to the power 0.5, in the order met
  bool any = false;                                     ///< the number 0, which fits every unit
  bool truth = false;                                   ///< a condition

  [[nodiscard]] std::string text() const;  ///< "V^0.5/s", "-"
  [[nodiscard]] bool is_plain() const { return any || unit.same_dimension(Unit{}); }
  [[nodiscard]] bool fits(const Measure& other) const { return any || other.any || unit.same_dimension(other.unit); }
};

/// InputError if the unit is not known, or not SI itself (mV, deg): formulas are computed in SI.
[[nodiscard]] Measure measure_of(const std::string& unit);
/// a^p · b^q.
[[nodiscard]] Measure product(const Measure& a, double p, const Measure& b, double q);

}  // namespace misfit::formula
