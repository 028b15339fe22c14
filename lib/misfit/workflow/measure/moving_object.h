#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/study.h"
#include "misfit/track/appearance.h"
#include "misfit/track/field_order.h"
#include "misfit/track/search.h"
#include "misfit/track/silhouette.h"

namespace misfit {

/// An object that moves before a ground that stands still, as learnt from frames of the whole video: what is followed is its outline in the
/// foreground, so that neither light nor what is painted on it matters. Places of `look` and `still` are pixels of the foreground.
struct MovingObject {
  Background background;
  Silhouette silhouette;
  Appearance look;
  FieldEvidence evidence;
  std::vector<PixelPoint> still;

  /// What is followed in a frame.
  [[nodiscard]] Image picture_of(const ColourImage& frame) const { return background.foreground(frame, silhouette.shrink); }
  /// A place in that picture as a place of the frame [px], and back.
  [[nodiscard]] PixelPoint in_frame(const PixelPoint& at) const;
  [[nodiscard]] PixelPoint in_picture(const PixelPoint& at) const;
};

/// Where a study says that the marker is looked for.
[[nodiscard]] std::optional<Region> region_of(const VideoStudy& study);

/// Reads the whole video once. nullopt with `why` in words; RunError: not a video.
[[nodiscard]] std::optional<MovingObject> find_moving_object(const std::filesystem::path& path, const VideoStudy& study, std::string& why);

}  // namespace misfit
