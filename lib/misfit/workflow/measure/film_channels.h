#pragma once

#include <string>
#include <vector>

#include "misfit/core/table.h"
#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// What a film gives the outputs of any system, by name or through the experiment's `columns`: x_px and y_px, column and row of what is
/// followed [px], pixel centres at integers, rows counted downwards; with a known length in the picture also x_m and y_m [m], to the right
/// and upwards from the origin.
[[nodiscard]] const std::vector<std::string>& film_channels();

/// Does one of the system's outputs come from such a channel? (Else a track is read as angles of a rig, through its camera.)
[[nodiscard]] bool reads_film(const Session& session, const ExperimentStudy& experiment);

/// The track as a recording with these channels; empty where it is lost.
[[nodiscard]] Table film_table(const Track& track, const TrackFacts& facts, const VideoStudy& video);

/// Metres per pixel where the study knows a length in the picture.
[[nodiscard]] std::optional<double> metres_per_pixel(const VideoStudy& video);

}  // namespace misfit
