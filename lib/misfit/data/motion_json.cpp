#include "misfit/data/motion_json.h"

#include "misfit/core/units.h"

namespace misfit {
namespace {

std::string si_of(const std::string& unit) {
  if (unit == "deg") return "rad";
  return unit == "deg/s" ? "rad/s" : unit;
}

Json to_json(const MotionNumber& n, double factor) {
  return {{"name", n.name},
          {"at", number_or_null(n.at)},
          {"measured", number_or_null(n.measured * factor)},
          {"low", number_or_null(n.low * factor)},
          {"median", number_or_null(n.median * factor)},
          {"high", number_or_null(n.high * factor)},
          {"outside", n.outside}};
}

MotionNumber number_from(const Json& object, double factor) {
  return {object.at("name"),
          number_or_nan(object, "at"),
          factor * number_or_nan(object, "measured"),
          factor * number_or_nan(object, "low"),
          factor * number_or_nan(object, "median"),
          factor * number_or_nan(object, "high"),
          object.at("outside")};
}

Json to_json(const MotionGroup& g) {
  const std::string unit = display_unit(g.unit);
  const double factor = unit == g.unit ? 1.0 : convert(1.0, g.unit, unit);  // decibels are no unit of ours
  Json numbers = Json::array();
  for (const MotionNumber& n : g.numbers) numbers.push_back(to_json(n, factor));
  return {{"group", g.name}, {"unit", unit}, {"p_value", number_or_null(g.p_value)}, {"statistics", numbers}};
}

MotionGroup group_from(const Json& object) {
  const std::string unit = object.at("unit");
  MotionGroup g{object.at("group"), si_of(unit), {}, number_or_nan(object, "p_value")};
  const double factor = unit == g.unit ? 1.0 : convert(1.0, unit, g.unit);
  for (const Json& n : object.at("statistics")) g.numbers.push_back(number_from(n, factor));
  return g;
}

}  // namespace

Json motion_to_json(const SimulatedMotion& motion) {
  Json series = Json::array();
  for (const MotionSeries& s : motion.series) {
    Json groups = Json::array();
    for (const MotionGroup& g : s.groups) groups.push_back(to_json(g));
    series.push_back({{"experiment", s.experiment}, {"series", s.name}, {"unit", display_unit(s.unit)}, {"groups", groups}});
  }
  return {
      {"method", motion.method}, {"runs", motion.runs},           {"failed", motion.failed}, {"p_value", number_or_null(motion.p_value)},
      {"series", series},        {"sentences", motion.sentences}, {"notes", motion.notes},   {"seconds", number_or_null(motion.seconds)}};
}

SimulatedMotion motion_from_json(const Json& object) {
  SimulatedMotion motion;
  motion.method = object.at("method");
  motion.runs = object.at("runs");
  motion.failed = object.at("failed");
  motion.p_value = number_or_nan(object, "p_value");
  for (const Json& s : object.at("series")) {
    motion.series.push_back({s.at("experiment"), s.at("series"), si_of(s.at("unit")), {}});
    for (const Json& g : s.at("groups")) motion.series.back().groups.push_back(group_from(g));
  }
  motion.sentences = object.at("sentences").get<std::vector<std::string>>();
  motion.notes = object.at("notes").get<std::vector<std::string>>();
  motion.seconds = number_or_nan(object, "seconds");
  return motion;
}

}  // namespace misfit
