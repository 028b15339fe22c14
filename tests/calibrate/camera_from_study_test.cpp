#include "misfit/calibrate/camera_from_study.h"

#include <gtest/gtest.h>

#include "misfit/core/error.h"

namespace misfit {
namespace {

config::Number number(double value) {
  config::Number n;
  n.value = value;
  return n;
}

config::Number number(double value, double sigma) {
  config::Number n = number(value);
  n.sigma = sigma;
  return n;
}

TEST(CameraAsGiven, SigmasBecomeADiagonalCovariance) {
  const Calibration c = camera_from_study(CameraModel::pinhole,
                                          {{"K", number(133.86, 1.969)}, {"h_c", number(0.1524, 0.0254)}, {"camera_roll", number(0.01)}});
  EXPECT_EQ(c.value("K"), 133.86);
  EXPECT_NEAR(c.sigma("K"), 1.969, 1e-12);
  EXPECT_NEAR(c.sigma("h_c"), 0.0254, 1e-12);
  EXPECT_EQ(c.value("camera_roll"), 0.01);
  EXPECT_EQ(c.sigma("camera_roll"), 0.0);
  EXPECT_EQ(c.covariance(0, 1), 0.0);
  EXPECT_EQ(c.notes.size(), 1u);
}

TEST(CameraAsGiven, WhatIsMissingOrImpossibleIsAnInputError) {
  EXPECT_THROW((void)camera_from_study(CameraModel::pinhole, {{"K", number(130.0)}}), InputError);
  EXPECT_THROW((void)camera_from_study(CameraModel::pinhole, {{"K", number(-1.0)}, {"h_c", number(0.1)}}), InputError);
  EXPECT_THROW((void)camera_from_study(CameraModel::pinhole, {{"K", number(130.0, -1.0)}, {"h_c", number(0.1)}}), InputError);
  EXPECT_THROW((void)camera_from_study(CameraModel::pinhole, {{"K", number(130.0)}, {"h_c", number(0.1)}, {"roll", number(0.1)}}),
               InputError);
}

}  // namespace
}  // namespace misfit
