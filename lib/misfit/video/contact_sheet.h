#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/image.h"

namespace misfit {

/// One field as a track sees it.
struct Shot {
  Field field;
  double t = 0.0;                     ///< [s]
  std::vector<PixelPoint> at;         ///< the marker (or markers), where found
  std::vector<PixelPoint> trail;      ///< where it was found before, oldest first
  double radius = 0.0;                ///< of the circle drawn about it [px of the frame]
  std::string label;                  ///< "12.34 s"
  std::string lost;                   ///< why it is not found; empty if it is
  std::optional<PixelPoint> zoom_at;  ///< middle of the magnified part: the marker, or where it was last
};

/// Writes a PNG of tiles in rows of five: each the whole frame with the track drawn on it, and a magnified cut about the marker in the
/// corner farthest from it. A lost marker is said in the tile. RunError if it cannot be written.
void write_contact_sheet(const std::filesystem::path& path, const std::vector<Shot>& shots);

}  // namespace misfit
