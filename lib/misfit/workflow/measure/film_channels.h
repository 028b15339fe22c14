#pragma once

#include <string>
#include <vector>

#include "misfit/core/table.h"
#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// The channel that an output is read from.
[[nodiscard]] std::string channel_of(const std::string& output, const ExperimentStudy& experiment);

/// Does one of the system's outputs come from one of film_channels()? (Else a track is read as angles of a rig, through its camera.)
[[nodiscard]] bool reads_film(const Session& session, const ExperimentStudy& experiment);

/// A marker's way through a film, and its name; "" where only one is followed.
struct FilmTrack {
  std::string name;
  Track track;
  TrackFacts facts;
};

/// The tracks of one film as a recording with these channels; empty where a marker is lost. RunError: tracks of different times.
[[nodiscard]] Table film_table(const std::vector<FilmTrack>& tracks, const VideoStudy& video);

/// Of a channel of the film, whose unit is px or m: median of the sigmas of what was found, carried to metres where it was found; 0: not
/// known.
[[nodiscard]] double film_sigma(const FilmTrack& followed, const std::string& channel, const VideoStudy& video);

/// Metres per pixel where the study knows a length in the picture.
[[nodiscard]] std::optional<double> metres_per_pixel(const VideoStudy& video);

}  // namespace misfit
