#include "misfit/track/tag.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "misfit/math/homography.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

using Eigen::Vector2d;

constexpr double least_contrast = 20.0;  // [grey levels] between black and white
constexpr double unseen_error = 0.02;    // [px]

Vector2d vector_of(const PixelPoint& p) { return {p.column, p.row}; }

/// Grey level between pixels; nullopt outside of the picture.
std::optional<double> grey_at(const Image& image, const Vector2d& p) {
  const double x = std::floor(p.x()), y = std::floor(p.y());
  if (!(x >= 0.0) || !(y >= 0.0) || x + 1.0 >= image.width || y + 1.0 >= image.height) return std::nullopt;
  const int c = static_cast<int>(x), r = static_cast<int>(y);
  const double u = p.x() - x, v = p.y() - y;
  return (1.0 - v) * ((1.0 - u) * image(c, r) + u * image(c + 1, r)) + v * ((1.0 - u) * image(c, r + 1) + u * image(c + 1, r + 1));
}

/// A side of the black square: offset(s) = offset + s * tilt, −1 ≤ s ≤ 1 along it, outwards from the line between two corners.
struct Side {
  Vector2d middle, half, outwards;  ///< of that line: its middle, half its way, unit normal
  double offset = 0.0, tilt = 0.0;
  double offset_sigma = 0.0, tilt_sigma = 0.0;

  [[nodiscard]] Vector2d at(double s) const { return middle + s * half + (offset + s * tilt) * outwards; }
};

/// Where the grey level passes from black to white along the normal [px outwards]; nullopt where it does not do so clearly.
std::optional<double> edge_at(const Image& image, const Vector2d& from, const Vector2d& outwards, double reach) {
  constexpr double step = 0.25;
  std::vector<double> levels;
  const int steps = static_cast<int>(std::ceil(reach / step));
  for (int k = -steps; k <= steps; ++k) {
    const auto grey = grey_at(image, from + k * step * outwards);
    if (!grey) return std::nullopt;
    levels.push_back(*grey);
  }
  const double black = *std::min_element(levels.begin(), levels.begin() + steps + 1);
  const double white = *std::max_element(levels.begin() + steps, levels.end());
  if (white - black < least_contrast) return std::nullopt;
  const double middle = 0.5 * (black + white);
  std::optional<double> found;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    if (levels[k] >= middle || levels[k + 1] < middle) continue;
    if (found) return std::nullopt;  // it does so twice
    found = step * (static_cast<double>(k) - steps + (middle - levels[k]) / (levels[k + 1] - levels[k]));
  }
  return found;
}

/// offset and tilt by least squares, and their sigmas.
void fit_line(const std::vector<Vector2d>& places, Side& side) {
  const auto n = std::ssize(places);
  Eigen::MatrixXd rows(n, 2);
  Eigen::VectorXd offsets(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rows.row(i) << 1.0, places[i].x();
    offsets(i) = places[i].y();
  }
  const Eigen::Matrix2d inverse = (rows.transpose() * rows).inverse();
  const Vector2d line = inverse * (rows.transpose() * offsets);
  const double left = static_cast<double>(n) - 2.0, alike = 2.0;  // neighbours share pixels
  const double variance = alike * (offsets - rows * line).squaredNorm() / left;
  side.offset = line(0);
  side.tilt = line(1);
  side.offset_sigma = std::sqrt(variance * inverse(0, 0));
  side.tilt_sigma = std::sqrt(variance * inverse(1, 1));
}

/// The side between two corners; nullopt where it is not a straight edge from black to white on most of its way.
std::optional<Side> side_between(const Image& image, const Vector2d& from, const Vector2d& to, double reach) {
  constexpr double ends = 0.85, share_of_places = 0.85, largest_error = 0.5;  // of half the way; of the places; [px]
  const double length = (to - from).norm();
  if (!(length > 0.0)) return std::nullopt;
  Side side{0.5 * (from + to), 0.5 * (to - from), Vector2d(to.y() - from.y(), from.x() - to.x()) / length};
  const int count = std::max(8, static_cast<int>(length));
  std::vector<Vector2d> places;  // s and offset
  for (int k = 0; k < count; ++k) {
    const double s = ends * (2.0 * k / (count - 1.0) - 1.0);
    if (const auto offset = edge_at(image, side.at(s), side.outwards, reach)) places.emplace_back(s, *offset);
  }
  if (static_cast<double>(places.size()) < share_of_places * count) return std::nullopt;
  fit_line(places, side);
  std::vector<double> off;
  for (const Vector2d& p : places) off.push_back(p.y() - side.offset - p.x() * side.tilt);
  const bool jumps = std::any_of(off.begin(), off.end(), [](double d) { return std::abs(d) > 3.0 * largest_error; });
  if (jumps || mad_sigma(off) > largest_error) return std::nullopt;
  return side;
}

Vector2d meeting(const Vector2d& a, const Vector2d& along_a, const Vector2d& b, const Vector2d& along_b) {
  Eigen::Matrix2d m;
  m << along_a, -along_b;
  return a + m.partialPivLu().solve(b - a)(0) * along_a;
}

using Sides = std::array<Side, 4>;  // from corner k to corner k + 1

std::array<Vector2d, 4> corners_of(const Sides& sides) {
  std::array<Vector2d, 4> out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Side &before = sides[(k + 3) % 4], &after = sides[k];
    out[k] = meeting(before.at(0.0), before.at(1.0) - before.at(0.0), after.at(0.0), after.at(1.0) - after.at(0.0));
  }
  return out;
}

Vector2d centre_of(const std::array<Vector2d, 4>& c) { return meeting(c[0], c[2] - c[0], c[1], c[3] - c[1]); }

/// [px] of one coordinate of the centre, in the root mean square of both.
double centre_sigma(const Sides& sides) {
  const Vector2d centre = centre_of(corners_of(sides));
  double variance = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    Sides moved = sides;
    moved[k].offset += sides[k].offset_sigma;
    variance += 0.5 * (centre_of(corners_of(moved)) - centre).squaredNorm();
    moved = sides;
    moved[k].tilt += sides[k].tilt_sigma;
    variance += 0.5 * (centre_of(corners_of(moved)) - centre).squaredNorm();
  }
  return std::sqrt(variance + unseen_error * unseen_error);
}

/// The grey level of every cell, border included, by rows.
std::optional<std::vector<double>> cell_levels(const Image& image, const std::array<Vector2d, 4>& corners, int across) {
  constexpr int points = 3;
  constexpr double inside = 0.25;  // of a cell, on both sides of its middle
  const Eigen::Matrix3d map = homography_of_square(corners);
  std::vector<double> out;
  for (int cell = 0; cell < across * across; ++cell) {
    const int column = cell % across, row = cell / across;
    double sum = 0.0;
    for (int k = 0; k < points * points; ++k) {
      const int right = k % points - 1, down = k / points - 1;
      const double x = column + 0.5 + inside * right, y = row + 0.5 + inside * down;
      const Eigen::Vector3d at = map * Eigen::Vector3d(x / across, y / across, 1.0);
      const auto grey = grey_at(image, at.hnormalized());
      if (!grey) return std::nullopt;
      sum += *grey / (points * points);
    }
    out.push_back(sum);
  }
  return out;
}

/// The inner cells as a code; nullopt where one is doubtful or the border is not black.
std::optional<std::uint64_t> code_in(const std::vector<double>& levels, int cells) {
  constexpr double doubtful = 0.15;  // of the contrast, on both sides of its middle
  const auto [black, white] = std::minmax_element(levels.begin(), levels.end());
  const double contrast = *white - *black, middle = 0.5 * (*white + *black);
  if (contrast < least_contrast) return std::nullopt;
  const int across = cells + 2;
  std::uint64_t code = 0;
  for (int cell = 0; cell < across * across; ++cell) {
    const double level = levels[cell];
    if (std::abs(level - middle) < doubtful * contrast) return std::nullopt;
    const int r = cell / across, c = cell % across;
    if (r > 0 && c > 0 && r <= cells && c <= cells) {
      code = code << 1U | (level > middle ? 1U : 0U);
    } else if (level > middle) {
      return std::nullopt;
    }
  }
  return code;
}

/// The code of the tag turned by a quarter, against the clock.
std::uint64_t turned(std::uint64_t code, int cells) {
  std::uint64_t out = 0;
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      const int from = c * cells + (cells - 1 - r);
      out = out << 1U | (code >> static_cast<unsigned>(cells * cells - 1 - from) & 1U);
    }
  }
  return out;
}

}  // namespace

std::optional<Tag> read_tag(const Image& image, const Corners& about, int cells) {
  std::array<Vector2d, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = vector_of(about[k]);
  Sides sides;
  for (const double share : {1.0, 0.6}) {  // of a cell: first from corners that are off by a pixel
    for (std::size_t k = 0; k < 4; ++k) {
      const double cell = (corners[k] - corners[(k + 1) % 4]).norm() / (cells + 2);
      const auto side = side_between(image, corners[k], corners[(k + 1) % 4], std::clamp(share * cell, 1.5, 4.0));
      if (!side) return std::nullopt;
      sides[k] = *side;
    }
    corners = corners_of(sides);
  }
  const auto levels = cell_levels(image, corners, cells + 2);
  if (!levels) return std::nullopt;
  auto code = code_in(*levels, cells);
  if (!code) return std::nullopt;
  const auto& codes = tag_codes(cells);
  for (std::size_t turns = 0; turns < 4; ++turns) {
    const auto found = std::find(codes.begin(), codes.end(), *code);
    if (found != codes.end()) {
      Tag tag{static_cast<int>(found - codes.begin()), {}, {}, centre_sigma(sides)};
      for (std::size_t k = 0; k < 4; ++k) tag.corners[k] = {corners[(k + turns) % 4].x(), corners[(k + turns) % 4].y()};
      const Vector2d centre = centre_of(corners);
      tag.centre = {centre.x(), centre.y()};
      return tag;
    }
    code = turned(*code, cells);
  }
  return std::nullopt;
}

}  // namespace misfit
