// How units are written and shown: what units.h says of display and of text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

constexpr std::string_view shown_begin = " (shown in ", shown_end = ")";

/// "W (shown in kW)" as "W" and "kW"; the second is empty where nothing is said of it, or of a part only.
std::pair<std::string_view, std::string_view> inside_and_shown(std::string_view unit) {
  const std::size_t at = unit.find(shown_begin);
  if (at == std::string_view::npos || !unit.ends_with(shown_end) || unit.find(shown_end, at) != unit.size() - 1) return {unit, {}};
  const std::size_t from = at + shown_begin.size();
  return {unit.substr(0, at), unit.substr(from, unit.size() - shown_end.size() - from)};
}

/// "W (shown in kW)/K" → "W/K".
std::string without_shown(std::string_view unit) {
  std::string out(unit);
  for (std::size_t at = out.find(shown_begin); at != std::string::npos; at = out.find(shown_begin, at)) {
    const std::size_t end = out.find(shown_end, at);
    if (end == std::string::npos) break;
    out.erase(at, end + shown_end.size() - at);
  }
  return out;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> displayed = {
    {{"rad", "deg"}, {"rad/s", "deg/s"}, {"rad/s^2", "deg/s^2"}, {"radian", "rad"}, {"radian/s", "rad/s"}, {"radian/s^2", "rad/s^2"}}};

/// A unit made of others, where only an angle and its rates are shown in one of two ways: "V/radian" is "V/rad".
std::string with_one_radian(std::string unit) {
  if (std::any_of(displayed.begin(), displayed.end(), [&](const auto& d) { return unit == d.first; })) return unit;
  constexpr std::string_view word = "radian";
  for (std::size_t at = unit.find(word); at != std::string::npos; at = unit.find(word, at)) unit.replace(at, word.size(), "rad");
  return unit;
}

}  // namespace

std::string in_radians(std::string_view si) {
  if (!si.starts_with("rad") || si.starts_with("radian")) return std::string(si);
  return with_one_radian("radian" + std::string(si.substr(3)));
}

std::string shown_in(std::string_view unit) {
  const Unit shown = parse_unit(unit);
  std::string inside = in_radians(unit_in_si(unit));
  if (shown.to_si == 1.0 && shown.offset == 0.0) return inside;
  return fmt::format("{}{}{}{}", inside, shown_begin, plain_unit(unit), shown_end);
}

std::string plain_si(std::string_view si) {
  std::string out = without_shown(si);
  constexpr std::string_view word = "radian";
  for (std::size_t at = out.find(word); at != std::string::npos; at = out.find(word, at)) out.replace(at, word.size(), "rad");
  return out;
}

std::string display_level_unit(std::string_view si) {
  const auto [inside, shown] = inside_and_shown(si);
  if (!shown.empty()) return std::string(shown);
  std::string plain = without_shown(si);
  for (const auto& [own, known] : displayed) {
    if (plain == own) return std::string(known);
  }
  return plain;
}

std::string display_unit(std::string_view si) {
  const auto [inside, shown] = inside_and_shown(si);
  return !shown.empty() && parse_unit(shown).offset != 0.0 ? display_level_unit(inside) : display_level_unit(si);
}

std::string stored_unit(std::string_view si) {
  const auto [inside, shown] = inside_and_shown(si);
  if (shown.empty()) return display_unit(si);
  const bool tells = parse_unit(shown).offset == 0.0 && !unit_symbols(inside).empty();  // by itself
  return tells ? std::string(shown) : std::string(si);
}

std::string si_unit(std::string_view display) {
  for (const auto& [own, shown] : displayed) {
    if (display == shown) return std::string(own);
  }
  if (display.find(shown_begin) != std::string_view::npos) return std::string(display);
  try {
    const auto symbols = unit_symbols(display);
    const bool in_degrees = std::any_of(symbols.begin(), symbols.end(), [](const auto& symbol) { return symbol.first == "deg"; });
    if (!in_degrees && !unit_symbols(unit_in_si(display)).empty() && parse_unit(display).to_si != 1.0) return shown_in(display);
  } catch (const InputError&) {
    return std::string(display);
  }
  return std::string(display);
}

std::string rate_unit(std::string_view unit) {
  if (const auto [inside, shown] = inside_and_shown(unit); !shown.empty()) {
    std::string inside_rate = rate_unit(inside);
    if (parse_unit(shown).offset != 0.0) return inside_rate;
    return fmt::format("{}{}{}{}", inside_rate, shown_begin, rate_unit(shown), shown_end);
  }
  if (unit.empty() || unit == "-") return "1/s";
  std::string out(unit);
  out += unit.ends_with("/s") ? "^2" : "/s";
  return with_one_radian(std::move(out));
}

std::string unit_text(const std::vector<std::pair<std::string, double>>& factors) {
  std::string above, below;
  for (const auto& [symbol, exponent] : factors) {
    const double size = std::round(1e6 * std::abs(exponent)) / 1e6;
    if (size == 0.0) continue;
    std::string& side = exponent > 0.0 ? above : below;
    if (exponent < 0.0) side += '/';
    if (exponent > 0.0 && !side.empty()) side += ' ';
    side += symbol;
    if (size != 1.0) side += fmt::format("^{}", size);
  }
  if (above.empty() && below.empty()) return "-";
  return with_one_radian((above.empty() ? "1" : above) + below);
}

}  // namespace misfit
