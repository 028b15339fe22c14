#include "misfit/core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

using Dimension = std::array<double, 6>;  // exponents of m, kg, s, A, K, px

struct Known {
  const char* name;
  double to_si;
  Dimension dimension;
  bool angle = false;
};

constexpr Dimension none{};
constexpr Dimension length{1, 0, 0, 0, 0, 0};
constexpr Dimension mass{0, 1, 0, 0, 0, 0};
constexpr Dimension duration{0, 0, 1, 0, 0, 0};
constexpr Dimension force{1, 1, -2, 0, 0, 0};
constexpr Dimension pressure{-1, 1, -2, 0, 0, 0};
constexpr Dimension voltage{2, 1, -3, -1, 0, 0};
constexpr Dimension pixel{0, 0, 0, 0, 0, 1};

// The pound-force and what is built on it: exact products of 0.45359237 kg, 9.80665 m/s^2, 0.3048 m.
constexpr double pound = 0.45359237;
constexpr double pound_force = pound * 9.80665;
constexpr double foot = 0.3048;
constexpr double inch = 0.0254;

constexpr Known known_units[] = {
    {"m", 1.0, length},
    {"mm", 1e-3, length},
    {"cm", 1e-2, length},
    {"um", 1e-6, length},
    {"km", 1e3, length},
    {"in", inch, length},
    {"ft", foot, length},
    {"kg", 1.0, mass},
    {"g", 1e-3, mass},
    {"lb", pound, mass},
    {"s", 1.0, duration},
    {"ms", 1e-3, duration},
    {"us", 1e-6, duration},
    {"ns", 1e-9, duration},
    {"min", 60.0, duration},
    {"h", 3600.0, duration},
    {"Hz", 1.0, {0, 0, -1, 0, 0, 0}},
    {"rad", 1.0, none, true},
    {"rpm", std::numbers::pi / 30.0, {0, 0, -1, 0, 0, 0}, true},
    {"deg", std::numbers::pi / 180.0, none, true},
    {"N", 1.0, force},
    {"kN", 1e3, force},
    {"lbf", pound_force, force},
    {"Pa", 1.0, pressure},
    {"kPa", 1e3, pressure},
    {"hPa", 1e2, pressure},
    {"bar", 1e5, pressure},
    {"psf", pound_force / (foot * foot), pressure},
    {"psi", pound_force / (inch * inch), pressure},
    {"J", 1.0, {2, 1, -2, 0, 0, 0}},
    {"W", 1.0, {2, 1, -3, 0, 0, 0}},
    {"kW", 1e3, {2, 1, -3, 0, 0, 0}},
    {"A", 1.0, {0, 0, 0, 1, 0, 0}},
    {"mA", 1e-3, {0, 0, 0, 1, 0, 0}},
    {"mV", 1e-3, voltage},
    {"V", 1.0, voltage},
    {"kV", 1e3, voltage},
    {"Ohm", 1.0, {2, 1, -3, -2, 0, 0}},
    {"K", 1.0, {0, 0, 0, 0, 1, 0}},
    {"px", 1.0, pixel},
    {"pix", 1.0, pixel},
    {"pixel", 1.0, pixel},
    {"-", 1.0, none},
    {"%", 0.01, none},
    {"1", 1.0, none},
};

const Known& find_unit(std::string_view name, std::string_view whole) {
  const auto it = std::find_if(std::begin(known_units), std::end(known_units), [&](const Known& k) { return name == k.name; });
  if (it != std::end(known_units)) return *it;
  std::vector<std::string> names;
  for (const Known& k : known_units) names.emplace_back(k.name);
  const std::string inside = name == whole ? "" : " in '" + shown(whole) + "'";
  throw InputError("unknown unit '" + shown(name) + "'" + inside + suggest(name, names));
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads one unit from left to right: FACTOR { (blank | * | · | /) FACTOR }, FACTOR = NAME [^] [POWER].
class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : whole_(text), rest_(text) {}

  Unit read() {
    bool divide = false;
    bool expected = false;  // a factor must follow
    for (skip_blanks(); !rest_.empty(); skip_blanks()) {
      if (take("/")) {
        if (expected || !started_) refuse("'/' needs a unit on its left (write '1/s')");
        divide = expected = true;
      } else if (take("*") || take("·") || take("⋅")) {
        if (expected || !started_) refuse("a product sign needs a unit on both sides");
        expected = true;
      } else {
        factor(divide ? -1 : 1);
        divide = expected = false;
      }
    }
    if (expected) refuse("a unit is missing at the end");
    unit_.angle = angle_power_ == 1.0;
    return unit_;
  }

  std::vector<std::pair<std::string, double>> symbols() {
    read();
    return std::move(symbols_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError("unit '" + shown(whole_) + "': " + why); }

  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
  }

  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  std::string_view name() {
    std::size_t n = 0;
    while (n < rest_.size() && is_letter(rest_[n])) ++n;
    if (n == 0 && (rest_[0] == '-' || rest_[0] == '%' || rest_[0] == '1')) n = 1;
    if (n == 0) n = std::min(rest_.size(), rest_.find_first_of(" \t/*^"));  // something unknown: named as a whole
    if (n == 0) refuse("a unit is expected before '" + std::string(rest_) + "'");
    const std::string_view out = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return out;
  }

  /// A number after '^', perhaps a fraction in parentheses, or digits.
  double power() {
    if (!take("^")) return rest_.empty() || !is_digit(rest_.front()) ? 1.0 : number(true);
    if (!take("(")) return number(false);
    double value = number(false);
    if (take("/")) {
      const double below = number(false);
      if (below == 0.0) refuse("a power cannot be divided by 0");
      value /= below;
    }
    if (!take(")")) refuse("')' is missing after a power");
    return value;
  }

  double number(bool whole) {
    double value = 0.0;
    const char* last = rest_.data() + rest_.size();
    if (whole) last = rest_.data() + std::min(rest_.size(), rest_.find_first_not_of("0123456789"));
    const auto [end, error] = std::from_chars(rest_.data(), last, value, std::chars_format::fixed);
    constexpr double most = 12.0;
    if (error != std::errc() || !(std::abs(value) <= most)) refuse("a power must be a number from -12 to 12");
    rest_.remove_prefix(end - rest_.data());
    return value;
  }

  void factor(int sign) {
    const std::string_view symbol = name();
    const Known& known = find_unit(symbol, whole_);
    const double exponent = sign * power();
    if (symbol != "-" && symbol != "1") symbols_.emplace_back(symbol, exponent);
    unit_.to_si *= std::pow(known.to_si, exponent);
    for (std::size_t i = 0; i < unit_.dimension.size(); ++i) unit_.dimension[i] += exponent * known.dimension[i];
    if (known.angle) angle_power_ += exponent;
    started_ = true;
  }

  std::string_view whole_, rest_;
  Unit unit_;
  double angle_power_ = 0.0;
  std::vector<std::pair<std::string, double>> symbols_;
  bool started_ = false;
};

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

bool Unit::same_dimension(const Unit& other) const {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < dimension.size(); ++i) {
    if (std::abs(dimension[i] - other.dimension[i]) > rounding) return false;
  }
  return true;
}

std::vector<std::pair<std::string, double>> unit_symbols(std::string_view text) { return UnitReader(trim(text)).symbols(); }

Unit parse_unit(std::string_view text) { return UnitReader(trim(text)).read(); }

Quantity parse_quantity(std::string_view text) {
  std::string_view rest = trim(text);
  const std::string quoted = "'" + shown(text) + "'";
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error == std::errc::result_out_of_range) throw InputError(quoted + ": the number is out of range");
  if (error != std::errc()) throw InputError(quoted + " is not a number with a unit, as in '24 in'");
  if (!std::isfinite(value)) throw InputError(quoted + ": a finite number is needed");
  const std::string_view unit = trim(rest.substr(end - rest.data()));
  if (unit.empty()) return {value, ""};
  const Unit parsed = parse_unit(unit);
  return {value * parsed.to_si, std::string(unit)};
}

double convert(double value, std::string_view from, std::string_view to) {
  const Unit source = parse_unit(from);
  const Unit target = parse_unit(to);
  if (!source.same_dimension(target)) {
    throw InputError("unit '" + shown(from) + "' cannot be converted to '" + shown(to) + "': they measure different things");
  }
  if (source.to_si == target.to_si) return value;
  return value * (source.to_si / target.to_si);
}

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> displayed = {
    {{"rad", "deg"}, {"rad/s", "deg/s"}, {"rad/s^2", "deg/s^2"}}};

}  // namespace

std::string display_unit(std::string_view si) {
  for (const auto& [own, shown] : displayed) {
    if (si == own) return std::string(shown);
  }
  return std::string(si);
}

std::string si_unit(std::string_view display) {
  for (const auto& [own, shown] : displayed) {
    if (display == shown) return std::string(own);
  }
  return std::string(display);
}

std::string rate_unit(std::string_view unit) {
  if (unit.empty() || unit == "-") return "1/s";
  std::string out(unit);
  out += unit.ends_with("/s") ? "^2" : "/s";
  return out;
}

std::string unit_text(const std::vector<std::pair<std::string, double>>& factors) {
  std::string above, below;
  for (const auto& [symbol, power] : factors) {
    const double size = std::round(1e6 * std::abs(power)) / 1e6;
    if (size == 0.0) continue;
    std::string& side = power > 0.0 ? above : below;
    if (power < 0.0) side += '/';
    if (power > 0.0 && !side.empty()) side += ' ';
    side += symbol;
    if (size != 1.0) side += fmt::format("^{}", size);
  }
  if (above.empty() && below.empty()) return "-";
  return (above.empty() ? "1" : above) + below;
}

}  // namespace misfit
