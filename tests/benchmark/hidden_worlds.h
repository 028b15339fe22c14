#pragma once

// Random worlds with a hidden effect, for the bench of discovery.

#include <map>
#include <string>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/data/signals.h"
#include "misfit/model/model.h"

namespace misfit::bench {

/// What is hidden in a world.
struct Hidden {
  std::string effect;                    ///< key of the effect that was simulated
  std::string known_as;                  ///< key that discovery should name; empty: no candidate has this form
  std::vector<std::string> quantities;   ///< any of which a verdict "depends on …" may name
  std::map<std::string, double> values;  ///< its coefficients
};

struct World {
  std::string kind;  ///< "null", "effect", "two", "unlisted"
  int number = 0;
  std::vector<Hidden> hidden;
  double strength = 0.0;  ///< of the first, in units of the size that drops by about 60 in 40 s
  std::vector<Signals> experiments;
  ModelRequest request;  ///< of the model without what is hidden; its curves still need knots
  Model truth;           ///< what was simulated
  double trim = 0.0;     ///< [rad]
  Calibration calibration;
  bool calibrated = false;  ///< hand the calibration to discovery
};

/// A flight of `seconds` at 59.94 Hz with gusts of 27 N m and 0.1 s, apex jitter of 0.7 to 1.3 px near 9 Hz and 0.5 px of white noise, from
/// a random state 5 s before the first sample. Trim 10.5 to 13.5 deg, slopes and damping varied by a fifth. `truth`: a registry with the
/// effects under hidden_effects/. The same (kind, number, seconds) give the same world.
[[nodiscard]] World draw_world(const std::string& kind, int number, double seconds, const Registry& truth);

}  // namespace misfit::bench
