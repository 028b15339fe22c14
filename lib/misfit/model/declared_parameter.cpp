#include "misfit/model/declared_parameter.h"

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

ParameterText read_parameter(const config::Section& section) {
  ParameterText p;
  p.unit = read_unit(section);
  p.measure = formula::measure_of(p.unit);
  p.doc = section.text("doc").value_or("");
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto n = section.number(key, p.unit);
    return n ? std::optional<double>(n->value) : std::nullopt;
  };
  if (const auto bounds = section.numbers("bounds", p.unit)) {
    if (bounds->size() != 2 || !(bounds->front() < bounds->back())) section.fail("bounds", "must be [lower, upper], lower below upper");
    p.lower = bounds->front();
    p.upper = bounds->back();
  }
  p.value = number("value");
  if (p.value && (*p.value < p.lower || *p.value > p.upper)) section.fail("value", "is outside its bounds");
  p.free = section.flag("free");
  p.sigma = number("sigma");
  p.scale = number("scale");
  if (p.sigma && !(*p.sigma > 0.0)) section.fail("sigma", "must be positive");
  if (p.scale && !(*p.scale > 0.0)) section.fail("scale", "must be positive");
  return p;
}

}  // namespace misfit::declared
