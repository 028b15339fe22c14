#include "misfit/model/declared_parameter.h"

#include <algorithm>

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

std::string shown_unit(const std::string& unit, const SystemSpec& system) {
  if (unit_symbols(unit).empty()) return unit;
  return shown_unit_of_channel(unit, system);
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
