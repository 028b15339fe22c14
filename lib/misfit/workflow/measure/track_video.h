#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "misfit/data/study.h"
#include "misfit/data/track_facts.h"
#include "misfit/track/field_order.h"
#include "misfit/track/search.h"
#include "misfit/video/contact_sheet.h"

namespace misfit {

/// A video turned into a track.
struct VideoTrack {
  Track track;  ///< one sample per frame, or per field of an interlaced video: t = index / rate
  TrackFacts facts;
  std::vector<Shot> shots;  ///< for the contact sheet: evenly over the video, and the first losses
};

/// video → track: look and field order are learnt from the first frames, then the marker is followed through all of them. RunError: not a
/// video, fewer than two frames, the marker is never found.
[[nodiscard]] VideoTrack track_video(const std::filesystem::path& path, const VideoStudy& study,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress = {});

/// The marker a study names.
[[nodiscard]] Marker marker_of(const MarkerStudy& study);

/// How the frames are read: what the pictures show where they are clear, else what the study says. What a user must know goes to
/// `warnings`.
[[nodiscard]] FieldOrder choose_fields(const VideoStudy& study, const FieldEvidence& evidence, std::vector<std::string>& warnings);

}  // namespace misfit
