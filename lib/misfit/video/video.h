#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/image.h"
#include "misfit/video/backend.h"

namespace misfit {

/// One decoded frame.
struct Frame {
  Image image;
  long number =
      0;  ///< on the grid of the frame rate: time = number / rate. Larger than the count of frames before it where some are missing
  bool repeated = false;  ///< pixel for pixel the frame before
};

/// What a container says and what was found in it.
struct VideoFacts {
  std::string file;
  int width = 0, height = 0;
  double rate = 0.0;      ///< frames per second
  long declared = 0;      ///< frames the container declares (estimated from its duration by some); 0 = it does not say
  long decoded = 0;       ///< frames read so far
  long missing = 0;       ///< left out between frames, as the timestamps show
  long repeated = 0;      ///< frames equal to the one before
  bool finished = false;  ///< the end was reached
};

/// Decodes a video in a thread of its own. Time comes from index and rate; the container's timestamps only show where frames were left out.
class Video {
 public:
  /// InputError: no such file, an empty file. RunError: not a video (what cannot be decoded), no frame rate, no frame at all.
  explicit Video(const std::filesystem::path& path);
  Video(Video&&) noexcept;
  Video& operator=(Video&&) noexcept;
  ~Video();

  /// The next frame; nullopt at the end.
  [[nodiscard]] std::optional<Frame> next();
  [[nodiscard]] const VideoFacts& facts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a user must know about the file, in sentences: frames decoded against declared (a truncated file decodes without any error),
/// missing and repeated ones. Empty when all is as declared.
[[nodiscard]] std::vector<std::string> notes_of(const VideoFacts& facts);

/// A PNG, JPEG, TIFF, BMP or PGM in grey. InputError: no such file; RunError: not an image.
[[nodiscard]] Image read_image(const std::filesystem::path& path);

}  // namespace misfit
