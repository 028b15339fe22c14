#pragma once

// How time runs in a recording: not for other files than recording.cpp.

#include <string>
#include <vector>

#include "misfit/recording/recording.h"

namespace misfit {

/// Stretches of rows in which time runs forward, and how evenly.
struct RecordingTime {
  std::vector<std::vector<std::size_t>> pieces;  ///< rows; those without a time of their own are left out
  double step = 0.0, jitter = 0.0;               ///< median interval and its robust scatter [s]
  std::vector<Gap> gaps;                         ///< intervals of more than 1.5 usual steps, in all pieces
  std::vector<std::string> remarks;              ///< what was left out, what is odd: one sentence each
};

/// Of times `t` [s], a value per row. `segments`: the number of its recording for each row, each of which has time of its own, also where
/// their rows alternate; empty: one. InputError naming `source` if no ten rows run forward.
[[nodiscard]] RecordingTime recording_time(const std::vector<double>& t, const std::vector<double>& segments, const std::string& source);

}  // namespace misfit
