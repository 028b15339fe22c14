#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "misfit/data/image.h"
#include "misfit/video/backend.h"

namespace misfit {

/// A picture in colour to draw on.
class Canvas {
 public:
  Canvas(int width, int height);
  /// Pastes `field` with its frame's corner at (x, y), `scale` pixels of the canvas per pixel of the frame; only the part of the frame in
  /// [left, left + width) x [top, top + height), what is outside the frame stays as it was. Lines that the field lacks are filled from
  /// those it has.
  void paste(const Field& field, double left, double top, double width, double height, int x, int y, double scale);
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

[[nodiscard]] video_module::Mark circle(double x, double y, double radius, Colour colour);
[[nodiscard]] video_module::Mark cross(double x, double y, double half, Colour colour);
[[nodiscard]] video_module::Mark line(double x, double y, double x_end, double y_end, Colour colour);
[[nodiscard]] video_module::Mark box(double x, double y, double x_end, double y_end, Colour colour);
[[nodiscard]] video_module::Mark text(double x, double y, double height, std::string words, Colour colour);

}  // namespace misfit
