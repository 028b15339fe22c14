#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/show/blocks.h"

namespace misfit {

/// A number on its way to a reader. The unit is required ("-" for a pure number); sigma 0 means "not estimated". Angles are given in
/// radians and shown in degrees.
struct Row {
  std::string what;
  double value;
  double sigma;
  std::string unit;
  std::optional<std::pair<double, double>> interval;  ///< 95 %, where it is not value ± 1.96 sigma

  /// InputError if the unit is empty or unknown (core/units.h).
  Row(std::string what_, double value_, double sigma_, std::string unit_);
  Row(std::string what_, const Estimate& e) : Row(std::move(what_), e.value, e.sigma, e.unit) { interval = e.interval; }

  /// "12.03 ± 0.21 deg", with the interval where there is one.
  [[nodiscard]] std::string shown() const;
};

/// One line per estimate, `before` and `after` around its name.
void add_rows(std::vector<Row>& rows, const std::string& before, const std::map<std::string, Estimate>& estimates,
              const std::string& after = "");

/// Columns: `what`, value.
[[nodiscard]] TableBlock rows_table(const std::string& what, const std::vector<Row>& rows);

/// Rows of several subjects side by side (methods, say): one line per `Row::what`, in order of first appearance, one column per subject.
struct Subject {
  std::string name;
  std::vector<Row> rows;
};
[[nodiscard]] TableBlock subjects_table(const std::string& what, const std::vector<Subject>& subjects);

/// In the place of what is not there.
inline constexpr const char* kMissing = "–";

/// An estimate in a table with others: "12.03 ± 0.21 deg".
[[nodiscard]] std::string shown(const Estimate& e);
/// For a sentence: without a sigma, to three significant digits.
[[nodiscard]] std::string briefly(const Estimate& e);
/// kMissing without a value, as the next two.
[[nodiscard]] std::string shown(const std::optional<Estimate>& e);

/// The strength of a random force, which its ports of one unit share.
struct ForceStrength {
  std::string port;  ///< "dw1/dt and dw2/dt": all of its unit, which share the strength
  Estimate strength;
};
/// One for each unit, in the order of their ports: without correlation times. Empty: there is no random force.
[[nodiscard]] std::vector<ForceStrength> force_strengths(const std::map<std::string, Estimate>& force);
/// That on ports of a unit; nullopt: there is none.
[[nodiscard]] std::optional<Estimate> strength_in(const std::vector<ForceStrength>& forces, const std::string& unit);
/// "20.0 ± 1.0 V/s"; of several with their ports: "20.0 ± 1.0 V/s on dw/dt, 3.0 ± 0.1 m/s^2 on dv/dt".
[[nodiscard]] std::string in_words(const std::vector<ForceStrength>& forces);

/// Whether the random force of a fit can be distinguished from 0.
[[nodiscard]] bool is_seen(const Fit& fit, const Estimate& force);
/// With one decimal and, for a change, its sign.
[[nodiscard]] std::string shown_drop(const std::optional<double>& value);
[[nodiscard]] std::string shown_gain(const std::optional<double>& value);

}  // namespace misfit
