#include "misfit/video/canvas.h"

#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/video/module.h"

namespace misfit {
namespace {

using video_module::Mark;

Mark mark(Mark::Shape shape, const PixelPoint& at, double size, Colour colour) {
  Mark m;
  m.shape = shape;
  m.x = at.column;
  m.y = at.row;
  m.size = size;
  m.red = colour.red;
  m.green = colour.green;
  m.blue = colour.blue;
  return m;
}

/// Mean of the pixels of the frame within [column, column + size) x [row, row + size): at least the nearest one.
double grey_at(const Field& field, double column, double row, double size) {
  const int c0 = static_cast<int>(std::floor(column + 0.5)), c1 = std::max(c0, static_cast<int>(std::ceil(column + size - 0.5)) - 1);
  const int r0 = static_cast<int>(std::lround(field.image_row(row + 0.5 * size - 0.5)));
  const int r1 = std::max(r0, r0 + static_cast<int>(size / field.row_step) - 1);
  double sum = 0.0;
  int count = 0;
  for (int r = r0; r <= r1; ++r) {
    for (int c = c0; c <= c1; ++c) {
      sum += field.image(std::clamp(c, 0, field.image.width - 1), std::clamp(r, 0, field.image.height - 1));
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

Canvas::Canvas(int width, int height) : width_(width), height_(height), bgr_(std::size_t{3} * width * height, 24) {}

void Canvas::paste(const Field& field, const FramePart& part, const Place& to) {
  const auto& [x, y, scale] = to;
  for (int j = 0; j < std::lround(part.height * scale); ++j) {
    for (int i = 0; i < std::lround(part.width * scale); ++i) {
      const double column = part.left + i / scale, row = part.top + j / scale;
      if (x + i < 0 || y + j < 0 || x + i >= width_ || y + j >= height_) continue;
      if (column < -0.5 || row < -0.5 || column > field.image.width - 0.5 || row > field.frame_height() - 0.5) continue;
      const auto grey = static_cast<std::uint8_t>(grey_at(field, column, row, 1.0 / scale));
      const std::size_t at = 3 * (std::size_t{1} * (y + j) * width_ + x + i);
      for (std::size_t k = 0; k < 3; ++k) bgr_[at + k] = grey;
    }
  }
}

void Canvas::draw(const std::vector<Mark>& marks) { video_backend().draw(bgr_.data(), width_, height_, marks); }

void Canvas::write_png(const std::filesystem::path& path) const {
  std::string why;
  const std::vector<std::uint8_t> png = video_backend().encoded(bgr_.data(), width_, height_, video_module::PictureFormat::png, why);
  if (png.empty()) throw RunError(path.string() + ": " + why);
  write_atomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

Mark circle(const PixelPoint& at, double radius, Colour colour) { return mark(Mark::Shape::circle, at, radius, colour); }
Mark cross(const PixelPoint& at, double half, Colour colour) { return mark(Mark::Shape::cross, at, half, colour); }

Mark line(const PixelPoint& from, const PixelPoint& to, Colour colour) {
  Mark m = mark(Mark::Shape::line, from, 0.0, colour);
  m.x_end = to.column;
  m.y_end = to.row;
  return m;
}

Mark box(const PixelPoint& from, const PixelPoint& to, Colour colour) {
  Mark m = line(from, to, colour);
  m.shape = Mark::Shape::box;
  return m;
}

Mark text(const PixelPoint& at, double height, std::string words, Colour colour) {
  Mark m = mark(Mark::Shape::text, at, height, colour);
  m.text = std::move(words);
  return m;
}

}  // namespace misfit
