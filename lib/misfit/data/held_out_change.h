#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace misfit {

/// Whether a series is a constant where it counts, from sample `first` on, and another or none where it is held out: what it does cannot be
/// estimated. `held_out(i)`: of sample i.
template <class HeldOut>
bool changes_held_out_alone(const std::vector<double>& values, std::size_t first, const HeldOut& held_out) {
  std::optional<double> constant;
  for (std::size_t i = first; i < values.size(); ++i) {
    if (held_out(i)) continue;
    if (constant && values[i] != *constant) return false;
    constant = values[i];
  }
  bool changes = false;
  for (std::size_t i = first; i < values.size(); ++i) changes = changes || (constant && held_out(i) && values[i] != *constant);
  return changes;
}

}  // namespace misfit
