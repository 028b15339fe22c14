#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit::report {

/// A number on its way into a report: the only way in. The unit is required ("-" for a pure number); sigma 0 means "not estimated".
/// Angles are given in radians and shown in degrees.
struct Row {
  std::string what;
  double value;
  double sigma;
  std::string unit;
  std::optional<std::pair<double, double>> interval;  ///< 95 %, where it is not value ± 1.96 sigma; only shown in rows_html

  /// InputError if the unit is empty or unknown (core/units.h).
  Row(std::string what_, double value_, double sigma_, std::string unit_);
  Row(std::string what_, const Estimate& e) : Row(std::move(what_), e.value, e.sigma, e.unit) { interval = e.interval; }

  [[nodiscard]] std::string shown_unit() const;    ///< deg for rad, otherwise the unit
  [[nodiscard]] std::string shown_number() const;  ///< "12.03 ± 0.21", in shown_unit()
  [[nodiscard]] double in_shown_unit(double number) const;
};

/// Aligned columns for a terminal: what, value, unit.
[[nodiscard]] std::string rows_text(const std::vector<Row>& rows);
/// `what,value,sigma,unit`, value and sigma in the unit shown, empty when not known. Written atomically.
void write_rows_csv(const std::filesystem::path& path, const std::vector<Row>& rows);
/// An HTML table.
[[nodiscard]] std::string rows_html(const std::vector<Row>& rows);

/// Rows of several subjects side by side (methods, say): one line per `what`, in order of first appearance, one column per subject.
struct Subject {
  std::string name;
  std::vector<Row> rows;
};
[[nodiscard]] std::string subjects_html(const std::vector<Subject>& subjects);
[[nodiscard]] std::string subjects_text(const std::vector<Subject>& subjects);

}  // namespace misfit::report
