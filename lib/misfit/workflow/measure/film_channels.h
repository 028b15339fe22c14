#pragma once

#include <string>
#include <vector>

#include "misfit/core/table.h"
#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// Does one of the system's outputs come from one of film_channels()? (Else a track is read as angles of a rig, through its camera.)
[[nodiscard]] bool reads_film(const Session& session, const ExperimentStudy& experiment);

/// The track as a recording with these channels; empty where it is lost.
[[nodiscard]] Table film_table(const Track& track, const TrackFacts& facts, const VideoStudy& video);

/// Metres per pixel where the study knows a length in the picture.
[[nodiscard]] std::optional<double> metres_per_pixel(const VideoStudy& video);

}  // namespace misfit
