#include "misfit/data/sweep.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/table.h"

namespace misfit {
namespace {

/// A static rig is tilted by less than a quarter turn: a larger angle is degrees under a header without unit.
void check_angles(const Table& table, const std::vector<double>& theta) {
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const Source where{table.source, table.line[i], 0};
    if (std::isnan(theta[i])) throw InputError(where, "column 'theta': the angle is missing");
    if (std::abs(theta[i]) < std::numbers::pi / 2.0) continue;
    throw InputError(where,
                     fmt::format("theta = {} rad is beyond a quarter turn; if it is in degrees, the header must be theta[deg]", theta[i]));
  }
}

}  // namespace

Sweep read_sweep(const std::filesystem::path& path) {
  const Table table = read_csv(path);
  Sweep sweep;
  sweep.theta = table.values("theta", "rad");
  check_angles(table, sweep.theta);
  for (std::size_t k = 0; k < sweep.P_z.size(); ++k) {
    const std::string point = fmt::format("P_{}", k + 1);
    sweep.P_z[k] = table.values(point + "z", "px");
    if (table.find(point + "y") != nullptr) sweep.P_y[k] = table.values(point + "y", "px");
  }
  return sweep;
}

}  // namespace misfit
