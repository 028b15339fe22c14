#pragma once

#include "misfit/data/json_fields.h"
#include "misfit/data/motion.h"

namespace misfit {

// The key "simulated_motion" of compare.json:
// {"method","runs","failed","p_value","series":[{"experiment","series","unit","groups":[{"group","unit","p_value","statistics":[{"name","at",
// "measured","low","median","high","outside"}]}]}],"sentences","notes","seconds"}; angles in degrees, null for what is not known.

template <class Archive>
void fields(Archive& json, MaybeConst<MotionGroup> auto& g) {
  const double factor = json.factor("unit", g.unit);
  json("group", g.name), json("unit", DisplayUnit(g.unit)), json("p_value", g.p_value);
  const auto number_fields = [factor](auto& object, auto& n) {
    object("name", n.name), object("at", n.at), object("measured", Scaled(n.measured, factor));
    object("low", Scaled(n.low, factor)), object("median", Scaled(n.median, factor));
    object("high", Scaled(n.high, factor)), object("outside", n.outside);
  };
  json("statistics", Formed(g.numbers, number_fields));
}

template <class Archive>
void fields(Archive& json, MaybeConst<MotionSeries> auto& s) {
  json("experiment", s.experiment), json("series", s.name), json("unit", DisplayUnit(s.unit));
  json("groups", s.groups);
}

template <class Archive>
void fields(Archive& json, MaybeConst<SimulatedMotion> auto& m) {
  json("method", m.method), json("runs", m.runs), json("failed", m.failed), json("p_value", m.p_value);
  json("series", m.series), json("sentences", m.sentences), json("notes", m.notes), json("seconds", m.seconds);
}

}  // namespace misfit
