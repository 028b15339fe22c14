#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "misfit/core/table.h"
#include "misfit/data/signals.h"
#include "misfit/model/model.h"
#include "misfit_models_registry.h"
#include "tests/paths.h"

namespace misfit::testing_planar {

inline constexpr double degree = 3.14159265358979323846 / 180.0;

inline const Registry& registry() {
  static const Registry filled = [] {
    Registry r;
    misfit_models_register(r);
    return r;
  }();
  return filled;
}

/// Table 1 of the paper (lib/misfit/README.md, [1]).
inline std::map<std::string, double> table_1() {
  return {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
}

/// The paper's Eq. 8 (alpha_T is the state) with the given effects; knots are of no account to sliding_bin.
inline ModelRequest eq_8(const std::vector<std::string>& effects = {"static_moment", "pitch_damping"}) {
  ModelRequest request;
  request.system = "parachute_planar";
  request.options.flags["induced_angle"] = false;
  request.constants = table_1();
  for (const auto& effect : effects) {
    request.effects.push_back({effect, effect, {}, {}});
    if (effect == "static_moment") request.curves["C_m"] = {"alpha_T", {0.1, 0.2, 0.3}, {}, {}};
    if (effect == "pitch_damping") request.curves["C_m_alphadot"] = {"alpha_T", {0.1, 0.2, 0.3}, {}, {}};
  }
  return request;
}

inline Signals measured(const std::vector<double>& t, const std::vector<double>& alpha_T) {
  Signals signals;
  signals.name = "test";
  signals.t = t;
  signals.measured.push_back({"alpha_T", "rad", alpha_T, 0.0});
  const std::vector<double> nothing(t.size(), 0.0);
  signals.inputs = {{"phi", "rad", nothing}, {"phi_rate", "rad/s", nothing}};
  return signals;
}

inline Table validation() { return read_csv(paths::source() / "configs/validation/alpha_history.csv"); }

/// The validation's history as measured, with 0.1 deg of measurement noise, or `alpha_T_true` [rad].
inline Signals validation_signals(const std::string& column = "alpha_T") {
  const Table table = validation();
  return measured(table.values("t", "s"), table.values(column, "rad"));
}

inline std::vector<double> even_times(std::size_t n, double h) {
  std::vector<double> t(n);
  for (std::size_t i = 0; i < n; ++i) t[i] = static_cast<double>(i) * h;
  return t;
}

}  // namespace misfit::testing_planar
