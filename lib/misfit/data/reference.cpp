#include "misfit/data/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/table.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/math/stable_zero.h"

namespace misfit {
namespace {

WeightedPoints read_points(const Table& table, const Column& value, const std::string& of_unit, const std::string& unit) {
  const Column& argument = table.columns.front();
  const Column* sigma = table.find("sigma");
  const std::vector<double> x = table.values(argument.name, of_unit);
  const std::vector<double> v = table.values(value.name, unit);
  const std::vector<double> s = sigma != nullptr ? table.values("sigma", unit) : std::vector<double>(x.size(), 0.0);
  WeightedPoints points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(v[i])) continue;
    if (sigma != nullptr && !(s[i] > 0.0)) {
      const int line = i < table.line.size() ? table.line[i] : 0;
      throw InputError(Source{table.source, line, 0}, fmt::format("sigma is {}: must be positive", s[i]));
    }
    points.add(x[i], v[i], s[i]);
  }
  return points;
}

}  // namespace

Reference read_reference(const std::filesystem::path& path, const std::string& curve, const std::string& static_curve,
                         const FoldedAngle& folded_angle) {
  const Table table = read_csv(path);
  const Column& argument = table.columns.front();
  const Column& value = table.at(curve);
  const bool angle = !folded_angle.name.empty() && (argument.name == folded_angle.name || argument.name == folded_angle.signed_name);
  const bool even = std::find(folded_angle.even_curves.begin(), folded_angle.even_curves.end(), curve) != folded_angle.even_curves.end();
  Reference reference;
  reference.name = path.stem().string();
  reference.curve = curve;
  reference.of = angle ? folded_angle.name : argument.name;
  const bool radians = angle || parse_unit(argument.unit).angle;
  reference.of_unit = radians ? "rad" : argument.unit;
  reference.unit = value.unit.empty() ? "-" : value.unit;
  WeightedPoints points = read_points(table, value, reference.of_unit, reference.unit);
  if (points.x.empty()) throw InputError(Source{path.string(), 0, 0}, "no row has both " + argument.header() + " and " + value.header());
  int folded = 0;
  for (std::size_t i = 0; angle && i < points.x.size(); ++i) {
    if (points.x[i] >= 0.0) continue;
    points.x[i] = -points.x[i];
    if (!even) points.value[i] = -points.value[i];
    ++folded;
  }
  if (folded > 0) {
    reference.notes.push_back(fmt::format("{}: {} at negative {} folded to {} by symmetry ({} is {})", reference.name,
                                          counted(static_cast<std::size_t>(folded), "point", "points"), argument.name, folded_angle.name,
                                          curve, even ? "even" : "odd"));
  }
  points = sorted(points);
  reference.x = points.x;
  reference.value = points.value;
  reference.sigma = points.sigma;
  if (curve == static_curve && angle) {
    const bool has_sigmas = table.find("sigma") != nullptr;  // else what is left over of a parabola through a truth says nothing of it
    if (const auto zero = stable_zero(points)) reference.trim = Estimate{zero->x, has_sigmas ? zero->sigma : 0.0, reference.of_unit};
  }
  return reference;
}

}  // namespace misfit
