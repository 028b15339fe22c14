#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace misfit {

/// A picture in 8-bit grey: `pixels[row * width + column]`, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int w, int h, std::uint8_t grey = 0) : width(w), height(h), pixels(std::size_t{1} * w * h, grey) {}
  [[nodiscard]] bool empty() const { return pixels.empty(); }
  [[nodiscard]] std::size_t at(int column, int row) const { return std::size_t{1} * row * width + column; }
  [[nodiscard]] std::uint8_t operator()(int column, int row) const { return pixels[at(column, row)]; }
  std::uint8_t& operator()(int column, int row) { return pixels[at(column, row)]; }
  bool operator==(const Image&) const = default;
};

/// A picture in colour: three bytes per pixel (blue, green, red), rows from the top.
struct ColourImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;

  ColourImage() = default;
  ColourImage(int w, int h) : width(w), height(h), bgr(std::size_t{3} * w * h, 0) {}
  [[nodiscard]] bool empty() const { return bgr.empty(); }
  [[nodiscard]] std::size_t at(int column, int row) const { return std::size_t{3} * (std::size_t{1} * row * width + column); }
};

/// The lines of a frame that were exposed together. Row r of `image` lies at row `first_row + row_step * r` of the full frame: a
/// progressive frame is (0, 1), the two fields of an interlaced one are (0, 2) and (1, 2). Positions are given in full-frame pixels,
/// centres at integers.
struct Field {
  Image image;
  int first_row = 0, row_step = 1;

  [[nodiscard]] double row_of(double r) const { return first_row + row_step * r; }           ///< row of the image → row of the frame
  [[nodiscard]] double image_row(double row) const { return (row - first_row) / row_step; }  ///< row of the frame → row of the image
  [[nodiscard]] int frame_height() const { return image.height * row_step; }
};

/// A point of the full frame [px].
struct PixelPoint {
  double column = 0.0, row = 0.0;
};

/// Every second line of `frame`, from line `first_row` (0 or 1).
[[nodiscard]] inline Field field_of(const Image& frame, int first_row) {
  Field field{Image(frame.width, (frame.height - first_row + 1) / 2), first_row, 2};
  for (int r = 0; r < field.image.height; ++r) {
    const std::uint8_t* line = frame.pixels.data() + frame.at(0, first_row + 2 * r);
    std::copy(line, line + frame.width, field.image.pixels.data() + field.image.at(0, r));
  }
  return field;
}

}  // namespace misfit
