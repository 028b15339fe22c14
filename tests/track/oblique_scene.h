#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <ranges>
#include <string>
#include <vector>

#include "misfit/data/image.h"

/// A plane that a pinhole camera sees obliquely, drawn ray by ray: nothing of misfit but the picture's structs.
namespace oblique {

using misfit::Image;
using misfit::PixelPoint;

struct Place {
  double x = 0.0, y = 0.0;  ///< [m] in the plane, to the right and upwards
};

/// The plane turned by `yaw` about the vertical and `pitch` about the horizontal, `distance` before the camera.
struct Camera {
  int width = 480, height = 360;
  double focal = 600.0, yaw = 0.6, pitch = 0.25, distance = 1.2;  ///< [px], [rad], [m]
  double k1 = 0.0;                                                ///< of the lens, at half the diagonal

  [[nodiscard]] PixelPoint pixel(const Place& p) const {
    const double a = std::cos(yaw) * p.x, b = -std::sin(yaw) * p.x;  // to the right, away
    const double up = std::cos(pitch) * p.y - std::sin(pitch) * b, away = std::sin(pitch) * p.y + std::cos(pitch) * b;
    const double u = focal * a / (distance + away), v = -focal * up / (distance + away);
    const double r = std::hypot(u, v) / (0.5 * std::hypot(width, height));
    return {0.5 * (width - 1) + u * (1.0 + k1 * r * r), 0.5 * (height - 1) + v * (1.0 + k1 * r * r)};
  }
  /// By Newton's steps with differences.
  [[nodiscard]] Place place(double column, double row) const {
    constexpr double h = 1e-5;
    Place p;
    for (int k = 0; k < 8; ++k) {
      const PixelPoint at = pixel(p), right = pixel({p.x + h, p.y}), above = pixel({p.x, p.y + h});
      const double a = (right.column - at.column) / h, b = (above.column - at.column) / h;
      const double c = (right.row - at.row) / h, d = (above.row - at.row) / h;
      const double e = column - at.column, f = row - at.row, determinant = a * d - b * c;
      p = {p.x + (d * e - b * f) / determinant, p.y + (a * f - c * e) / determinant};
    }
    return p;
  }
};

/// Grey of a place of the plane; negative: nothing is there.
using Paint = std::function<double(const Place&)>;

/// A tag as its cells, '#' black, border included; turned by `angle` about its middle, with a white margin of one cell.
inline Paint tag(const std::vector<std::string>& cells, const Place& middle, double side, double angle = 0.0) {
  return [=](const Place& p) {
    const double u = std::cos(angle) * (p.x - middle.x) + std::sin(angle) * (p.y - middle.y);
    const double v = std::cos(angle) * (p.y - middle.y) - std::sin(angle) * (p.x - middle.x);
    const auto n = static_cast<int>(cells.size());
    const double column = (u / side + 0.5) * n, row = (0.5 - v / side) * n;
    if (column < -1.0 || row < -1.0 || column >= n + 1.0 || row >= n + 1.0) return -1.0;
    if (column < 0.0 || row < 0.0 || column >= n || row >= n) return 225.0;
    return cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#' ? 35.0 : 225.0;
  };
}

/// Its lower left inner corner at `corner`, with a white margin of half a square.
inline Paint chessboard(int columns, int rows, double square, const Place& corner) {
  return [=](const Place& p) {
    const double i = (p.x - corner.x) / square + 1.0, j = (p.y - corner.y) / square + 1.0;
    if (i < -0.5 || j < -0.5 || i > columns + 0.5 || j > rows + 0.5) return -1.0;
    if (i < 0.0 || j < 0.0 || i >= columns || j >= rows) return 225.0;
    return (static_cast<int>(i) + static_cast<int>(j)) % 2 == 0 ? 35.0 : 225.0;
  };
}

inline Paint disc(const Place& middle, double radius, double grey) {
  return [=](const Place& p) { return std::hypot(p.x - middle.x, p.y - middle.y) < radius ? grey : -1.0; };
}

/// Where the camera's pixels are in the plane, found once for many pictures.
class View {
 public:
  explicit View(const Camera& camera) : width_(camera.width), height_(camera.height) {
    for (int r = 0; r <= height_; ++r) {
      for (int c = 0; c <= width_; ++c) corners_.push_back(camera.place(c - 0.5, r - 0.5));
    }
  }

  /// What is painted later lies over what was before; white noise of two grey levels.
  [[nodiscard]] Image picture(const std::vector<Paint>& paints, unsigned seed) const {
    constexpr int across = 4;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 2.0);
    Image image(width_, height_);
    for (int r = 0; r < height_; ++r) {
      for (int c = 0; c < width_; ++c) {
        double sum = 0.0;
        for (int down = 0; down < across; ++down) {
          for (int along = 0; along < across; ++along)
            sum += grey(paints, inside(c, r, (along + 0.5) / across, (down + 0.5) / across)) / (across * across);
        }
        image(c, r) = static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, sum + noise(random)))));
      }
    }
    return image;
  }

 private:
  /// Between the corners of a pixel, as if it were flat.
  [[nodiscard]] Place inside(int c, int r, double u, double v) const {
    const std::size_t at = static_cast<std::size_t>(r) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(c);
    const Place &a = corners_[at], &b = corners_[at + 1], &d = corners_[at + static_cast<std::size_t>(width_) + 1];
    return {a.x + u * (b.x - a.x) + v * (d.x - a.x), a.y + u * (b.y - a.y) + v * (d.y - a.y)};
  }
  static double grey(const std::vector<Paint>& paints, const Place& p) {
    for (const Paint& paint : paints | std::views::reverse) {
      const double over = paint(p);
      if (over >= 0.0) return over;
    }
    return 130.0;
  }

  int width_, height_;
  std::vector<Place> corners_;
};

inline Image picture(const Camera& camera, const std::vector<Paint>& paints, unsigned seed) { return View(camera).picture(paints, seed); }

/// Tag 7 of DICT_4X4_50 and tag 23 of DICT_5X5_50, as OpenCV draws them.
inline const std::vector<std::string> tag_7_of_4x4{"######", "#..###", "##.###", "#....#", "###.##", "######"};
inline const std::vector<std::string> tag_23_of_5x5{"#######", "##.#..#", "#.#.###", "###.###", "#.#..##", "#....##", "#######"};

}  // namespace oblique
