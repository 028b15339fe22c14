#pragma once

#include <string>
#include <utility>
#include <vector>

namespace misfit {

struct Table;

/// Which header holds which signal (name → header); names absent from the map are looked for under their own name.
struct ColumnMap {
  std::vector<std::pair<std::string, std::string>> header_of;

  [[nodiscard]] std::string header(const std::string& name) const;

  /// The signal's values in `unit`. A column that the map names and that has no [unit] is read in the one that its name ends with, as
  /// misfit init reads it ("theta_deg", "t_ms", "angle (deg)"), if that is a unit of the signal; else its values are taken as they are.
  /// Either is said in `notes`, but where nothing was converted. InputError as Table::values().
  [[nodiscard]] std::vector<double> values(const Table& table, const std::string& name, const std::string& unit,
                                           std::vector<std::string>& notes) const;
};

}  // namespace misfit
