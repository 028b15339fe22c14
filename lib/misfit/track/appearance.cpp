#include "misfit/track/appearance.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

constexpr double min_contrast = 12.0;                    // [grey levels]
constexpr double min_outer = 3.2, largest_outer = 18.0;  // [px] markers of 8 to 30 px, and a little
constexpr double min_explained = 0.6;
constexpr double min_sector = 0.45;
constexpr double largest_sigma = 0.6;  // [px]
constexpr double contrast_jump = 1.8;

/// Hole and ring must both be there: the hole's depth against the ring's height above the ground.
bool hole_like(const std::array<double, 3>& levels) { return -levels[2] > 0.35 * levels[1]; }

}  // namespace

std::string words(Loss loss) {
  switch (loss) {
    case Loss::none:
      return "ok";
    case Loss::not_found:
      return "not found";
    case Loss::outside:
      return "leaves the frame";
    case Loss::covered:
      return "partly covered";
    case Loss::other_look:
      return "another size, contrast or shape";
    case Loss::vague:
      return "not sharp enough";
    case Loss::implausible:
      return "implausible motion";
    case Loss::no_frame:
      return "no frame in the file";
    case Loss::copy:
      return "frame is a copy of the one before";
  }
  return "";
}

bool possible(const Location& found, MarkerKind kind) {
  if (!found.converged || !found.inside || found.explained < min_explained || found.weakest_sector < min_sector) return false;
  if (kind == MarkerKind::picture) return found.levels[1] > 0.2;
  const double contrast = kind == MarkerKind::dark ? -found.levels[1] : found.levels[1];
  if (contrast < min_contrast || found.outer < min_outer || found.outer > largest_outer || found.edge > 0.75 * found.outer) return false;
  if (kind != MarkerKind::ring) return true;
  return hole_like(found.levels) && found.inner > 0.2 * found.outer && found.inner < 0.85 * found.outer;
}

Loss judge(const Location& found, const Appearance& look, double contrast) {
  if (!found.converged) return Loss::not_found;
  if (!found.inside) return Loss::outside;
  const double ratio = found.levels[1] / contrast;
  const bool ring = look.marker.kind == MarkerKind::ring;
  if (!(ratio > 1.0 / contrast_jump) || !(ratio < contrast_jump)) return Loss::other_look;
  if (ring && !hole_like(found.levels)) return Loss::other_look;
  if (ring) {
    const double learnt = look.marker.levels[2] / look.marker.levels[1], now = found.levels[2] / found.levels[1];
    if (now / learnt < 0.6 || now / learnt > 1.6) return Loss::other_look;
  }
  const double limit = std::max(min_explained, look.explained - std::max(0.12, 5.0 * look.explained_spread));
  if (found.weakest_sector < min_sector) return Loss::covered;
  if (found.explained < limit) return Loss::other_look;
  if (found.sigma > largest_sigma) return Loss::vague;
  return Loss::none;
}

}  // namespace misfit
