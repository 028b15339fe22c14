#pragma once

#include <cmath>
#include <random>

#include "misfit/track/marker.h"

/// Pictures of markers made by 8 x 8 points per pixel: another way than the tracker's formula.
namespace pictures {

using namespace misfit;

struct Disc {
  PixelPoint at;
  double outer = 10.0, inner = 0.0;
  double grey = 230.0, middle = 40.0;
};

/// Grey of one point: a ground of 120 with a slope, discs on it.
inline double grey_at(const std::vector<Disc>& discs, double x, double y) {
  double grey = 120.0 + 0.05 * x - 0.03 * y;
  for (const Disc& d : discs) {
    const double rho = std::hypot(x - d.at.column, y - d.at.row);
    if (rho < d.outer) grey = rho < d.inner ? d.middle : d.grey;
  }
  return grey;
}

/// Mean over the pixel at `column` and `row`.
inline double pixel_grey(const std::vector<Disc>& discs, double column, double row) {
  constexpr int points = 8;
  double sum = 0.0;
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) sum += grey_at(discs, column + (j + 0.5) / points - 0.5, row + (i + 0.5) / points - 0.5);
  }
  return sum / (points * points);
}

/// A picture of that with white noise.
inline Field noisy_picture(const std::vector<Disc>& discs, int width = 200, int height = 160, int first_row = 0, int row_step = 1,
                           double noise = 2.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0.0, noise);
  Field field{Image(width, (height - first_row + row_step - 1) / row_step), first_row, row_step};
  for (int r = 0; r < field.image.height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double grey = pixel_grey(discs, c, field.row_of(r)) + gauss(random);
      field.image(c, r) = static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }
  return field;
}

inline Marker kind(MarkerKind k) {
  Marker marker;
  marker.kind = k;
  return marker;
}

}  // namespace pictures
