#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/video/backend.h"

namespace misfit {

/// A frame to look at.
struct FramePicture {
  int width = 0, height = 0;
  double t = 0.0;    ///< [s] since the first frame, as the container has it
  std::string jpeg;  ///< bytes of the file
};

/// Frames of a video by their times, in any order: near ahead by decoding on, elsewhere by seeking. What a seek has reached is read from
/// the timestamps, so that a decoder that seeks badly costs time and no frame is taken for another one. Where frames have no timestamps
/// they are counted from the first.
class FrameReader {
 public:
  /// Throws as opened_stream().
  explicit FrameReader(std::filesystem::path path);

  /// The last frame that begins not later than `t` [s since the first frame], the last of all behind the end. nullopt: none can be decoded.
  [[nodiscard]] std::optional<FramePicture> at(double t);

 private:
  struct Decoded {
    double t = 0.0;
    std::vector<std::uint8_t> bgr;
  };

  [[nodiscard]] std::optional<Decoded> decode();
  void begin();
  [[nodiscard]] bool seek(double t);
  void read_until(double t);

  std::filesystem::path path_;
  std::unique_ptr<video_module::VideoStream> stream_;
  double origin_ = 0.0, interval_ = 0.0;  ///< [s] timestamp of the first frame; between frames
  bool has_timestamps_ = false;
  std::vector<std::uint8_t> grey_;        ///< what is decoded besides, and not looked at
  std::optional<Decoded> shown_, ahead_;  ///< frames that follow each other
};

}  // namespace misfit
