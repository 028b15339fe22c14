#pragma once

#include <string>

#include "misfit/track/locate.h"

namespace misfit {

/// Why a sample is not ok.
enum class Loss {
  none,
  not_found,    ///< nothing that looks like the marker where it can be
  outside,      ///< it leaves the frame: not all of it is in the picture
  covered,      ///< a part of it is hidden, or it is over something as bright or as dark
  other_look,   ///< of another size, contrast or shape
  vague,        ///< found, but not sharp enough to be placed within a pixel
  implausible,  ///< found where the motion before and after cannot have brought it
  no_frame,     ///< the file has no frame for this time
  copy          ///< the frame is a copy of the one before, while the marker moves
};
[[nodiscard]] std::string words(Loss loss);

/// What a marker looks like in this video, as learnt from its first fields.
struct Appearance {
  Marker marker;
  double explained = 1.0;         ///< typical share of the variance that the marker explains
  double explained_spread = 0.0;  ///< its robust standard deviation
  double noise = 0.0;             ///< typical RMS of what it does not explain [grey levels]
};

/// Bounds that a marker of this kind keeps whatever its video: levels of the right sign and enough contrast, hole and disc of possible
/// sizes.
[[nodiscard]] bool possible(const Location& found, MarkerKind kind);

/// Is it the marker? `contrast`: of the last good samples (levels[1]); it may drift, but not jump. When in doubt the answer is a loss.
[[nodiscard]] Loss judge(const Location& found, const Appearance& look, double contrast);

}  // namespace misfit
