#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace misfit {

/// How the picture's places became places of the plane of motion: a homography H from metres to pixels without lens distortion, then
/// p = middle + (q − middle)(1 + k1 |q − middle|²/radius²). lib/misfit/README.md, 4.10.
struct PlaneFacts {
  std::string from;                    ///< "chessboard", "points", "aruco"
  std::size_t points = 0, frames = 0;  ///< places that were compared; frames that they are the mean of (0: given by the study)
  double rms = 0.0;                    ///< [px] of their distances from where the map has them
  std::vector<double> homography;      ///< nine, by rows
  double k1 = 0.0, column = 0.0, row = 0.0, radius = 1.0;  ///< lens; middle and half diagonal of the picture [px]
  double scale = 0.0;                                      ///< [m/px] where the track is, in the mean of both directions
  double sigma = 0.0;                                      ///< [m] of a place of the track, as the map is uncertain: largest; 0: not known
  std::vector<std::string> warnings;                       ///< what a user must know of it
};

/// How a track came out of a video: what the file holds, how its frames were read, what was followed and what was lost.
struct TrackFacts {
  std::string video;          ///< file name
  int width = 0, height = 0;  ///< [px]
  double rate = 0.0;          ///< frames per second
  bool variable = false;      ///< … in the mean: samples have the times that the file gives its frames
  long declared = 0;          ///< frames the container declares; 0 = it does not say
  long decoded = 0, missing = 0, repeated = 0;
  std::string fields;               ///< "progressive", "top_first", "bottom_first": as used
  std::string fields_shown;         ///< as the pictures show; "unknown" if they do not
  std::string fields_evidence;      ///< in words
  std::string marker;               ///< "ring", "bright", "dark", "picture", "moving"
  std::string chosen;               ///< why, where the study left the choice; else empty
  double outer = 0.0, inner = 0.0;  ///< radii as learnt [px]; 0 where they have no meaning
  std::size_t samples = 0, ok = 0;
  std::map<std::string, std::size_t> lost;  ///< why → samples
  double sigma = 0.0;                       ///< median of the samples' sigma [px]
  std::vector<std::string> warnings;        ///< what a user must know, in sentences
  std::optional<PlaneFacts> plane = {};     ///< where x_m and y_m are known by more than a length
};

/// track.json. Reading throws InputError for what is no such file.
void write_track_facts(const std::filesystem::path& path, const TrackFacts& facts);
[[nodiscard]] TrackFacts read_track_facts(const std::filesystem::path& path);

/// Frames, fields, marker, losses: one fact per line.
[[nodiscard]] std::vector<std::string> sentences(const TrackFacts& facts);

}  // namespace misfit
