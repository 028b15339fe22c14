#include "misfit/track/search.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Floats on a grid: point (i, j) stands for the mean of a block of pixels.
struct Grid {
  int width = 0, height = 0;
  std::vector<float> values;
  [[nodiscard]] const float* row(std::ptrdiff_t j) const { return values.data() + j * width; }
  float* row(std::ptrdiff_t j) { return values.data() + j * width; }
};

/// Block of pixels behind a grid point, chosen so that the smaller side of the marker spans about eight points.
struct Pitch {
  int x = 1, y = 1;  ///< columns and image rows
  int row_step = 1;  ///< rows of the frame per image row
};

/// Part of an image that a grid covers: its first pixel, and how many grid points it has.
struct Cut {
  int column, row, width, height;
};

Pitch pitch_of(const Marker& marker, int row_step) {
  const double size = 2.0 * std::min(marker.reach_x(), marker.reach_y()) + 1.0;
  const int pitch = std::clamp(static_cast<int>(size / 8.0), 1, 8);
  return {pitch, std::max(1, pitch / row_step), row_step};
}

Grid shrink(const Image& image, const Cut& cut, const Pitch& pitch) {
  const auto& [first_column, first_row, width, height] = cut;
  Grid grid{width, height, std::vector<float>(std::size_t{1} * width * height, 0.0F)};
  const float scale = 1.0F / static_cast<float>(pitch.x * pitch.y);
  for (int j = 0; j < height; ++j) {
    float* out = grid.row(j);
    for (int k = 0; k < pitch.y; ++k) {
      const std::uint8_t* line = image.pixels.data() + image.at(first_column, first_row + j * pitch.y + k);
      if (pitch.x == 1) {
        for (int i = 0; i < width; ++i) out[i] += static_cast<float>(line[i]);
      } else {
        for (int i = 0; i < width; ++i)
          for (int m = 0; m < pitch.x; ++m) out[i] += static_cast<float>(line[i * pitch.x + m]);
      }
    }
    for (int i = 0; i < width; ++i) out[i] *= scale;
  }
  return grid;
}

/// The marker's brightness over a block of pixels whose middle is at grid point (i, j) from its own middle point.
double shown(const Marker& marker, const Pitch& pitch, int i, int j) {
  double sum = 0.0;
  for (int k = 0; k < pitch.y; ++k) {
    for (int m = 0; m < pitch.x; ++m) {
      const double x = i * pitch.x + m - 0.5 * (pitch.x - 1), y = pitch.row_step * (j * pitch.y + k - 0.5 * (pitch.y - 1));
      const ShapeValue s = shape_at(marker, x, y);
      sum += marker.levels[1] * s.value[0] + (marker.shapes() > 1 ? marker.levels[2] * s.value[1] : 0.0);
    }
  }
  return sum;
}

/// Without mean and of unit length.
void normalise(std::vector<float>& values) {
  double mean = 0.0, square = 0.0;
  for (float v : values) mean += v;
  mean /= static_cast<double>(values.size());
  for (float& v : values) v -= static_cast<float>(mean);
  for (float v : values) square += static_cast<double>(v) * v;
  const auto scale = static_cast<float>(square > 0.0 ? 1.0 / std::sqrt(square) : 0.0);
  for (float& v : values) v *= scale;
}

/// The marker as the grid would show it, centred on its middle point, without mean and of unit length.
Grid kernel_of(const Marker& marker, const Pitch& pitch) {
  const double margin = marker.kind == MarkerKind::picture ? 1.0 : 1.25;
  const int half_x = std::max(2, static_cast<int>(std::lround(margin * marker.reach_x() / pitch.x)));
  const int half_y = std::max(2, static_cast<int>(std::lround(margin * marker.reach_y() / (pitch.y * pitch.row_step))));
  Grid kernel{2 * half_x + 1, 2 * half_y + 1, {}};
  for (int j = -half_y; j <= half_y; ++j) {
    for (int i = -half_x; i <= half_x; ++i) kernel.values.push_back(static_cast<float>(shown(marker, pitch, i, j)));
  }
  normalise(kernel.values);
  return kernel;
}

/// Sums over the kernel's box at every place, by running sums.
struct BoxSums {
  std::vector<double> sum, square;  ///< (width + 1) x (height + 1) integral images
  std::size_t width;
  explicit BoxSums(const Grid& grid) : width(grid.width + 1) {
    const std::size_t size = width * (grid.height + 1);
    sum.assign(size, 0.0);
    square.assign(size, 0.0);
    for (int j = 0; j < grid.height; ++j) {
      double s = 0.0, q = 0.0;
      const float* in = grid.row(j);
      for (int i = 0; i < grid.width; ++i) {
        const double v = in[i];
        s += v;
        q += v * v;
        sum[index(i + 1, j + 1)] = sum[index(i + 1, j)] + s;
        square[index(i + 1, j + 1)] = square[index(i + 1, j)] + q;
      }
    }
  }
  [[nodiscard]] std::size_t index(int i, int j) const { return j * width + i; }
  [[nodiscard]] double box(const std::vector<double>& of, int i, int j, const Grid& kernel) const {
    const int w = kernel.width, h = kernel.height;
    return of[index(i + w, j + h)] - of[index(i, j + h)] - of[index(i + w, j)] + of[index(i, j)];
  }
};

constexpr double min_deviation = 2.0;  // [grey levels] a box flatter than that shows nothing

Grid correlate(const Grid& grid, const Grid& kernel) {
  Grid out{grid.width - kernel.width + 1, grid.height - kernel.height + 1, {}};
  if (out.width < 1 || out.height < 1) return {};
  out.values.assign(std::size_t{1} * out.width * out.height, 0.0F);
  const BoxSums sums(grid);
  const auto n = static_cast<double>(kernel.values.size());
  for (int j = 0; j < out.height; ++j) {
    float* to = out.row(j);
    for (int l = 0; l < kernel.height; ++l) {
      for (int k = 0; k < kernel.width; ++k) {
        const float weight = kernel.row(l)[k];
        const float* from = grid.row(j + l) + k;
        for (int i = 0; i < out.width; ++i) to[i] += weight * from[i];
      }
    }
    for (int i = 0; i < out.width; ++i) {
      const double s = sums.box(sums.sum, i, j, kernel), q = sums.box(sums.square, i, j, kernel);
      const double variance = q - s * s / n;
      to[i] = variance > min_deviation * min_deviation * n ? static_cast<float>(to[i] / std::sqrt(variance)) : 0.0F;
    }
  }
  return out;
}

bool is_peak(const Grid& map, int i, int j) {
  const float v = map.row(j)[i];
  for (int b = std::max(0, j - 1); b <= std::min(map.height - 1, j + 1); ++b) {
    for (int a = std::max(0, i - 1); a <= std::min(map.width - 1, i + 1); ++a) {
      const float other = map.row(b)[a];
      if (other > v || (other == v && (b < j || (b == j && a < i)))) return false;
    }
  }
  return true;
}

}  // namespace

Region whole(const Field& field) { return {0.0, 0.0, field.image.width - 1.0, field.row_of(field.image.height - 1.0)}; }

Region intersection(const Region& a, const Region& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

std::vector<Match> search(const Field& field, const Marker& marker, const Region& region, double least, std::size_t most) {
  const Pitch pitch = pitch_of(marker, field.row_step);
  const Grid kernel = kernel_of(marker, pitch);
  const double half_x = 0.5 * kernel.width * pitch.x, half_y = 0.5 * kernel.height * pitch.y;
  const Region wanted = intersection(region, whole(field));
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v))); };
  const int c0 = first(wanted.left - half_x - 1.0), r0 = first(field.image_row(wanted.top) - half_y - 1.0);
  const int c1 = std::min(field.image.width, static_cast<int>(std::ceil(wanted.right + half_x + 2.0)));
  const int r1 = std::min(field.image.height, static_cast<int>(std::ceil(field.image_row(wanted.bottom) + half_y + 2.0)));
  if (c1 - c0 < kernel.width * pitch.x || r1 - r0 < kernel.height * pitch.y) return {};
  const Grid grid = shrink(field.image, {c0, r0, (c1 - c0) / pitch.x, (r1 - r0) / pitch.y}, pitch);
  const Grid map = correlate(grid, kernel);
  std::vector<Match> found;
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      if (map.row(j)[i] < least || !is_peak(map, i, j)) continue;
      const int middle_i = i + kernel.width / 2, middle_j = j + kernel.height / 2;  // its sides are odd
      const double column = c0 + middle_i * pitch.x + 0.5 * (pitch.x - 1);
      const double row = field.row_of(r0 + middle_j * pitch.y + 0.5 * (pitch.y - 1));
      if (contains(wanted, {column, row})) found.push_back({{column, row}, map.row(j)[i]});
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Match& a, const Match& b) { return a.score > b.score; });
  const double apart = std::min(marker.reach_x(), marker.reach_y());
  std::vector<Match> kept;
  for (const Match& c : found) {
    const bool near = std::any_of(kept.begin(), kept.end(),
                                  [&](const Match& k) { return std::hypot(k.at.column - c.at.column, k.at.row - c.at.row) < apart; });
    if (!near) kept.push_back(c);
    if (kept.size() == most) break;
  }
  return kept;
}

}  // namespace misfit
