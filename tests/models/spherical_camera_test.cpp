// The spherical parachute's pixels against the camera, and the effects that say the camera is not as calibrated.
#include <gtest/gtest.h>

#include <cmath>

#include "misfit/math/camera.h"
#include "tests/models/spherical.h"

namespace misfit {
namespace {

using namespace testing_spherical;

TEST(SphericalCamera, PixelsAreThoseOfTheCamera) {
  for (bool plane_by_plane : {false, true}) {
    ModelRequest r = spherical();
    r.options.flags["plane_by_plane"] = plane_by_plane;
    const std::map<std::string, double> camera = {
        {"h_c", 0.15},      {"K", 131.0},           {"camera_roll", 0.05}, {"centre_y", 6.0},
        {"centre_z", -4.0}, {"pixel_aspect", 0.02}, {"lens_k1", -0.1},     {"camera_distance", 0.03}};
    for (const auto& [name, value] : camera) r.constants[name] = value;
    const Model m = assemble(r, registry());
    Evaluator evaluator(m);
    const CameraParameters<double> c{0.15, 131.0, 0.05, 6.0, -4.0, 0.02, -0.1, 0.03};
    for (const State& x : some_states) {
      double pixels[3];
      evaluator.predict(x.data(), nullptr, 0.0, pixels);
      const auto expected =
          project_axis(AxisCamera{plane_by_plane ? CameraModel::plane_by_plane : CameraModel::pinhole, c, AxisGeometry{3.447, 5.69, 5.61}},
                       std::atan2(x[1], n_x(x)), std::atan2(x[0], n_x(x)));
      EXPECT_NEAR(pixels[0], expected[0], 1e-9);
      EXPECT_NEAR(pixels[1], expected[1], 1e-9);
      State read{};
      const std::vector<double> k = m.values();
      ASSERT_TRUE(m.system->read_states(pixels, k.data(), read.data()));
      EXPECT_NEAR(read[0], x[0], 1e-9);
      EXPECT_NEAR(read[1], x[1], 1e-9);
    }
  }
}

/// Each error of the camera as an effect is the camera with that error.
TEST(SphericalCamera, CameraEffectsAreTheCameraWithThatParameterChanged) {
  struct Pair {
    std::string kind, error, constant;
    double value, tolerance;
  };
  const std::vector<Pair> pairs = {
      {"camera_roll", "roll_error", "camera_roll", 0.04, 1e-9},   {"image_centre", "centre_y_error", "centre_y", 5.0, 1e-9},
      {"image_centre", "centre_z_error", "centre_z", -3.0, 1e-9}, {"scale_error", "K_error", "K", 2.0, 1e-9},
      {"camera_height_error", "h_c_error", "h_c", 0.02, 1e-9},    {"pixel_aspect", "aspect_error", "pixel_aspect", 0.03, 1e-9},
      {"lens_distortion", "k1_error", "lens_k1", -0.02, 1e-9}};
  for (const auto& pair : pairs) {
    ModelRequest r = spherical({effect(pair.kind)});
    r.constants["centre_y"] = 7.0;
    r.constants["centre_z"] = -9.0;
    if (pair.kind == "camera_height_error") r.constants["camera_roll"] = 0.1;
    Model wrong = assemble(r, registry()), changed = wrong;
    set(wrong, pair.error, pair.value);
    const auto index = static_cast<std::size_t>(changed.find_parameter(pair.constant));
    changed.parameters[index].value += pair.value;
    Evaluator a(wrong), b(changed), c(changed);
    for (const State& x : some_states) {
      double by_effect[3], by_camera[3];
      a.predict(x.data(), nullptr, 0.0, by_effect);
      b.predict(x.data(), nullptr, 0.0, by_camera);
      EXPECT_NEAR(by_effect[0], by_camera[0], pair.tolerance) << pair.error;
      EXPECT_NEAR(by_effect[1], by_camera[1], pair.tolerance) << pair.error;
    }
  }
}

}  // namespace
}  // namespace misfit
