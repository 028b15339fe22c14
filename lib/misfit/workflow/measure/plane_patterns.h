#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/data/study.h"
#include "misfit/math/homography.h"

namespace misfit {

/// Places of the plane of motion that are known, and where they are in the picture, in the median of the frames in which they are seen.
struct KnownPlaces {
  std::vector<PlanePoint> points;
  std::vector<std::string> names = {};  ///< of [video.points]; else empty
  std::size_t frames = 0;               ///< 0: pixels given by the study
  double sigma = 0.0;                   ///< [px] per coordinate, as assumed; 0: not known
  PictureSize picture = {};
  std::vector<std::string> warnings = {};
};

/// The inner corners of the study's chessboard, in frames spread over the film. RunError: it is not seen whole in any, or moves.
[[nodiscard]] KnownPlaces chessboard_places(const std::filesystem::path& path, const ChessboardStudy& board);

/// The corners of the study's tag of the plane, or its points, of which some may be tags. RunError: a tag is not seen, or moves.
[[nodiscard]] KnownPlaces tag_places(const std::filesystem::path& path, const ArucoStudy& study);
[[nodiscard]] KnownPlaces point_places(const std::filesystem::path& path, const VideoStudy& study);

}  // namespace misfit
