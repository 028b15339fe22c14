#include "misfit/math/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/math/scalar.h"

namespace misfit {
namespace {

constexpr double deg = std::numbers::pi / 180.0;
constexpr AxisGeometry rig{3.447, 5.69, 5.61};

CameraParameters<double> plain_camera() {
  CameraParameters<double> c;
  c.h_c = 0.1524;
  c.K = 133.86;
  return c;
}

CameraParameters<double> awkward_camera(double k1) {
  CameraParameters<double> c = plain_camera();
  c.camera_roll = 3.0 * deg;
  c.centre_y = 6.0;
  c.centre_z = -4.0;
  c.pixel_aspect = 0.02;
  c.lens_k1 = k1;
  c.camera_distance = 0.05;
  return c;
}

// Largest |read(project(angles)) − angles| over ±25 deg in both planes [rad].
double worst_round_trip(CameraModel model, const CameraParameters<double>& c) {
  double worst = 0.0;
  for (double theta = -25.0; theta <= 25.0; theta += 2.5) {
    for (double psi = -25.0; psi <= 25.0; psi += 2.5) {
      const auto p = project_axis(AxisCamera{model, c, rig}, theta * deg, psi * deg);
      const auto read = read_axis(AxisCamera{model, c, rig}, p[0], p[1]);
      if (!read) return 1e9;
      worst = std::max({worst, std::abs((*read)[0] - theta * deg), std::abs((*read)[1] - psi * deg)});
    }
  }
  return worst;
}

TEST(Camera, ReadingUndoesProjectionForBothModelsAndAllParameters) {
  for (const CameraModel model : {CameraModel::plane_by_plane, CameraModel::pinhole}) {
    EXPECT_LT(worst_round_trip(model, plain_camera()), 1e-12);
    EXPECT_LT(worst_round_trip(model, awkward_camera(0.2)), 1e-12);
    EXPECT_LT(worst_round_trip(model, awkward_camera(-0.1)), 1e-12);
  }
}

TEST(Camera, PlaneByPlaneIsThePapersEquationOne) {
  const auto c = plain_camera();
  const double theta = 12.0 * deg;
  const auto p = project_axis(AxisCamera{CameraModel::plane_by_plane, c, rig}, theta, 0.0);
  EXPECT_NEAR((3.447 * std::sin(theta) + 0.1524) / (5.61 - 3.447 * std::cos(theta)), p[1] / (5.69 * 133.86), 1e-14);
  EXPECT_EQ(p[0], 0.0);  // h_c = 0 in the x-y plane
}

TEST(Camera, ModelsAgreeInThePitchPlaneAndPartOffIt) {
  const auto c = plain_camera();
  const auto a = project_axis(AxisCamera{CameraModel::plane_by_plane, c, rig}, 12.0 * deg, 0.0);
  const auto b = project_axis(AxisCamera{CameraModel::pinhole, c, rig}, 12.0 * deg, 0.0);
  EXPECT_NEAR(a[1], b[1], 1e-10);
  const auto off_a = project_axis(AxisCamera{CameraModel::plane_by_plane, c, rig}, 9.0 * deg, 9.0 * deg);
  const auto off_b = project_axis(AxisCamera{CameraModel::pinhole, c, rig}, 9.0 * deg, 9.0 * deg);
  EXPECT_GT(std::abs(off_a[1] - off_b[1]), 1.0);
}

TEST(Camera, AxisDirectionHasTheAnglesItWasMadeOf) {
  const auto n = axis_direction(0.3, -0.4);
  EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0, 1e-15);
  EXPECT_NEAR(std::atan2(n[2], n[0]), 0.3, 1e-15);
  EXPECT_NEAR(std::atan2(n[1], n[0]), -0.4, 1e-15);
}

TEST(Camera, EachParameterDoesWhatItsNameSays) {
  CameraParameters<double> c;
  c.K = 100.0;
  const double focal = 500.0;
  c.camera_roll = 90.0 * deg;
  auto p = to_image(c, focal, 0.0, 10.0);  // a point below the centre
  EXPECT_NEAR(p[0], -10.0, 1e-12);
  EXPECT_NEAR(p[1], 0.0, 1e-12);
  c = {};
  c.pixel_aspect = 0.1;
  c.centre_y = 5.0;
  c.centre_z = -2.0;
  p = to_image(c, focal, 100.0, 50.0);
  EXPECT_NEAR(p[0], 115.0, 1e-12);
  EXPECT_NEAR(p[1], 48.0, 1e-12);
  c = {};
  c.lens_k1 = 0.5;
  p = to_image(c, focal, 300.0, 400.0);  // r = 1: stretched by one half
  EXPECT_NEAR(p[0], 450.0, 1e-12);
  EXPECT_NEAR(p[1], 600.0, 1e-12);
  c = {};
  c.K = 100.0;
  c.h_c = 0.1;
  c.camera_distance = 1.0;
  p = project_point<double>(c, 5.0, {2.0, 0.4, 0.3});  // depth 5 + 1 − 2
  EXPECT_NEAR(p[0], 50.0, 1e-12);
  EXPECT_NEAR(p[1], 50.0, 1e-12);
}

TEST(Camera, PixelThatNoAngleExplainsIsNoAngle) {
  for (const CameraModel model : {CameraModel::plane_by_plane, CameraModel::pinhole}) {
    EXPECT_FALSE(read_axis(AxisCamera{model, plain_camera(), rig}, 0.0, 5000.0));
    EXPECT_FALSE(read_axis(AxisCamera{model, plain_camera(), rig}, 5000.0, 0.0));
    EXPECT_FALSE(read_axis(AxisCamera{model, plain_camera(), rig}, 0.0, std::nan("")));
    EXPECT_FALSE(read_axis(AxisCamera{model, awkward_camera(-3.0), rig}, 0.0, 300.0));  // the lens folds back before this radius
  }
}

TEST(Camera, DerivativesOfTheReadingAreThoseOfFiniteDifferences) {
  using J = Jet<3>;
  const auto c = awkward_camera(-0.1);
  for (const CameraModel model : {CameraModel::plane_by_plane, CameraModel::pinhole}) {
    const auto p = project_axis(AxisCamera{model, c, rig}, 0.2, -0.15);
    CameraParameters<J> cj;
    cj.h_c = J(c.h_c);
    cj.K = J(c.K);
    cj.camera_roll = J(c.camera_roll);
    cj.centre_y = J(c.centre_y);
    cj.centre_z = J(c.centre_z);
    cj.pixel_aspect = J(c.pixel_aspect);
    cj.lens_k1 = J(c.lens_k1, 2);
    cj.camera_distance = J(c.camera_distance);
    const auto read = read_axis(AxisCamera{model, cj, rig}, J(p[0], 0), J(p[1], 1));
    ASSERT_TRUE(read);
    const double h = 1e-4;
    const auto up = *read_axis(AxisCamera{model, c, rig}, p[0], p[1] + h);
    const auto down = *read_axis(AxisCamera{model, c, rig}, p[0], p[1] - h);
    auto more = c;
    more.lens_k1 += 1e-6;
    auto less = c;
    less.lens_k1 -= 1e-6;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR((*read)[i].v[1], (up[i] - down[i]) / (2.0 * h), 1e-10);
      const double slope =
          ((*read_axis(AxisCamera{model, more, rig}, p[0], p[1]))[i] - (*read_axis(AxisCamera{model, less, rig}, p[0], p[1]))[i]) / 2e-6;
      EXPECT_NEAR((*read)[i].v[2], slope, 1e-8);
    }
  }
}

}  // namespace
}  // namespace misfit
