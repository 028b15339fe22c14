#pragma once

#include <filesystem>
#include <optional>

#include "misfit/data/study.h"
#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/math/homography.h"

namespace misfit {

/// From pixels of a film to metres of the plane of motion, as the study's chessboard, points or tag give it; nullopt where it has none of
/// these. `track`: what was followed, for the scale and uncertainty there. InputError: points that no camera sees so. RunError: the
/// pattern is not seen, or moves in the picture.
[[nodiscard]] std::optional<PlaneFacts> calibrate_plane(const std::filesystem::path& path, const VideoStudy& study, const Track& track);

[[nodiscard]] PlaneMap map_of(const PlaneFacts& facts);

}  // namespace misfit
