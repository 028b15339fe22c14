#include "misfit/show/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/units.h"

namespace misfit {
Row::Row(std::string what_, double value_, double sigma_, std::string unit_)
    : what(std::move(what_)), value(value_), sigma(sigma_), unit(std::move(unit_)) {
  if (unit.empty()) throw InputError("'" + what + "' has no unit: a number without unit is not shown ('-' for a pure number)");
  static_cast<void>(parse_unit(unit));
}

std::string Row::shown() const {
  const std::string text = in_display_unit(value, unit, sigma);
  return interval ? text + " (95 %: " + interval_in_display_unit(interval->first, interval->second, unit, sigma) + ")" : text;
}

void add_rows(std::vector<Row>& rows, const std::string& before, const std::map<std::string, Estimate>& estimates,
              const std::string& after) {
  for (const auto& [name, estimate] : estimates) rows.emplace_back(before + name + after, estimate);
}

TableBlock rows_table(const std::string& what, const std::vector<Row>& rows) {
  TableBlock table{{{what}, {"value"}}, {}};
  for (const Row& row : rows) table.rows.push_back({row.what, row.shown()});
  return table;
}

TableBlock subjects_table(const std::string& what, const std::vector<Subject>& subjects) {
  TableBlock table{{{what}}, {}};
  for (const Subject& subject : subjects) {
    table.columns.push_back({subject.name});
    for (auto& line : table.rows) line.emplace_back(kMissing);
    for (const Row& row : subject.rows) {
      auto line = std::find_if(table.rows.begin(), table.rows.end(), [&](const auto& other) { return other.front() == row.what; });
      if (line == table.rows.end()) {
        line = table.rows.insert(line, std::vector<std::string>(table.columns.size(), kMissing));
        line->front() = row.what;
      }
      line->back() = row.shown();
    }
  }
  return table;
}

std::string shown(const Estimate& e) { return in_display_unit(e.value, e.unit, e.sigma); }

std::string briefly(const Estimate& e) {
  return e.sigma > 0.0 ? shown(e) : with_display_unit(fmt::format("{:.3g}", display_value(e.value, e.unit)), e.unit);
}

std::string shown(const std::optional<Estimate>& e) { return e ? shown(*e) : kMissing; }

namespace {

bool is_alike(const ForceStrength& force, const std::string& unit) {
  return parse_unit(force.strength.unit).same_dimension(parse_unit(unit));
}

}  // namespace

std::vector<ForceStrength> force_strengths(const std::map<std::string, Estimate>& force) {
  std::vector<ForceStrength> out;
  for (const auto& [port, e] : force) {
    if (e.unit == "s") continue;
    const auto same =
        std::find_if(out.begin(), out.end(), [&, &strength = e](const ForceStrength& f) { return is_alike(f, strength.unit); });
    if (same == out.end()) {
      out.push_back({port, e});
    } else {
      same->port += " and " + port;
    }
  }
  return out;
}

std::optional<Estimate> strength_in(const std::vector<ForceStrength>& forces, const std::string& unit) {
  const auto found = std::find_if(forces.begin(), forces.end(), [&](const ForceStrength& f) { return is_alike(f, unit); });
  return found == forces.end() ? std::nullopt : std::optional(found->strength);
}

std::string in_words(const std::vector<ForceStrength>& forces) {
  std::string out;
  for (const ForceStrength& f : forces) out += (out.empty() ? "" : ", ") + shown(f.strength) + (forces.size() > 1 ? " on " + f.port : "");
  return out;
}

bool is_seen(const Fit& fit, const Estimate& force) { return fit.driven || force.sigma > 0.0; }

std::string shown_drop(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.1f}", *value) : kMissing;
}

std::string shown_gain(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return kMissing;
  constexpr double shown_as_zero = 0.05;
  return std::abs(*value) < shown_as_zero ? "0.0" : fmt::format("{:+.1f}", *value);
}

}  // namespace misfit
