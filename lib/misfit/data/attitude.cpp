#include "misfit/data/attitude.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "misfit/core/lists.h"
#include "misfit/core/table.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

struct AttitudeColumn {
  const char* name;
  const char* unit;  ///< in the file
  std::vector<double> Attitude::*values;
  bool required;  ///< of a file that somebody else wrote
};

constexpr std::array<AttitudeColumn, 16> attitude_columns = {{{"t", "s", &Attitude::t, true},
                                                              {"theta", "deg", &Attitude::theta, true},
                                                              {"psi", "deg", &Attitude::psi, true},
                                                              {"alpha", "deg", &Attitude::alpha, true},
                                                              {"beta", "deg", &Attitude::beta, true},
                                                              {"alpha_T", "deg", &Attitude::alpha_T, true},
                                                              {"phi", "deg", &Attitude::phi, true},
                                                              {"eta", "deg", &Attitude::eta, false},
                                                              {"theta_mean", "deg", &Attitude::theta_mean, false},
                                                              {"psi_mean", "deg", &Attitude::psi_mean, false},
                                                              {"theta_rate", "deg/s", &Attitude::theta_rate, false},
                                                              {"psi_rate", "deg/s", &Attitude::psi_rate, false},
                                                              {"sigma_theta", "deg", &Attitude::sigma_theta, false},
                                                              {"sigma_psi", "deg", &Attitude::sigma_psi, false},
                                                              {"sigma_alpha_T", "deg", &Attitude::sigma_alpha_T, false},
                                                              {"sigma_phi", "deg", &Attitude::sigma_phi, false}}};

}  // namespace

std::size_t samples_read(const Attitude& attitude) { return count_finite(attitude.eta); }

void write_attitude(const std::filesystem::path& path, const Attitude& attitude) {
  Table table;
  for (const AttitudeColumn& column : attitude_columns) {
    const double to_si = parse_unit(column.unit).to_si;
    std::vector<double> values = attitude.*column.values;
    values.resize(attitude.t.size(), std::numeric_limits<double>::quiet_NaN());
    for (double& v : values) v /= to_si;
    table.add(column.name, column.unit, std::move(values));
  }
  write_csv(path, table);
}

Attitude read_attitude(const std::filesystem::path& path) {
  const Table table = read_csv(path);
  Attitude attitude;
  for (const AttitudeColumn& column : attitude_columns) {
    std::vector<double>& to = attitude.*column.values;
    if (!column.required && table.find(column.name) == nullptr) {
      to.assign(table.rows(), std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    to = table.values(column.name, column.unit);
    const double to_si = parse_unit(column.unit).to_si;
    for (double& v : to) v *= to_si;
  }
  return attitude;
}

}  // namespace misfit
