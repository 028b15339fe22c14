#include "misfit/track/sweep_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"

namespace misfit {
namespace {

struct Rig {
  std::vector<double> theta;
  std::vector<SweepPoints> truth;
  std::vector<std::vector<PixelPoint>> found;
};

/// The rig of mpf_f111 through its camera, −18 … 18 deg in steps of 1.5 deg; markers in an order that says nothing.
Rig rig() {
  Rig out;
  for (int k = -12; k <= 12; ++k) {
    const double theta = 1.5 * k * 3.14159265358979 / 180.0;
    const double x[3] = {0.31 + 3.447 * std::cos(theta), 0.31 - 0.42 * std::cos(theta), 0.31 + 2.1 * std::cos(theta)};
    const double z[3] = {3.447 * std::sin(theta), 0.42 * std::sin(theta), -2.1 * std::sin(theta)};
    SweepPoints points;
    std::vector<PixelPoint> found;
    for (std::size_t p = 0; p < 3; ++p) {
      const PixelPoint at{360.0, 360.0 + 5.69 * 133.86 * (z[p] + 0.1524) / (5.69 - x[p])};
      points[p] = at;
      found.push_back(at);
    }
    std::rotate(found.begin(), found.begin() + (k + 12) % 3, found.end());
    out.theta.push_back(theta);
    out.truth.push_back(points);
    out.found.push_back(found);
  }
  return out;
}

void expect_same(const std::vector<SweepPoints>& points, const Rig& r, std::size_t except = 1000) {
  for (std::size_t k = 0; k < r.theta.size(); ++k) {
    for (std::size_t p = 0; p < 3 && k != except; ++p) {
      ASSERT_TRUE(points[k][p]) << k << " " << p;
      EXPECT_DOUBLE_EQ(points[k][p]->row, r.truth[k][p]->row) << k << " " << p;
    }
  }
}

TEST(SweepPoints, AreToldByTheGeometryAndFollowedThroughTheCrossing) {
  const Rig r = rig();
  expect_same(assign_sweep_points(r.theta, r.found, {}), r);
}

TEST(SweepPoints, AreToldByAStart) {
  const Rig r = rig();
  expect_same(assign_sweep_points(r.theta, r.found, {*r.truth[0][0], *r.truth[0][1], *r.truth[0][2]}), r);
}

TEST(SweepPoints, OneMissingAndOneTooManyDoNoHarm) {
  Rig r = rig();
  r.found[5].erase(r.found[5].begin());
  r.found[9].push_back({20.0, 20.0});
  const auto points = assign_sweep_points(r.theta, r.found, {});
  expect_same(points, r, 5);
  int missing = 0;
  for (const auto& p : points[5]) missing += p ? 0 : 1;
  EXPECT_EQ(missing, 1);
}

TEST(SweepPoints, NoPictureWithThreeIsAnError) { EXPECT_THROW((void)assign_sweep_points({0.1, 0.2}, {{{1.0, 2.0}}, {}}, {}), RunError); }

}  // namespace
}  // namespace misfit
