#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// What the video module gives to misfit::video. The module (lib/misfit/video/opencv) is the only code that is linked to OpenCV; it is
/// loaded when a video or an image is first read, because loading OpenCV's videoio costs 0.2 s. No exception but std::bad_alloc of
/// next() crosses this border: an empty result comes with `why`.
namespace misfit::video_module {

/// Changes whenever anything in this file does: a module of another build is refused.
inline constexpr int interface_version = 4;

/// An open video. Frames come in order, in 8-bit grey and, where asked for, in colour.
class VideoStream {
 public:
  VideoStream() = default;
  VideoStream(const VideoStream&) = delete;
  VideoStream& operator=(const VideoStream&) = delete;
  virtual ~VideoStream() = default;

  int width = 0, height = 0;
  double rate = 0.0;       ///< frames per second, as the container declares
  long declared = 0;       ///< frames, as the container declares (some only estimate it from the duration); 0 = not known
  double timestamp = 0.0;  ///< of the frame last read [s]; the last frames that a decoder gives back have none: 0
  std::vector<double> first_timestamps = {};  ///< of the first frames, read before the others [s]

  /// Decodes into `grey` (width * height bytes) and, unless it is null, `bgr` (three bytes per pixel); false at the end.
  virtual bool next(std::uint8_t* grey, std::uint8_t* bgr) = 0;
  /// Goes to about this timestamp [s], earlier or later as the decoder can: that of the next frame says where. False: it cannot.
  virtual bool seek(double timestamp) = 0;
};

enum class PictureFormat { png, jpeg };

/// A video being written, in colour: three bytes per pixel (blue, green, red).
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  virtual void write(const std::uint8_t* bgr) = 0;
};

/// Something drawn on a picture. `x`, `y` in pixels of it.
struct Mark {
  enum class Shape { circle, cross, line, text, box } shape = Shape::circle;
  double x = 0.0, y = 0.0;
  double size = 0.0;                ///< radius of a circle, half length of a cross, height of a text
  double x_end = 0.0, y_end = 0.0;  ///< of a line, of a (filled) box
  std::uint8_t blue = 0, green = 0, red = 0;
  std::string text = {};
};

/// A place in a picture [px], centres of pixels at integers.
struct Place {
  double x = 0.0, y = 0.0;
};

/// Squares of a chessboard, and its inner corners, row by row, from one of the four that is not said.
struct Chessboard {
  int columns = 0, rows = 0;
  std::vector<Place> corners = {};
};

class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;
  virtual std::unique_ptr<VideoStream> open(const std::string& path, std::string& why) = 0;
  virtual std::unique_ptr<Sink> create(const std::string& path, int width, int height, double rate, std::string& why) = 0;
  /// An image file in grey; empty with `why`.
  virtual std::vector<std::uint8_t> read_image(const std::string& path, int& width, int& height, std::string& why) = 0;
  /// The file of a picture in colour; empty with `why`.
  virtual std::vector<std::uint8_t> encoded(const std::uint8_t* bgr, int width, int height, PictureFormat format, std::string& why) = 0;
  /// A chessboard of so many squares that is seen whole, or (0 x 0) the largest part of any; no corners: none is seen.
  virtual Chessboard chessboard(const std::uint8_t* grey, int width, int height, int columns, int rows) = 0;
  /// Corners, clockwise in the picture and good to about a pixel, of what is dark, convex and has four sides of `least_side` [px] or more.
  virtual std::vector<std::array<Place, 4>> dark_quadrilaterals(const std::uint8_t* grey, int width, int height, double least_side) = 0;
  virtual void draw(std::uint8_t* bgr, int width, int height, const std::vector<Mark>& marks) = 0;
};

/// What the module exports, as `misfit_video_module`.
struct Entry {
  int version = 0;
  Backend* (*make)() = nullptr;  ///< the module's one backend, which lives as long as the program
};

}  // namespace misfit::video_module
