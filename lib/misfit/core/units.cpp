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
  const char* si = nullptr;  ///< the same in SI, where it is not itself
  double offset = 0.0;       ///< of a temperature [K]
};

constexpr Dimension no_dimension{};
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

constexpr Dimension rate{0, 0, -1, 0, 0, 0};
constexpr Dimension power{2, 1, -3, 0, 0, 0};
constexpr Dimension energy{2, 1, -2, 0, 0, 0};
constexpr Dimension current{0, 0, 0, 1, 0, 0};
constexpr Dimension temperature{0, 0, 0, 0, 1, 0};
constexpr Dimension inductance{2, 1, -2, -2, 0, 0};
constexpr Dimension capacitance{-2, -1, 4, 2, 0, 0};
constexpr Dimension flux_density{0, 1, -2, -1, 0, 0};
constexpr Dimension volume{3, 0, 0, 0, 0, 0};
constexpr Dimension speed{1, 0, -1, 0, 0, 0};
constexpr double turn = 2.0 * std::numbers::pi;
constexpr double celsius = 273.15;
constexpr double rankine = 5.0 / 9.0;  // a degree of Fahrenheit [K]

constexpr Known known_units[] = {
    {"m", 1.0, length},
    {"mm", 1e-3, length, false, "m"},
    {"cm", 1e-2, length, false, "m"},
    {"dm", 1e-1, length, false, "m"},
    {"um", 1e-6, length, false, "m"},
    {"nm", 1e-9, length, false, "m"},
    {"km", 1e3, length, false, "m"},
    {"in", inch, length, false, "m"},
    {"ft", foot, length, false, "m"},
    {"l", 1e-3, volume, false, "m^3"},
    {"L", 1e-3, volume, false, "m^3"},
    {"dl", 1e-4, volume, false, "m^3"},
    {"dL", 1e-4, volume, false, "m^3"},
    {"ml", 1e-6, volume, false, "m^3"},
    {"mL", 1e-6, volume, false, "m^3"},
    {"ul", 1e-9, volume, false, "m^3"},
    {"uL", 1e-9, volume, false, "m^3"},
    {"kg", 1.0, mass},
    {"g", 1e-3, mass, false, "kg"},
    {"mg", 1e-6, mass, false, "kg"},
    {"ug", 1e-9, mass, false, "kg"},
    {"ng", 1e-12, mass, false, "kg"},
    {"lb", pound, mass, false, "kg"},
    {"s", 1.0, duration},
    {"ms", 1e-3, duration, false, "s"},
    {"us", 1e-6, duration, false, "s"},
    {"ns", 1e-9, duration, false, "s"},
    {"min", 60.0, duration, false, "s"},
    {"h", 3600.0, duration, false, "s"},
    {"d", 86400.0, duration, false, "s"},
    {"Hz", 1.0, rate},
    {"kHz", 1e3, rate, false, "Hz"},
    {"MHz", 1e6, rate, false, "Hz"},
    {"mph", 1609.344 / 3600.0, speed, false, "m/s"},
    {"knot", 1852.0 / 3600.0, speed, false, "m/s"},
    {"rad", 1.0, no_dimension, true},
    {"radian", 1.0, no_dimension, true},
    {"deg", std::numbers::pi / 180.0, no_dimension, true, "rad"},
    {"mrad", 1e-3, no_dimension, true, "rad"},
    {"rev", turn, no_dimension, true, "rad"},
    {"rpm", turn / 60.0, rate, true, "rad/s"},
    {"N", 1.0, force},
    {"kN", 1e3, force, false, "N"},
    {"MN", 1e6, force, false, "N"},
    {"mN", 1e-3, force, false, "N"},
    {"lbf", pound_force, force, false, "N"},
    {"Pa", 1.0, pressure},
    {"kPa", 1e3, pressure, false, "Pa"},
    {"hPa", 1e2, pressure, false, "Pa"},
    {"MPa", 1e6, pressure, false, "Pa"},
    {"GPa", 1e9, pressure, false, "Pa"},
    {"bar", 1e5, pressure, false, "Pa"},
    {"mbar", 1e2, pressure, false, "Pa"},
    {"psf", pound_force / (foot * foot), pressure, false, "Pa"},
    {"psi", pound_force / (inch * inch), pressure, false, "Pa"},
    {"J", 1.0, energy},
    {"kJ", 1e3, energy, false, "J"},
    {"MJ", 1e6, energy, false, "J"},
    {"Wh", 3600.0, energy, false, "J"},
    {"kWh", 3.6e6, energy, false, "J"},
    {"W", 1.0, power},
    {"mW", 1e-3, power, false, "W"},
    {"kW", 1e3, power, false, "W"},
    {"MW", 1e6, power, false, "W"},
    {"A", 1.0, current},
    {"mA", 1e-3, current, false, "A"},
    {"uA", 1e-6, current, false, "A"},
    {"nA", 1e-9, current, false, "A"},
    {"mV", 1e-3, voltage, false, "V"},
    {"V", 1.0, voltage},
    {"uV", 1e-6, voltage, false, "V"},
    {"kV", 1e3, voltage, false, "V"},
    {"Ohm", 1.0, {2, 1, -3, -2, 0, 0}},
    {"ohm", 1.0, {2, 1, -3, -2, 0, 0}, false, "Ohm"},
    {"kOhm", 1e3, {2, 1, -3, -2, 0, 0}, false, "Ohm"},
    {"mOhm", 1e-3, {2, 1, -3, -2, 0, 0}, false, "Ohm"},
    {"F", 1.0, capacitance},
    {"mF", 1e-3, capacitance, false, "F"},
    {"uF", 1e-6, capacitance, false, "F"},
    {"nF", 1e-9, capacitance, false, "F"},
    {"H", 1.0, inductance},
    {"mH", 1e-3, inductance, false, "H"},
    {"uH", 1e-6, inductance, false, "H"},
    {"T", 1.0, flux_density},
    {"mT", 1e-3, flux_density, false, "T"},
    {"uT", 1e-6, flux_density, false, "T"},
    {"K", 1.0, temperature},
    {"degC", 1.0, temperature, false, "K", celsius},
    {"degF", rankine, temperature, false, "K", celsius - 32.0 * rankine},
    {"mol", 1.0, no_dimension},  // a count: balances of substances need no dimension of their own
    {"mmol", 1e-3, no_dimension, false, "mol"},
    {"umol", 1e-6, no_dimension, false, "mol"},
    {"kmol", 1e3, no_dimension, false, "mol"},
    {"U", 1.0, no_dimension},  // of an enzyme or a hormone: what acts as one unit of it
    {"mU", 1e-3, no_dimension, false, "U"},
    {"uU", 1e-6, no_dimension, false, "U"},
    {"px", 1.0, pixel},
    {"pix", 1.0, pixel},
    {"pixel", 1.0, pixel},
    {"-", 1.0, no_dimension},
    {"%", 0.01, no_dimension, false, "-"},
    {"ppm", 1e-6, no_dimension, false, "-"},
    {"1", 1.0, no_dimension},
};

/// Of what people write for a unit that has another name here.
std::string hint_for(std::string_view name, const std::vector<std::string>& names) {
  if (name == "C") return " — degC is of temperatures, A s of charges";
  if (name == "Ah" || name == "mAh") return " — a charge: A h";
  if (name.find_first_of("()[]") != std::string_view::npos)
    return " — units have no brackets: what is below a fraction bar stands behind a / of its own, as V/A/s";
  return suggest(name, names);
}

const Known& find_unit(std::string_view name, std::string_view whole) {
  const auto it = std::find_if(std::begin(known_units), std::end(known_units), [&](const Known& k) { return name == k.name; });
  if (it != std::end(known_units)) return *it;
  std::vector<std::string> names;
  for (const Known& k : known_units) names.emplace_back(k.name);
  const std::string inside = name == whole ? "" : " in '" + shown(whole) + "'";
  throw InputError("unknown unit '" + shown(name) + "'" + inside + hint_for(name, names));
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads one unit from left to right: FACTOR { (blank | * | · | - | /) FACTOR }, FACTOR = NAME [^] [POWER].
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
    if (factors_ != 1 || power_of_last_ != 1.0) unit_.offset = 0.0;  // per degree: of differences
    unit_.angle = angle_power_ == 1.0;
    return unit_;
  }

  std::vector<std::pair<std::string, double>> symbols() {
    read();
    return std::move(symbols_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError("unit '" + shown(whole_) + "': " + why); }

  /// And "(shown in kW)", which is of no matter to what a unit is.
  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
    constexpr std::string_view shown = "(shown in ";
    if (const std::size_t end = rest_.find(')'); rest_.starts_with(shown) && end != std::string_view::npos) {
      rest_.remove_prefix(end + 1);
      skip_blanks();
    }
  }

  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  std::string_view name() {
    std::size_t n = 0;
    while (n < rest_.size() && is_letter(rest_[n])) ++n;
    if (rest_.front() == '-' && power_follows()) refuse("a negative power stands right behind its unit, as in 's-1' or 's^-1'");
    if (n == 0 && (rest_[0] == '-' || rest_[0] == '%' || rest_[0] == '1')) n = 1;
    if (n == 0) n = std::min(rest_.size(), rest_.find_first_of(" \t/*^"));  // something unknown: named as a whole
    if (n == 0) refuse("a unit is expected before '" + std::string(rest_) + "'");
    const std::string_view out = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return out;
  }

  /// "2" or "-2" without '^'. Another '-' is a hyphen: "N-m".
  [[nodiscard]] bool power_follows() const {
    const std::size_t sign = rest_.starts_with('-') ? 1 : 0;
    return rest_.size() > sign && is_digit(rest_[sign]);
  }

  /// A number after '^', perhaps a fraction in parentheses, or digits.
  double power() {
    if (!take("^")) return power_follows() ? number(true) : 1.0;
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
    if (whole) last = rest_.data() + std::min(rest_.size(), rest_.find_first_not_of("0123456789", 1));
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
    unit_.offset = known.offset;
    power_of_last_ = exponent;
    ++factors_;
    started_ = true;
  }

  std::string_view whole_, rest_;
  Unit unit_;
  double angle_power_ = 0.0, power_of_last_ = 0.0;
  int factors_ = 0;
  std::vector<std::pair<std::string, double>> symbols_;
  bool started_ = false;
};

std::string_view without_blanks(std::string_view text) {
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

std::string plain_unit(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> signs = {{{"°", "deg"},
                                                                                           {"℃", "degC"},
                                                                                           {"℉", "degF"},
                                                                                           {"µ", "u"},
                                                                                           {"μ", "u"},
                                                                                           {"Ω", "Ohm"},
                                                                                           {"²", "^2"},
                                                                                           {"³", "^3"},
                                                                                           {"⁻¹", "^-1"},
                                                                                           {"⁻²", "^-2"},
                                                                                           {"⁻³", "^-3"},
                                                                                           {"−", "-"},
                                                                                           {"U/min", "rpm"}}};
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 4> latin = {
      {{"\xB0", "deg"}, {"\xB5", "u"}, {"\xB2", "^2"}, {"\xB3", "^3"}}};
  std::string out;
  const auto take = [&](const auto& table) {
    const auto sign = std::find_if(table.begin(), table.end(), [&](const auto& s) { return text.starts_with(s.first); });
    if (sign == table.end()) return false;
    out += sign->second;
    text.remove_prefix(sign->first.size());
    return true;
  };
  bool inside = false;  // bytes of another character of UTF-8 are not those of Latin-1
  while (!text.empty()) {
    if (take(signs) || (!inside && take(latin))) continue;
    inside = static_cast<unsigned char>(text.front()) >= 0x80U;
    out += text.front();
    text.remove_prefix(1);
  }
  return out;
}

std::vector<std::pair<std::string, double>> unit_symbols(std::string_view text) {
  const std::string plain = plain_unit(without_blanks(text));
  return UnitReader(plain).symbols();
}

Unit parse_unit(std::string_view text) {
  const std::string plain = plain_unit(without_blanks(text));
  return UnitReader(plain).read();
}

std::string unit_in_si(std::string_view text) {
  const auto known = [](const std::string& symbol) {
    return std::find_if(std::begin(known_units), std::end(known_units), [&](const Known& k) { return symbol == k.name; });
  };
  std::vector<std::pair<std::string, double>> out;
  const auto add = [&](const std::string& symbol, double exponent) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const auto& factor) { return factor.first == symbol; });
    if (same != out.end()) same->second += exponent;
    if (same == out.end()) out.emplace_back(symbol, exponent);
  };
  for (const auto& [symbol, exponent] : unit_symbols(text)) {
    const char* si = known(symbol)->si;
    if (si == nullptr) add(symbol, exponent);
    for (const auto& [own, inner] : si == nullptr ? std::vector<std::pair<std::string, double>>{} : unit_symbols(si))
      add(own, inner * exponent);
  }
  return unit_text(out);
}

Quantity parse_quantity(std::string_view text) {
  std::string_view rest = without_blanks(text);
  const std::string quoted = "'" + shown(text) + "'";
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error == std::errc::result_out_of_range) throw InputError(quoted + ": the number is out of range");
  if (error != std::errc()) throw InputError(quoted + " is not a number with a unit, as in '24 in'");
  if (!std::isfinite(value)) throw InputError(quoted + ": a finite number is needed");
  const std::string_view unit = without_blanks(rest.substr(end - rest.data()));
  if (unit.empty()) return {value, ""};
  const Unit parsed = parse_unit(unit);
  if (parsed.offset != 0.0)
    throw InputError(fmt::format("{}: write it in K: {:.10g} K, or, if it is a difference, {:.10g} K", quoted,
                                 value * parsed.to_si + parsed.offset, value * parsed.to_si));
  return {value * parsed.to_si, std::string(unit)};
}

namespace {

std::pair<Unit, Unit> convertible(std::string_view from, std::string_view to) {
  const Unit source = parse_unit(from);
  const Unit target = parse_unit(to);
  if (!source.same_dimension(target)) {
    throw InputError("unit '" + shown(plain_si(from)) + "' cannot be converted to '" + shown(plain_si(to)) +
                     "': they measure different things");
  }
  return {source, target};
}

}  // namespace

double convert(double value, std::string_view from, std::string_view to) {
  convert(std::span(&value, 1), from, to);
  return value;
}

void convert(std::span<double> values, std::string_view from, std::string_view to) {
  const auto [source, target] = convertible(from, to);
  if (source.to_si == target.to_si && source.offset == target.offset) return;
  const double factor = source.to_si / target.to_si, inverse = target.to_si / source.to_si;
  const double shift = (source.offset - target.offset) / target.to_si;
  const bool whole = inverse > 1.0 && inverse == std::round(inverse);  // 3 ms is 3/1000 s, which 3 times a rounded 0.001 may not be
  for (double& value : values) value = (whole ? value / inverse : factor * value) + shift;
}

double convert_difference(double value, std::string_view from, std::string_view to) {
  const auto [source, target] = convertible(from, to);
  return source.to_si == target.to_si ? value : value * (source.to_si / target.to_si);
}

}  // namespace misfit
