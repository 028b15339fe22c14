#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "misfit/data/track.h"

namespace misfit {

/// How the frames of a video give samples: one each, or two fields, the first with the rows from `first_row` on.
struct FieldsOfFrame {
  int count = 1, first_row = 0;
};

/// A video, and the track that was made from it.
struct CheckVideoInput {
  std::filesystem::path from;
  const Track& track;
  FieldsOfFrame fields;
  double radius = 0.0;  ///< of the marker [px]
};
/// Writes `to` (.avi as Motion JPEG, .mp4 as MPEG-4, .mkv without loss): one picture per sample of the track, with the marker and half a
/// second of its way drawn, or why it is lost. RunError if the file cannot be written.
void write_check_video(const CheckVideoInput& input, const std::filesystem::path& to,
                       const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace misfit
