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
  ColourImage colour = {};  ///< where asked for
  long number =
      0;  ///< on the grid of the frame rate: time = number / rate. Larger than the count of frames before it where some are missing
  bool repeated = false;            ///< pixel for pixel the frame before
  std::optional<double> time = {};  ///< [s] since the first frame, as the container has it; nullopt: it has none that can be used
};

/// What a container says and what was found in it.
struct VideoFacts {
  std::string file;
  int width = 0, height = 0;
  double rate = 0.0;      ///< frames per second; at the end as all timestamps have it (their mean where it is variable)
  bool variable = false;  ///< intervals differ: the time of a frame is that of the container, not number / rate
  long declared = 0;      ///< frames the container declares (estimated from its duration by some); 0 = it does not say
  long decoded = 0;       ///< frames read so far
  long missing = 0;       ///< left out between frames, as the timestamps show
  long repeated = 0;      ///< frames equal to the one before
  bool finished = false;  ///< the end was reached
};

enum class Colours { grey, bgr };

/// Decodes a video in a thread of its own. The container's timestamps decide how time runs (clock.h): at a constant rate, where they only
/// show where frames were left out and the time is number / rate (they are rounded, and the rate is not), or at a variable one, where
/// every frame has its own and none is left out.
class Video {
 public:
  /// InputError: no such file, an empty file. RunError: not a video (what cannot be decoded), no frame rate, no frame at all.
  explicit Video(const std::filesystem::path& path, Colours colours = Colours::grey);
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
