#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "misfit/data/track.h"

namespace misfit {

/// Writes `to` (.avi as Motion JPEG, .mp4 as MPEG-4, .mkv without loss): one picture per sample of `track`, which was made from the video
/// `from`, with the marker and half a second of its way drawn, or why it is lost. `fields`: 1 for a progressive video, 2 for an interlaced
/// one, whose first field has the rows from `first_row` on; `radius` of the marker [px]. RunError if the file cannot be written.
void write_check_video(const std::filesystem::path& from, const std::filesystem::path& to, const Track& track, int fields, int first_row,
                       double radius, const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace misfit
