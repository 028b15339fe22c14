#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "misfit/data/image.h"
#include "misfit/video/backend.h"

namespace misfit {

/// [left, left + width) x [top, top + height) [px of the frame].
struct FramePart {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
};
[[nodiscard]] inline FramePart whole_frame(const Field& field) { return {0.0, 0.0, 1.0 * field.image.width, 1.0 * field.frame_height()}; }

/// Where the corner of a pasted part stands on the canvas, and how many of its pixels a pixel of the frame takes.
struct Place {
  int x = 0, y = 0;
  double scale = 1.0;
};

/// A picture in colour to draw on.
class Canvas {
 public:
  Canvas(int width, int height);
  /// Pastes a part of the field's frame; what of it is outside the frame stays as it was. Lines that the field lacks are filled from those
  /// it has.
  void paste(const Field& field, const FramePart& part, const Place& to);
  void draw(const std::vector<video_module::Mark>& marks);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::uint8_t* data() const { return bgr_.data(); }
  void write_png(const std::filesystem::path& path) const;  ///< atomically; RunError

 private:
  int width_, height_;
  std::vector<std::uint8_t> bgr_;
};

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};
inline constexpr Colour found_colour{0, 220, 90}, lost_colour{255, 80, 60}, trail_colour{255, 190, 0}, text_colour{255, 255, 255};

/// Places are pixels of the canvas.
[[nodiscard]] video_module::Mark circle(const PixelPoint& at, double radius, Colour colour);
[[nodiscard]] video_module::Mark cross(const PixelPoint& at, double half, Colour colour);
[[nodiscard]] video_module::Mark line(const PixelPoint& from, const PixelPoint& to, Colour colour);
[[nodiscard]] video_module::Mark box(const PixelPoint& from, const PixelPoint& to, Colour colour);
[[nodiscard]] video_module::Mark text(const PixelPoint& at, double height, std::string words, Colour colour);

}  // namespace misfit
