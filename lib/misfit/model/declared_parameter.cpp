#include "misfit/model/declared_parameter.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/units.h"

namespace misfit::declared {

std::string read_unit(const config::Section& section) {
  const auto text = section.text("unit");
  if (!text) section.fail("unit", "the unit is missing, as unit = \"m/s\"; \"-\" if it has none");
  try {
    static_cast<void>(formula::measure_of(*text));
  } catch (const InputError& error) {
    section.fail("unit", error.what());
  }
  return *text;
}

namespace {

using Factors = std::vector<std::pair<std::string, double>>;

/// `of` to the power 1 or −1 if the factors have all of it, and no other power of its symbols: "m/s" of "K s/m" is −1; 0: they have not.
int power_in(const Factors& factors, const Factors& of) {
  for (const int power : {1, -1}) {
    const auto has = [&](const auto& symbol) {
      return std::any_of(factors.begin(), factors.end(), [&](const auto& f) {
        constexpr double rounding = 1e-9;
        return f.first == symbol.first && std::abs(f.second - power * symbol.second) < rounding;
      });
    };
    if (!of.empty() && std::all_of(of.begin(), of.end(), has)) return power;
  }
  return 0;
}

/// The factors with those of `inside` in its place shown in `shown`: "K/W" with "W", "kW" is "K/kW".
Factors replaced(Factors factors, const Factors& inside, const Factors& shown, int power) {
  for (const auto& [symbol, exponent] : inside) std::erase_if(factors, [&, name = symbol](const auto& f) { return f.first == name; });
  for (const auto& [symbol, exponent] : shown) {
    const auto same = std::find_if(factors.begin(), factors.end(), [&, name = symbol](const auto& f) { return f.first == name; });
    if (same != factors.end()) same->second += power * exponent;
    if (same == factors.end()) factors.emplace_back(symbol, power * exponent);
  }
  return factors;
}

/// A unit made of several, with those that the system has shown in others: "K s/m" for "m/s (shown in km/h)" is shown in "K h/km". Of
/// angles and temperatures nothing changes: what is per degree of an angle is given per radian, what is per degC is per K.
std::string shown_in_parts(const std::string& unit, const SystemSpec& system) {
  Factors factors = unit_symbols(unit);
  if (std::any_of(factors.begin(), factors.end(), [](const auto& f) { return f.first.starts_with("rad"); })) return unit;
  std::vector<std::string> wholes = system.shown_units;
  std::stable_sort(wholes.begin(), wholes.end(), [](const std::string& a, const std::string& b) {
    return unit_symbols(plain_si(a)).size() > unit_symbols(plain_si(b)).size();
  });
  bool any = false;
  for (const std::string& whole : wholes) {
    const std::string shown = display_level_unit(whole);
    const Factors inside = unit_symbols(plain_si(whole));
    const int power = parse_unit(shown).offset == 0.0 ? power_in(factors, inside) : 0;
    if (power != 0) factors = replaced(std::move(factors), inside, unit_symbols(shown), power);
    any = any || power != 0;
  }
  return any ? unit + " (shown in " + unit_text(factors) + ")" : unit;
}

}  // namespace

std::string shown_unit(const std::string& unit, const SystemSpec& system) {
  if (unit_symbols(unit).empty()) return unit;
  const std::string whole = shown_unit_of_channel(unit, system);
  return whole == unit ? shown_in_parts(unit, system) : whole;
}

std::string shown_unit_of_channel(const std::string& unit, const SystemSpec& system) {
  const auto same = [&](const std::string& inside) { return plain_si(inside) == unit; };
  const auto known = std::find_if(system.shown_units.begin(), system.shown_units.end(), same);
  if (known != system.shown_units.end()) return *known;
  return system.angles_in_radians ? in_radians(unit) : unit;
}

ParameterText read_parameter(const config::DescribedSection& section) {
  ParameterText p;
  p.unit = read_unit(section);
  p.measure = formula::measure_of(p.unit);
  p.doc = *section.text("doc");
  if (const auto bounds = section.numbers("bounds", p.unit)) {
    if (bounds->size() != 2 || !(bounds->front() < bounds->back())) section.fail("bounds", "must be [lower, upper], lower below upper");
    p.lower = bounds->front();
    p.upper = bounds->back();
  }
  p.value = section.value("value", p.unit);
  if (p.value && (*p.value < p.lower || *p.value > p.upper)) section.fail("value", "is outside its bounds");
  p.free = *section.flag("free");
  p.sigma = section.value("sigma", p.unit);
  p.scale = section.value("scale", p.unit);
  return p;
}

}  // namespace misfit::declared
