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

/// Ground of 120 with a slope, discs on it, white noise.
inline Field scene(const std::vector<Disc>& discs, int width = 200, int height = 160, int first_row = 0, int row_step = 1,
                   double noise = 2.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0.0, noise);
  Field field{Image(width, (height - first_row + row_step - 1) / row_step), first_row, row_step};
  for (int r = 0; r < field.image.height; ++r) {
    for (int c = 0; c < width; ++c) {
      double sum = 0.0;
      for (int k = 0; k < 64; ++k) {
        const double x = c + (k % 8 + 0.5) / 8.0 - 0.5, y = field.row_of(r) + (k / 8 + 0.5) / 8.0 - 0.5;
        double grey = 120.0 + 0.05 * x - 0.03 * y;
        for (const Disc& d : discs) {
          const double rho = std::hypot(x - d.at.column, y - d.at.row);
          if (rho < d.outer) grey = rho < d.inner ? d.middle : d.grey;
        }
        sum += grey / 64.0;
      }
      field.image(c, r) = static_cast<std::uint8_t>(std::clamp(std::lround(sum + gauss(random)), 0L, 255L));
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
