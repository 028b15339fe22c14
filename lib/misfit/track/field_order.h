#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/image.h"

namespace misfit {

/// Which lines of a frame were exposed when.
enum class FieldOrder {
  unknown,
  progressive,  ///< all lines at once
  top_first,    ///< even rows (0, 2, …) first, odd rows half a frame later
  bottom_first
};
[[nodiscard]] std::string words(FieldOrder order);

/// Where one marker is in the even and in the odd rows of a frame.
struct FieldPair {
  long frame = 0;
  std::optional<PixelPoint> even, odd;
};

/// What the motion of a marker says about the fields.
struct FieldEvidence {
  FieldOrder order = FieldOrder::unknown;
  bool decisive = false;  ///< beyond doubt
  std::size_t pairs = 0;  ///< frames followed by the next one, both with the marker in both fields
  double motion = 0.0;    ///< mean distance per frame [px]
  double combing = 0.0;   ///< mean distance between the fields of a frame, over `motion`: 0 progressive, 0.5 interlaced
  double asymmetry =
      0.0;  ///< (mean |even_n − odd_n+1| − mean |odd_n − even_n+1|) / their sum: 0.5 top first, −0.5 bottom first, 0 progressive
  [[nodiscard]] std::string text() const;
};

/// Continuity of motion: neighbours in time lie near each other. With the even rows first, the odd rows of frame n and the even rows of
/// frame n+1 are one field apart, the even rows of n and the odd rows of n+1 three; the other way round with the odd rows first; both two
/// if the frame was exposed at once, when the marker is moreover at one place in all rows. Says nothing (`unknown`) below 1 px per frame.
[[nodiscard]] FieldEvidence field_evidence(const std::vector<FieldPair>& pairs);

}  // namespace misfit
