#pragma once

#include "misfit/workflow/measure/track_video.h"

namespace misfit {

/// track_video() of an ArUco tag: it is read anew in every frame, so nothing is learnt and no neighbour is asked; where it cannot be read
/// it is lost. RunError: not a video, fewer than two frames, the tag in no frame, two tags of one id that nothing tells apart.
[[nodiscard]] VideoTrack track_tag(const std::filesystem::path& path, const VideoStudy& study,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace misfit
