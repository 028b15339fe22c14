#include "misfit/track/locate.h"

#include <gtest/gtest.h>

#include "misfit/track/survey.h"
#include "tests/track/pictures.h"

namespace misfit {
namespace {

using namespace pictures;

/// Finds the one marker of many pictures with random places: RMS error and error over sigma.
void expect_sub_pixel(MarkerKind k, const Disc& disc, int row_step) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  double squares = 0.0, z = 0.0, sigma = 0.0;
  constexpr int trials = 60;
  for (int n = 0; n < trials; ++n) {
    Disc d = disc;
    d.at = {80.0 + shift(random), 70.0 + shift(random)};
    const Field field = noisy_picture({d}, 160, 140, row_step == 2 ? n % 2 : 0, row_step, 3.0, static_cast<unsigned>(n + 1));
    const auto found = find_markers(field, kind(k), 3);
    ASSERT_EQ(found.size(), 1U);
    const double x = found[0].at.column - d.at.column, y = found[0].at.row - d.at.row;
    squares += 0.5 * (x * x + y * y) / trials;
    z += 0.5 * (x * x + y * y) / (found[0].sigma * found[0].sigma) / trials;
    sigma += found[0].sigma * found[0].sigma / trials;
    EXPECT_NEAR(found[0].outer, d.outer, 0.15 + 0.03 * d.outer);
  }
  std::printf("%s of %.0f px, lines %d apart: RMS %.4f px, error/sigma %.2f\n", name_of(k), 2.0 * disc.outer, row_step, std::sqrt(squares),
              std::sqrt(z));
  EXPECT_LT(std::sqrt(squares), 0.05);
  EXPECT_LT(std::sqrt(z), 1.5);
  EXPECT_LT(std::sqrt(sigma), 1.5 * std::sqrt(squares) + 0.01);  // 0.01 px is the least that locate() states
}

TEST(Locate, RingsOfAllSizesInFramesAndFields) {
  for (double radius : {4.0, 7.0, 11.0, 15.0})
    for (int step : {1, 2}) expect_sub_pixel(MarkerKind::ring, {{}, radius, 0.45 * radius, 235.0, 40.0}, step);
}

TEST(Locate, BrightAndDarkDiscs) {
  expect_sub_pixel(MarkerKind::bright, {{}, 6.0, 0.0, 220.0, 0.0}, 1);
  expect_sub_pixel(MarkerKind::dark, {{}, 9.0, 0.0, 30.0, 0.0}, 2);
}

void expect_slopes(const Marker& marker, double x, double y) {
  constexpr double h = 1e-6;
  const ShapeValue s = shape_at(marker, x, y), right = shape_at(marker, x + h, y), left = shape_at(marker, x - h, y),
                   below = shape_at(marker, x, y + h), above = shape_at(marker, x, y - h);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(s.by_x[k], (right.value[k] - left.value[k]) / (2.0 * h), 1e-5 * (1.0 + std::abs(s.by_x[k])));
    EXPECT_NEAR(s.by_y[k], (below.value[k] - above.value[k]) / (2.0 * h), 1e-5 * (1.0 + std::abs(s.by_y[k])));
  }
}

TEST(Locate, ShapesDifferentiateAsTheySay) {
  Marker ring = nominal_marker(MarkerKind::ring, 20.0);
  ring.edge = 2.0;
  Marker picture;
  picture.kind = MarkerKind::picture;
  picture.picture = noisy_picture({{{15.0, 14.0}, 9.0, 4.0}}, 31, 29).image;
  for (const Marker& marker : {ring, picture}) {
    for (double x : {-9.7, -4.2, 0.31, 4.9, 9.3}) {
      for (double y : {-8.1, 0.27, 3.9}) expect_slopes(marker, x, y);
    }
  }
}

TEST(FindMarkers, RingsAmongDiscsAreToldApart) {
  const Field field = noisy_picture({{{40.0, 40.0}, 9.0, 4.0}, {{100.0, 50.0}, 9.0, 0.0}, {{150.0, 120.0}, 9.0, 4.0}});
  EXPECT_EQ(find_markers(field, kind(MarkerKind::ring), 5).size(), 2U);
}

TEST(FindMarkers, NothingIsFoundInNoise) {
  for (MarkerKind k : {MarkerKind::ring, MarkerKind::bright, MarkerKind::dark})
    EXPECT_TRUE(find_markers(noisy_picture({}, 200, 160, 0, 1, 25.0), kind(k), 5).empty()) << name_of(k);
}

TEST(FindMarkers, OneThatLeavesTheFrameIsNone) {
  EXPECT_TRUE(find_markers(noisy_picture({{{3.0, 60.0}, 9.0, 4.0}}), kind(MarkerKind::ring), 5).empty());
}

}  // namespace
}  // namespace misfit
