#include "misfit/calibrate/calibrate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/error.h"
#include "tests/calibrate/sweeps.h"

namespace misfit {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double deg = std::numbers::pi / 180.0;

double off(const Calibration& c, const std::string& name, double truth) { return std::abs(c.value(name) - truth) / c.sigma(name); }

const CameraTest& test_of(const Calibration& c, const std::string& name) {
  for (const CameraTest& test : c.tests) {
    if (test.name == name) return test;
  }
  throw std::runtime_error("no test of " + name);
}

template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

Sweep first_angles(Sweep sweep, std::size_t count) {
  sweep.theta.resize(count);
  for (auto& column : sweep.P_y) column.resize(count);
  for (auto& column : sweep.P_z) column.resize(count);
  return sweep;
}

Sweep without_y(Sweep sweep) {
  for (auto& column : sweep.P_y) column.clear();
  return sweep;
}

TEST(Calibrate, EveryRecordedSweepGivesItsCamera) {
  int beyond_two_sigma = 0;
  for (const auto& world : sweeps::recorded()) {
    const Calibration c = calibrate(sweeps::read(world.name), sweeps::rig());
    EXPECT_TRUE(c.converged) << world.name << ": " << c.message;
    EXPECT_LT(off(c, "h_c", world.h_c), 3.0) << world.name;
    EXPECT_LT(off(c, "K", world.K), 3.0) << world.name;
    beyond_two_sigma += (off(c, "h_c", world.h_c) > 2.0) + (off(c, "K", world.K) > 2.0);
    EXPECT_NEAR(c.sigma_px, 0.5, 0.06) << world.name;  // measurement noise 0.5 px, 150 coordinates: ± 0.03
    EXPECT_EQ(c.outliers, 0) << world.name;
    EXPECT_EQ(c.residuals.size(), 150u);
  }
  EXPECT_LE(beyond_two_sigma, 1);
}

TEST(Calibrate, StraightCamerasTakeInNothingTheRolledOneItsRollAndCentre) {
  for (const auto& world : sweeps::recorded()) {
    const Calibration c = calibrate(sweeps::read(world.name), sweeps::rig());
    const bool rolled = std::string(world.name) == "camera_roll";
    EXPECT_EQ(c.tests.size(), 5u);
    for (const CameraTest& test : c.tests) {
      EXPECT_EQ(test.selected, rolled && (test.name == "camera_roll" || test.name == "image_centre")) << world.name << ", " << test.name;
    }
    if (!rolled) continue;
    EXPECT_NEAR(c.value("camera_roll"), 3.0 * deg, 0.1 * deg);
    EXPECT_NEAR(c.value("centre_y"), 6.0, 0.5);
    EXPECT_NEAR(c.value("centre_z"), -4.0, 0.5);
    EXPECT_LT(off(c, "camera_roll", 3.0 * deg), 3.0);
    EXPECT_LT(off(c, "centre_y", 6.0), 3.0);
    EXPECT_LT(off(c, "centre_z", -4.0), 3.0);
  }
}

TEST(Calibrate, ATenthOfThePointsDisplacedIsSetAsideAndChangesNothing) {
  for (const auto& world : sweeps::recorded()) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const double direction = seed <= 4 ? -1.0 : 90.0 * deg * (seed - 5);  // random directions, then all to one side
      const Calibration c = calibrate(sweeps::with_wild_points(sweeps::read(world.name), seed, direction), sweeps::rig());
      EXPECT_EQ(c.outliers, 8) << world.name << ", seed " << seed;
      EXPECT_LT(off(c, "h_c", world.h_c), 3.0) << world.name << ", seed " << seed;
      EXPECT_LT(off(c, "K", world.K), 3.0) << world.name << ", seed " << seed;
      EXPECT_EQ(test_of(c, "camera_roll").selected, std::string(world.name) == "camera_roll");
      EXPECT_THAT(c.notes, Contains(HasSubstr("8 of 75 points were rejected")));
    }
  }
}

// Exact pixels of a camera with every visible flaw: the estimate must be that camera.
TEST(Calibrate, ExactPixelsOfAFlawedCameraReturnIt) {
  CameraParameters<double> truth;
  truth.h_c = -0.3;
  truth.K = 90.0;
  truth.camera_roll = -0.1;
  truth.centre_y = -20.0;
  truth.centre_z = 12.0;
  truth.lens_k1 = -0.08;
  truth.camera_distance = 0.11;
  const RigGeometry rig = sweeps::rig();
  Sweep sweep;
  for (int i = -9; i <= 9; ++i) {
    const double theta = 2.0 * i * deg;
    sweep.theta.push_back(theta);
    const double c = std::cos(theta), s = std::sin(theta);
    const std::array<std::array<double, 2>, 3> at = {
        {{rig.l_p + rig.R1 * c, rig.R1 * s}, {rig.l_p - rig.R2 * c, rig.R2 * s}, {rig.l_p + rig.R3 * c, -rig.R3 * s}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = project_point<double>(truth, rig.l_b, {at[k][0], 0.0, at[k][1]});
      sweep.P_y[k].push_back(p[0]);
      sweep.P_z[k].push_back(p[1]);
    }
  }
  CalibrateOptions options;
  options.force = {"camera_roll", "image_centre", "lens_k1", "camera_distance"};
  const Calibration c = calibrate(sweep, rig, options);
  const auto expected = camera_values(truth);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(c.value(camera_parameter_names[i]), expected[i], 1e-6) << camera_parameter_names[i];
  EXPECT_LT(c.rms_px, 1e-6);
}

TEST(Calibrate, CovarianceIsTheScatterOfRepeatedMeasurements) {
  const Sweep recorded = sweeps::read("calm");
  CalibrateOptions options;
  options.candidates = {};
  const Calibration base = calibrate(recorded, sweeps::rig(), options);
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 0.5);
  double sum = 0.0, squares = 0.0, sigma = 0.0;
  const int runs = 300;
  for (int run = 0; run < runs; ++run) {
    Sweep sweep = recorded;
    for (const CalibrationResidual& r : base.residuals) {  // exact pixels and new noise
      const auto row = static_cast<std::size_t>(std::find(sweep.theta.begin(), sweep.theta.end(), r.theta) - sweep.theta.begin());
      const auto k = static_cast<std::size_t>(r.point - 1);
      (r.coordinate == 'y' ? sweep.P_y : sweep.P_z)[k][row] = r.predicted + noise(generator);
    }
    const Calibration c = calibrate(sweep, sweeps::rig(), options);
    sum += c.value("h_c");
    squares += c.value("h_c") * c.value("h_c");
    sigma += c.sigma("h_c") / runs;
  }
  const double scatter = std::sqrt(squares / runs - sum * sum / runs / runs);
  EXPECT_NEAR(scatter / sigma, 1.0, 0.13);  // three times the sampling error 1/sqrt(2·300)
  EXPECT_NEAR(sum / runs, base.value("h_c"), 3.0 * sigma / std::sqrt(runs));
}

TEST(Calibrate, VerticalPixelsAloneOfferNoRoll) {
  const Calibration c = calibrate(without_y(sweeps::read("null")), sweeps::rig());
  EXPECT_LT(off(c, "h_c", 0.1524), 3.0);
  EXPECT_LT(off(c, "K", 133.86), 3.0);
  EXPECT_EQ(c.tests.size(), 3u);
  EXPECT_THAT(test_of(c, "image_centre").parameters, testing::ElementsAre("centre_z"));
  EXPECT_THAT(c.notes, Contains(HasSubstr("camera_roll was not tested")));
  EXPECT_THAT(c.notes, Contains(HasSubstr("of image_centre only centre_z was tested")));
  EXPECT_EQ(c.residuals.size(), 75u);
}

TEST(Calibrate, WhatTheRigCannotShowIsSaid) {
  const Calibration c = calibrate(sweeps::read("camera_roll"), sweeps::rig());
  const CameraTest& aspect = test_of(c, "pixel_aspect");
  EXPECT_FALSE(aspect.selected);
  EXPECT_TRUE(std::isnan(aspect.values[0]));
  EXPECT_EQ(aspect.p_value, 1.0);
  EXPECT_THAT(c.notes, Contains(HasSubstr("cannot distinguish pixel_aspect from the other free parameters")));
  CalibrateOptions options;
  options.force = {"pixel_aspect"};
  EXPECT_THAT(message_of([&] { (void)calibrate(sweeps::read("null"), sweeps::rig(), options); }),
              HasSubstr("cannot distinguish these parameters: h_c, K, pixel_aspect"));
}

TEST(Calibrate, ParameterTakenInByHandIsFreeAndNamedWhereWeaklySeparated) {
  CalibrateOptions options;
  options.force = {"image_centre", "camera_distance"};
  options.candidates = {};
  const Calibration c = calibrate(first_angles(sweeps::read("null"), 6), sweeps::rig(), options);
  EXPECT_THAT(c.names, testing::ElementsAre("h_c", "K", "centre_y", "centre_z", "camera_distance"));
  EXPECT_GT(c.sigma("camera_distance"), 0.0);
  EXPECT_THAT(c.notes, Contains(HasSubstr("nearly collinear")));
}

TEST(Calibrate, FixedParametersStayWhereTheyAre) {
  CalibrateOptions options;
  options.candidates = {};
  options.fixed = {{"camera_roll", 3.0 * deg}, {"centre_y", 6.0}, {"centre_z", -4.0}};
  const Calibration c = calibrate(sweeps::read("camera_roll"), sweeps::rig(), options);
  EXPECT_EQ(c.value("centre_y"), 6.0);
  EXPECT_EQ(c.sigma("centre_y"), 0.0);
  EXPECT_LT(off(c, "h_c", 0.145), 3.0);
  EXPECT_NEAR(c.sigma_px, 0.5, 0.06);
}

TEST(Calibrate, MissingPixelsAreLeftOut) {
  Sweep sweep = sweeps::read("null");
  sweep.P_z[0][3] = std::numeric_limits<double>::quiet_NaN();
  sweep.P_y[2][7] = std::numeric_limits<double>::quiet_NaN();
  const Calibration c = calibrate(sweep, sweeps::rig());
  EXPECT_EQ(c.residuals.size(), 148u);
  EXPECT_LT(off(c, "K", 133.86), 3.0);
}

TEST(Calibrate, TooFewAnglesAreRefusedInWords) {
  const Sweep two = first_angles(sweeps::read("null"), 2);
  EXPECT_THROW((void)calibrate(two, sweeps::rig()), RunError);
  EXPECT_THAT(message_of([&] { (void)calibrate(two, sweeps::rig()); }),
              HasSubstr("2 different angles; a calibration needs at least three"));
  Sweep three = without_y(first_angles(sweeps::read("null"), 3));
  three.P_z[1].assign(3, std::numeric_limits<double>::quiet_NaN());
  three.P_z[2] = three.P_z[1];
  CalibrateOptions options;
  options.force = {"lens_k1", "camera_distance"};
  EXPECT_THAT(message_of([&] { (void)calibrate(three, sweeps::rig(), options); }), HasSubstr("3 usable coordinates for 4 unknowns"));
}

TEST(Calibrate, PointsThatStandStillAreRefusedInWords) {
  for (const double place : {0.0, 7.0, -250.0, 1e5}) {
    Sweep still = sweeps::read("null");
    for (auto& column : still.P_z) column.assign(still.theta.size(), place);
    for (auto& column : still.P_y) column.assign(still.theta.size(), place);
    EXPECT_THROW((void)calibrate(still, sweeps::rig()), RunError) << place;
    EXPECT_THROW((void)calibrate(without_y(still), sweeps::rig()), RunError) << place;
  }
}

TEST(Calibrate, PointsThatDoNotFollowTheAnglesAreRefusedInWords) {
  Sweep wrong = sweeps::read("null");
  for (auto& column : wrong.P_z)
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = 300.0 * std::sin(1.0 + 7919.0 * static_cast<double>(i * i));
  EXPECT_THAT(message_of([&] { (void)calibrate(without_y(wrong), sweeps::rig()); }), HasSubstr("the points do not follow the angles"));
}

TEST(Calibrate, MessagesNameTheFileOfTheSweep) {
  const Sweep two = first_angles(sweeps::read("null"), 2);
  EXPECT_THAT(message_of([&] { (void)calibrate(two, sweeps::rig()); }), HasSubstr("null.csv: the sweep has measured points at 2"));
  Sweep made = two;
  made.source.clear();
  EXPECT_THAT(message_of([&] { (void)calibrate(made, sweeps::rig()); }), testing::StartsWith("the sweep has"));
}

TEST(Calibrate, ThreeAnglesAreEnough) {
  Sweep sweep = sweeps::read("null");
  for (auto* column : {&sweep.theta, &sweep.P_y[0], &sweep.P_y[1], &sweep.P_y[2], &sweep.P_z[0], &sweep.P_z[1], &sweep.P_z[2]}) {
    *column = {column->front(), (*column)[12], column->back()};
  }
  const Calibration c = calibrate(sweep, sweeps::rig());
  EXPECT_LT(off(c, "K", 133.86), 4.0);  // 18 coordinates: t-distributed
  EXPECT_NEAR(c.value("K"), 133.86, 1.0);
}

TEST(Calibrate, WrongNamesAndImpossibleGeometryAreInputErrors) {
  CalibrateOptions options;
  options.force = {"camera_rol"};
  EXPECT_THROW((void)calibrate(sweeps::read("null"), sweeps::rig(), options), InputError);
  EXPECT_THAT(message_of([&] { (void)calibrate(sweeps::read("null"), sweeps::rig(), options); }), HasSubstr("camera_roll"));
  options = {};
  options.fixed = {{"centre_x", 1.0}};
  EXPECT_THROW((void)calibrate(sweeps::read("null"), sweeps::rig(), options), InputError);
  RigGeometry behind = sweeps::rig();
  behind.l_b = 3.0;
  EXPECT_THAT(message_of([&] { (void)calibrate(sweeps::read("null"), behind); }), HasSubstr("at or behind the camera"));
}

}  // namespace
}  // namespace misfit
