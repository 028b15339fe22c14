#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace misfit {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< [rad]

/// A unit as factor to SI and exponents of (m, kg, s, A, K, px). Angles are dimensionless: rad = 1, deg = pi/180; so are
/// "-", "", "%" (0.01) and "ppm" (1e-6). degC and degF have an offset where they stand alone: in a product ("W/degC") they are differences.
struct Unit {
  double to_si = 1.0;
  double offset = 0.0;                ///< SI value = to_si · value + offset
  std::array<double, 6> dimension{};  ///< may be broken: V^0.5
  bool angle = false;                 ///< rad or deg to the first power: kept only to choose the printed unit

  /// Exponents may differ by rounding.
  [[nodiscard]] bool same_dimension(const Unit& other) const;
};

/// Parses "kg m^2", "px/m", "N m", "deg/s", "1/s", "m/s^2", "in", "Pa", "V". Factors are separated by blank, '*', '·' or a hyphen ("N-m"),
/// a '/' divides by the ONE factor that follows it; powers stand after '^' (also negative or broken: "V^0.5", "V^(1/2)") or are digits
/// right behind the name ("m2", "m s-1"). Known: m mm cm um km in ft; l ml; kg g mg lb; s ms us ns min h d; Hz kHz MHz; mph knot; rad (or
/// radian) deg mrad rev rpm; N kN mN lbf; Pa kPa hPa MPa bar mbar psf psi; J kJ Wh kWh; W mW kW MW; A mA uA; V mV uV kV; Ohm; T mT uT; K
/// degC degF; px pix pixel; - % 1; with the signs of plain_unit(). Throws InputError naming the unknown part and the nearest known unit.
[[nodiscard]] Unit parse_unit(std::string_view text);

/// Signs as letters: "°" → "deg", "°C" → "degC", "µs" → "us", "Ω" → "Ohm", "²" → "^2", "⁻¹" → "^-1", in UTF-8 or Latin-1.
[[nodiscard]] std::string plain_unit(std::string_view text);

/// The same in SI: "deg/s" → "rad/s", "kPa" → "Pa", "rpm/V" → "rad/s/V", "degC" → "K". Throws as parse_unit().
[[nodiscard]] std::string unit_in_si(std::string_view text);

/// The factors of a unit as written, with their powers: "V^0.5/s" → (V, 0.5), (s, −1). "-" and "1" are left out. Throws as parse_unit().
[[nodiscard]] std::vector<std::pair<std::string, double>> unit_symbols(std::string_view text);

/// The unit of such factors as text, those with negative powers behind '/': "V^0.5/s"; "-" where none is left. Powers are rounded to 1e-6.
[[nodiscard]] std::string unit_text(const std::vector<std::pair<std::string, double>>& factors);

/// A number with its unit, as written by a user: "24 in" → 0.6096 with dimension m. A bare number has an empty unit. A temperature in degC
/// is refused: nothing says whether it is a difference.
struct Quantity {
  double value = 0.0;  ///< in SI if `unit` was given, as written otherwise
  std::string unit;    ///< as written; empty for a bare number
};
[[nodiscard]] Quantity parse_quantity(std::string_view text);

/// `value` given in unit `from`, expressed in unit `to`. Throws InputError if the dimensions differ.
[[nodiscard]] double convert(double value, std::string_view from, std::string_view to);
void convert(std::span<double> values, std::string_view from, std::string_view to);
/// The same for a difference of two values, a sigma or a step: one degC is one K.
[[nodiscard]] double convert_difference(double value, std::string_view from, std::string_view to);

/// The unit of a time derivative: "rad/s" → "rad/s^2", "V" → "V/s", "-" → "1/s"; of what is shown_in() another, shown in the rate of that.
[[nodiscard]] std::string rate_unit(std::string_view unit);

/// The inside unit of what is shown in `unit`: "rpm" → "radian/s (shown in rpm)", "kW" → "W (shown in kW)", "degC" → "K (shown in degC)";
/// what is SI already is itself. Every function here reads such a unit as the one before the parenthesis; a unit that is made of several
/// ("W (shown in kW)/K") is shown in SI. Throws as parse_unit().
[[nodiscard]] std::string shown_in(std::string_view unit);
/// The SI unit alone: "radian/s (shown in rpm)" → "rad/s", "radian" → "rad".
[[nodiscard]] std::string plain_si(std::string_view si);

/// The unit people like to read for a quantity whose inside unit is `si`: rad → deg, rad/s → deg/s, rad/s^2 → deg/s^2, and of what is
/// shown in radians radian → rad, radian/s → rad/s, radian/s^2 → rad/s^2; "W (shown in kW)" → "kW"; else itself. Of temperatures it is that
/// of their differences and sigmas, K: display_level_unit() is that of their values.
[[nodiscard]] std::string display_unit(std::string_view si);
/// The same for a value on its scale, where "K (shown in degC)" is degC.
[[nodiscard]] std::string display_level_unit(std::string_view si);
/// The other way: deg → rad, rad → radian, and their rates; kW → "W (shown in kW)"; else itself, as what is no unit (dB).
[[nodiscard]] std::string si_unit(std::string_view display);
/// As which an inside unit is stored beside numbers: display_unit(), but in full where that does not tell: of temperatures and of %.
[[nodiscard]] std::string stored_unit(std::string_view si);
/// rad → radian, rad/s → radian/s, rad/s^2 → radian/s^2: the inside unit of an angle, or of its rate, that is shown in radians; else
/// itself.
[[nodiscard]] std::string in_radians(std::string_view si);

}  // namespace misfit
