#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace misfit {

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
};

/// track.json. Reading throws InputError for what is no such file.
void write_track_facts(const std::filesystem::path& path, const TrackFacts& facts);
[[nodiscard]] TrackFacts read_track_facts(const std::filesystem::path& path);

/// Frames, fields, marker, losses: one fact per line.
[[nodiscard]] std::vector<std::string> sentences(const TrackFacts& facts);

}  // namespace misfit
