#pragma once

#include "misfit/data/json_number.h"
#include "misfit/data/motion.h"

namespace misfit {

/// The key "simulated_motion" of compare.json:
/// {"method","runs","failed","p_value","series":[{"experiment","series","unit","groups":[{"group","unit",
/// "p_value","statistics":[{"name","at","measured","low","median","high","outside"}]}]}],"sentences","notes","seconds"}; angles in degrees,
/// null for what is not known.
[[nodiscard]] Json motion_to_json(const SimulatedMotion& motion);
[[nodiscard]] SimulatedMotion motion_from_json(const Json& object);

}  // namespace misfit
