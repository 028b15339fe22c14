// Tags drawn as OpenCV draws them, seen obliquely, turned and blurred by pixels: read, and placed within the sigma that is said.
#include "misfit/track/tag.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <set>

#include "tests/track/oblique_scene.h"

namespace misfit {
namespace {

using oblique::Camera;
using oblique::Paint;
using oblique::Place;

constexpr double side = 0.12;  // [m]

/// Corners of the black square as the camera sees them, shifted by up to a pixel, beginning with corner `first`.
Corners about(const Camera& camera, const Place& middle, double angle, std::size_t first, double shift = 0.7) {
  constexpr std::array<std::array<double, 2>, 4> square{{{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};
  Corners out;
  for (std::size_t k = 0; k < 4; ++k) {
    const double u = side * square[(k + first) % 4][0], v = side * square[(k + first) % 4][1];
    out[k] = camera.pixel({middle.x + std::cos(angle) * u - std::sin(angle) * v, middle.y + std::sin(angle) * u + std::cos(angle) * v});
    out[k].column += k % 2 == 0 ? shift : -shift;
    out[k].row += k < 2 ? -shift : shift;
  }
  return out;
}

TEST(Tags, SeenObliquelyAreReadAndPlacedWithinTheirSigma) {
  double squares = 0.0;
  int count = 0;
  for (unsigned k = 0; k < 24; ++k) {
    Camera camera{120, 100, 500.0, -0.8 + 0.07 * k, 0.3, 1.0 + 0.02 * k, 0.0};
    const Place middle{0.011 * std::cos(k), 0.013 * std::sin(1.7 * k)};
    const double angle = 0.26 * k;
    const Image image = oblique::picture(camera, {oblique::tag(oblique::tag_7_of_4x4, middle, side, angle)}, k);
    const auto tag = read_tag(image, about(camera, middle, angle, k % 4), 4);
    ASSERT_TRUE(tag) << k;
    EXPECT_EQ(tag->id, 7);
    const PixelPoint centre = camera.pixel(middle);
    const double x = tag->centre.column - centre.column, y = tag->centre.row - centre.row;
    EXPECT_LT(std::hypot(x, y), 0.25) << k << " px";
    EXPECT_LT(tag->sigma, 0.1);
    squares += 0.5 * (x * x + y * y) / (tag->sigma * tag->sigma);
    ++count;
    const Corners corners = about(camera, middle, angle, 0, 0.0);
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_LT(std::hypot(tag->corners[c].column - corners[c].column, tag->corners[c].row - corners[c].row), 0.5) << k << ", corner " << c;
  }
  std::printf("    errors are %.2f sigma (RMS)\n", std::sqrt(squares / count));
  EXPECT_LT(squares / count, 1.5 * 1.5);
}

TEST(Tags, OfAnotherSizeAreRead) {
  const Camera camera{160, 120, 500.0, 0.5, 0.2, 0.8, 0.0};
  const Image image = oblique::picture(camera, {oblique::tag(oblique::tag_23_of_5x5, {}, side)}, 1);
  const auto tag = read_tag(image, about(camera, {}, 0.0, 0), 5);
  ASSERT_TRUE(tag);
  EXPECT_EQ(tag->id, 23);
  EXPECT_FALSE(read_tag(image, about(camera, {}, 0.0, 0), 4));
  EXPECT_FALSE(read_tag(image, about(camera, {}, 0.0, 0), 6));
}

TEST(Tags, ThatAreDoubtfulAreNone) {
  const Camera camera{160, 120, 500.0, 0.5, 0.2, 0.8, 0.0};
  const Paint whole = oblique::tag(oblique::tag_7_of_4x4, {}, side);
  const auto read = [&](const std::vector<Paint>& paints) {
    return read_tag(oblique::picture(camera, paints, 1), about(camera, {}, 0.0, 0), 4);
  };
  ASSERT_TRUE(read({whole}));
  EXPECT_FALSE(read({whole, oblique::disc({0.06, 0.06}, 0.02, 130.0)})) << "a corner is covered";
  EXPECT_FALSE(read({whole, oblique::disc({0.0, 0.06}, 0.012, 225.0)})) << "a part of a side is covered by white";
  EXPECT_FALSE(read({whole, oblique::disc({0.0, -0.01}, 0.014, 35.0)})) << "a cell is covered";
  std::vector<std::string> mirrored = oblique::tag_7_of_4x4, other = oblique::tag_7_of_4x4;
  for (std::string& row : mirrored) std::reverse(row.begin(), row.end());
  other[1][3] = '.';
  EXPECT_FALSE(read({oblique::tag(mirrored, {}, side)})) << "seen in a mirror";
  EXPECT_FALSE(read({oblique::tag(other, {}, side)})) << "one cell is another";
  EXPECT_FALSE(read({oblique::disc({}, 0.06, 35.0)}));
  EXPECT_FALSE(read({}));
}

/// The fewest cells in which two tags of a size differ, whichever way they are turned, as the dictionaries were made: a table with a slip
/// of the pen would not have it.
TEST(TagTables, HaveCodesFarApart) {
  const std::array<int, 4> least{3, 7, 12, 18};  // OpenCV's maxCorrectionBits of the 100s, 1, 3, 5, 8, are (least − 1)/2
  for (int cells = 4; cells <= 7; ++cells) {
    const auto& codes = tag_codes(cells);
    EXPECT_EQ(std::set<std::uint64_t>(codes.begin(), codes.end()).size(), codes.size());
    int fewest = 64;
    for (std::size_t a = 0; a < codes.size(); ++a) {
      EXPECT_EQ(codes[a] >> static_cast<unsigned>(cells * cells), 0U);
      for (std::size_t b = 0; b < a; ++b) fewest = std::min(fewest, std::popcount(codes[a] ^ codes[b]));
    }
    EXPECT_GE(fewest, least[static_cast<std::size_t>(cells - 4)]) << cells;
  }
}

}  // namespace
}  // namespace misfit
