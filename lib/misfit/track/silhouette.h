#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/track/background.h"
#include "misfit/track/marker.h"
#include "misfit/track/search.h"

namespace misfit {

/// A connected part of a foreground.
struct Blob {
  PixelPoint at;      ///< centroid, weighted with the foreground
  double area = 0.0;  ///< [px]
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  [[nodiscard]] double width() const { return right - left + 1.0; }
  [[nodiscard]] double height() const { return bottom - top + 1.0; }
};

/// Connected parts of at least `least` pixels above half of full foreground (127), largest first. Parts less than about four pixels apart
/// are one.
[[nodiscard]] std::vector<Blob> blobs_of(const Image& foreground, double least);

/// What moves before a background: its outline, whatever is painted on it and however it is lit.
struct Silhouette {
  Marker marker;                     ///< kind picture: the mean foreground about its centroid
  int shrink = 1;                    ///< pixels of the frame per pixel of the picture
  double width = 0.0, height = 0.0;  ///< [px of the frame] typical
  double contrast = 0.0;             ///< typical difference from the background [grey levels over three channels]
  double share = 0.0;                ///< of the frames in which it was found
};

struct SilhouetteOptions {
  std::optional<Region> region;  ///< where it is looked for
  int most_shrink = 0;           ///< 0: as the object's size allows
};

/// The object that moves in frames taken from all of a video: of the parts of the foreground those of one size that are in most frames.
/// Sets the background's contrast. nullopt, with `why` in words: nothing moves enough, or too much at once.
[[nodiscard]] std::optional<Silhouette> find_silhouette(const std::vector<ColourImage>& samples, Background& background,
                                                        const SilhouetteOptions& options, std::string& why);

}  // namespace misfit
