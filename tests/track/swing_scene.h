#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "misfit/data/image.h"

/// A bob that swings before a textured wall, in colour, drawn point by point: nothing of misfit but the picture's struct.
namespace scene {

using misfit::ColourImage;
using misfit::PixelPoint;

struct Swing {
  int width = 320, height = 200;
  double radius = 14.0;                         ///< of the bob [px]
  double amplitude = 90.0;                      ///< of its column [px]
  double frequency = 4.0;                       ///< [rad/s]
  double damping = 0.02;                        ///< [1/s]
  double length = 500.0;                        ///< of the string [px]
  double turning = 2.0;                         ///< of the bob about itself [rad/s]
  double light = 0.0;                           ///< share by which the light changes over the film, and from left to right
  double exposure = 0.0;                        ///< [s]
  double noise = 2.0;                           ///< [grey levels]
  double texture = 25.0;                        ///< of the wall [grey levels]
  bool like_the_wall = false;                   ///< half of the bob has the wall's colour
  double duration = 12.0;                       ///< [s]
  std::function<PixelPoint(double)> path = {};  ///< instead of the damped cosine

  /// Of the bob's middle [px].
  [[nodiscard]] PixelPoint at(double t) const {
    if (path) return path(t);
    const double x = amplitude * std::exp(-damping * t) * std::cos(frequency * t);
    return {0.5 * width + x, 0.45 * height + std::sqrt(length * length - x * x) - length};
  }
};

using Colour = std::array<double, 3>;

inline double hashed(int x, int y) {
  unsigned h = static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U;
  h = (h ^ (h >> 13U)) * 1274126177U;
  return static_cast<double>(h >> 8U) / 8388608.0 - 1.0;
}

inline Colour wall(const Swing& s, double x, double y) {
  const double stripes = std::sin(0.11 * x + 0.05 * y) + std::sin(0.031 * x - 0.09 * y);
  const double grain = hashed(static_cast<int>(std::floor(x / 3.0)), static_cast<int>(std::floor(y / 3.0)));
  const double g = s.texture * (0.5 * stripes + 0.5 * grain);
  return {120.0 + g, 140.0 + 0.8 * g, 165.0 + 0.9 * g};
}

/// The bob's paint at (u, v) from its middle: two halves and dots, which turn with it.
inline Colour paint(const Swing& s, double u, double v, double t, const Colour& behind) {
  const double c = std::cos(s.turning * t), d = std::sin(s.turning * t), a = c * u + d * v, b = c * v - d * u;
  const bool dot = std::sin(9.0 * a / s.radius) * std::sin(9.0 * b / s.radius) > 0.5;
  if (b > 0.0) return s.like_the_wall ? behind : Colour{200.0, 60.0, 30.0};
  return dot ? Colour{40.0, 40.0, 200.0} : Colour{150.0, 40.0, 60.0};
}

inline Colour point(const Swing& s, double x, double y, double t) {
  const Colour behind = wall(s, x, y);
  const PixelPoint bob = s.at(t);
  const double u = x - bob.column, v = y - bob.row;
  if (std::hypot(u, v) < s.radius) return paint(s, u, v, t, s.like_the_wall ? Colour{120.0, 140.0, 165.0} : behind);
  return behind;
}

/// Mean over a pixel and the exposure.
inline Colour pixel(const Swing& s, int column, int row, double t) {
  const PixelPoint bob = s.at(t);
  const double reach = s.radius + 2.0 + s.amplitude * s.frequency * s.exposure;
  if (std::hypot(column - bob.column, row - bob.row) > reach) return wall(s, column, row);
  constexpr int across = 4, times = 4;
  Colour sum{};
  for (int k = 0; k < across * across * times; ++k) {
    const int right = k % across, down = k / across % across, later = k / (across * across);
    const double x = column + (right + 0.5) / across - 0.5, y = row + (down + 0.5) / across - 0.5;
    const double when = t + s.exposure * ((later + 0.5) / times - 0.5);
    const Colour c = point(s, x, y, when);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += c[i] / (across * across * times);
  }
  return sum;
}

/// The frame at time t (the middle of its exposure).
inline ColourImage frame(const Swing& s, double t) {
  ColourImage image(s.width, s.height);
  std::mt19937 random(static_cast<unsigned>(1000.0 * t) + 7U);
  std::normal_distribution<double> gauss(0.0, s.noise);
  for (int r = 0; r < s.height; ++r) {
    for (int c = 0; c < s.width; ++c) {
      const double gain = 1.0 + s.light * (t / s.duration - 0.5) + 0.3 * s.light * (t / s.duration) * (2.0 * c / s.width - 1.0);
      const Colour colour = pixel(s, c, r, t);
      for (std::size_t i = 0; i < 3; ++i) {
        const double value = gain * colour[i] + gauss(random);
        image.bgr[image.at(c, r) + i] = static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, value))));
      }
    }
  }
  return image;
}

}  // namespace scene
