#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/track/tracker.h"
#include "misfit/video/video.h"

namespace misfit {

/// Of the samples [s]: on the grid of the rate, or as the file has them. Samples between two with a time lie evenly between them; those
/// after the last are left out, and that is said. `fields`: samples of a frame.
[[nodiscard]] std::vector<double> sample_times(const std::vector<std::optional<double>>& read, const VideoFacts& facts, std::size_t fields,
                                               std::vector<std::string>& warnings);

[[nodiscard]] Track track_of(const std::vector<TrackedSample>& samples, const VideoFacts& facts, const std::vector<double>& times);

/// What the file holds, and what was lost of the marker.
[[nodiscard]] TrackFacts facts_of(const VideoFacts& video, const std::vector<TrackedSample>& samples);

}  // namespace misfit
