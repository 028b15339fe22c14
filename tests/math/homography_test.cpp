// A camera written out again (rotation, focal length, distance) looks obliquely at a plane; the map that is fitted to its pixels is right.
#include "misfit/math/homography.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace misfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr PictureSize picture{640.0, 480.0};

/// Two metres before the plane z = 0, turned by 35 degrees about the vertical and 15 about the horizontal; a lens with this k1.
Vector2d seen(const Vector2d& place, double k1 = 0.0) {
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd(0.26, Vector3d::UnitX()) * Eigen::AngleAxisd(0.61, Vector3d::UnitY())).toRotationMatrix();
  const Vector3d v = turned * Vector3d(place.x(), -place.y(), 0.0) + Vector3d(0.05, 0.02, 2.0);
  const Vector2d d = 700.0 * v.head<2>() / v.z();
  const double r = d.norm() / 400.0;
  return Vector2d(319.5, 239.5) + d * (1.0 + k1 * r * r);
}

std::vector<PlanePoint> grid(int columns, int rows, double k1 = 0.0, double noise = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, noise > 0.0 ? noise : 1.0);
  std::vector<PlanePoint> out;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const Vector2d place(-0.6 + 1.2 * i / (columns - 1), -0.5 + j / (rows - 1.0));
      Vector2d pixel = seen(place, k1);
      if (noise > 0.0) pixel += Vector2d(error(random), error(random));
      out.push_back({place, pixel});
    }
  }
  return out;
}

PlaneFit fitted(const std::vector<PlanePoint>& points) {
  std::string why;
  const auto fit = fit_plane(points, picture, why);
  EXPECT_TRUE(fit) << why;
  return fit.value_or(PlaneFit{});
}

std::string refusal(const std::vector<PlanePoint>& points) {
  std::string why;
  EXPECT_FALSE(fit_plane(points, picture, why));
  return why;
}

TEST(MapOfAPlane, SeenObliquelyIsExactWhereThePointsAre) {
  for (const auto& points : {grid(2, 2), grid(4, 3)}) {
    const PlaneFit fit = fitted(points);
    EXPECT_LT(fit.rms, 1e-6);
    EXPECT_EQ(fit.map.k1, 0.0);
    for (const Vector2d& place : {Vector2d(0.1, 0.2), Vector2d(-0.7, 0.55), Vector2d(0.8, -0.6)}) {
      const auto back = fit.map.place(seen(place));
      ASSERT_TRUE(back);
      EXPECT_LT((*back - place).norm(), 1e-8);
      EXPECT_LT((*fit.map.pixel(place) - seen(place)).norm(), 1e-5);
    }
  }
}

TEST(MapOfAPlane, HasTheSlopeOfItsDifferences) {
  const PlaneMap map = fitted(grid(6, 5, -0.2)).map;
  const Vector2d at(0.3, -0.2);
  constexpr double h = 1e-6;
  for (int i = 0; i < 2; ++i) {
    const Vector2d difference = (*map.pixel(at + h * Vector2d::Unit(i)) - *map.pixel(at - h * Vector2d::Unit(i))) / (2.0 * h);
    EXPECT_LT((map.slope(at).col(i) - difference).norm(), 1e-4) << "px/m, of some 300";
  }
}

TEST(MapOfAPlane, SaysHowUncertainItsPlacesAre) {
  double squares = 0.0;
  constexpr int runs = 200;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const PlaneFit fit = fitted(grid(4, 3, 0.0, 0.3, seed));
    const Vector2d place(0.4, 0.3);
    const Vector2d error = *fit.map.place(seen(place)) - place;
    squares += 0.5 * error.squaredNorm() / std::pow(fit.sigma_at(place), 2.0) / runs;
  }
  // 16 degrees of freedom: the mean of F(2, 16) is 16/14, its standard deviation over √200 runs 0.09.
  EXPECT_NEAR(squares, 16.0 / 14.0, 0.3);
}

TEST(MapOfAPlane, CarriesAPixelsSigmaToMetres) {
  const PlaneMap map = fitted(grid(4, 3)).map;
  const Vector2d place(0.5, 0.2), pixel = seen(place);
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, 0.2);
  double squares = 0.0;
  constexpr int runs = 4000;
  for (int k = 0; k < runs; ++k) squares += 0.5 * (*map.place(pixel + Vector2d(error(random), error(random))) - place).squaredNorm() / runs;
  EXPECT_NEAR(std::sqrt(2.0 * squares) / map.sigmas_at(place, 0.2).norm(), 1.0, 0.05);
}

TEST(MapOfAPlane, FindsTheLensWhereThePointsAllowIt) {
  const PlaneFit fit = fitted(grid(6, 5, -0.15, 0.1));
  EXPECT_NEAR(fit.map.k1, -0.15, 0.01);
  const Vector2d place(-0.3, 0.4);
  EXPECT_LT((*fit.map.place(seen(place, -0.15)) - place).norm(), 4.0 * fit.sigma_at(place) + 1e-9);
  EXPECT_EQ(fitted(grid(3, 3, -0.15)).map.k1, 0.0) << "nine points are too few";
  EXPECT_EQ(fitted(grid(6, 5, 0.0, 0.3)).map.k1, 0.0) << "there is none to be found";
}

TEST(MapOfAPlane, IsRefusedInWordsWhereThePointsDetermineNone) {
  EXPECT_THAT(refusal({{{0, 0}, {0, 0}}, {{1, 0}, {10, 0}}, {{0, 1}, {0, 10}}}), testing::HasSubstr("four points"));
  std::vector<PlanePoint> line;
  for (double x : {0.0, 0.1, 0.2, 0.4, 0.5}) line.push_back({{x, 2.0 * x}, seen({x, 2.0 * x})});
  EXPECT_THAT(refusal(line), testing::HasSubstr("on one line"));
  line.push_back({{0.3, 0.0}, seen({0.3, 0.0})});
  EXPECT_THAT(refusal(line), testing::HasSubstr("or all but one"));
  std::vector<PlanePoint> exchanged = grid(2, 2);
  std::swap(exchanged[0].pixel, exchanged[1].pixel);
  EXPECT_THAT(refusal(exchanged), testing::HasSubstr("exchanged"));
}

TEST(MapOfAPlane, HasNoPlacesBeyondTheHorizon) {
  const PlaneMap map = fitted(grid(2, 2)).map;
  // The plane's normal is seen from the side: far enough to one side of the picture no ray meets the plane.
  int none = 0;
  for (double column : {-1e5, 1e5}) none += map.place({column, 240.0}) ? 0 : 1;
  EXPECT_EQ(none, 1);
}

}  // namespace
}  // namespace misfit
