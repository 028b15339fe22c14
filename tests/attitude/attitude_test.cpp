#include "misfit/attitude/attitude.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "misfit/attitude/angles.h"
#include "misfit/core/error.h"
#include "tests/paths.h"

namespace misfit {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double deg = std::numbers::pi / 180.0;
constexpr double lost = std::numeric_limits<double>::quiet_NaN();
constexpr double frame = 1.0 / 59.94;  // [s]

RigGeometry rig() {
  RigGeometry g;
  g.R = 3.447;
  g.R_cp = 3.15;
  g.V = 35.1;
  g.l_b = 5.69;
  g.l_s = 5.61;
  return g;
}

Calibration camera(CameraModel model = CameraModel::pinhole) {
  Calibration c;
  c.model = model;
  c.camera.h_c = 0.1524;
  c.camera.K = 133.86;
  c.names = {"h_c", "K"};
  c.covariance = Eigen::Vector2d(1e-3 * 1e-3, 0.2 * 0.2).asDiagonal();
  return c;
}

std::array<double, 2> pixels(const Calibration& c, double theta, double psi) {
  return project_axis(AxisCamera{c.model, c.camera, AxisGeometry{rig().R, rig().l_b, rig().l_s}}, theta, psi);
}

void append(Track& track, double t, std::array<double, 2> p, double sigma = 0.5) {
  track.t.push_back(t);
  track.P_y.push_back(p[0]);
  track.P_z.push_back(p[1]);
  track.sigma.push_back(sigma);
  track.ok.push_back(true);
}

// theta = 10° + 5° sin(6 t), psi = 8° cos(5 t), without noise.
double theta_at(double t) { return (10.0 + 5.0 * std::sin(6.0 * t)) * deg; }
double psi_at(double t) { return 8.0 * std::cos(5.0 * t) * deg; }
Track moving(int samples, double sigma = 0.5) {
  Track track;
  for (int i = 0; i < samples; ++i) append(track, i * frame, pixels(camera(), theta_at(i * frame), psi_at(i * frame)), sigma);
  return track;
}

std::size_t missing_in(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

TEST(Attitude, SmoothMotionIsReadWithItsRatesAndWindAngles) {
  const Attitude a = attitude(moving(120), camera(), rig());
  for (std::size_t i = 3; i + 3 < a.t.size(); ++i) {
    const double t = a.t[i];
    EXPECT_NEAR(a.theta[i], theta_at(t), 1e-12);
    EXPECT_NEAR(a.psi[i], psi_at(t), 1e-12);
    // The average of three points is (1 + 2 cos ωh)/3 of a sine; its derivative is exact to (ωh)⁴/30.
    const double weaker = (1.0 + 2.0 * std::cos(6.0 * frame)) / 3.0;
    EXPECT_NEAR(a.theta_mean[i], (10.0 + 5.0 * weaker * std::sin(6.0 * t)) * deg, 1e-12);
    EXPECT_NEAR(a.theta_rate[i], 30.0 * weaker * std::cos(6.0 * t) * deg, 30.0 * deg * std::pow(6.0 * frame, 4) / 30.0);
    EXPECT_NEAR(a.alpha[i], a.theta_mean[i] + 3.15 / 35.1 * std::cos(a.theta_mean[i]) * a.theta_rate[i], 1e-15);
    EXPECT_NEAR(a.beta[i], a.psi_mean[i] + 3.15 / 35.1 * std::cos(a.psi_mean[i]) * a.psi_rate[i], 1e-15);
    EXPECT_NEAR(std::cos(a.alpha_T[i]), std::cos(a.alpha[i]) * std::cos(a.beta[i]), 1e-14);
    const auto n = axis_direction(a.theta_mean[i], a.psi_mean[i]);
    EXPECT_NEAR(a.phi[i], std::atan2(n[1], n[2]), 1e-14);
    EXPECT_NEAR(std::cos(a.eta[i]), axis_direction(a.theta[i], a.psi[i])[0], 1e-14);
  }
  EXPECT_EQ(missing_in(a.theta), 0u);
  EXPECT_EQ(missing_in(a.theta_mean), 2u);
  EXPECT_EQ(missing_in(a.alpha_T), 6u);
}

TEST(Attitude, ApexExactlyOnTheAxisHasTiltZeroAndFiniteSigmas) {
  Track track;
  Calibration level = camera();
  level.camera.h_c = 0.0;
  for (int i = 0; i < 9; ++i) append(track, i * frame, {0.0, 0.0});
  const Attitude a = attitude(track, level, rig());
  EXPECT_EQ(a.alpha_T[4], 0.0);
  EXPECT_EQ(a.eta[4], 0.0);
  EXPECT_EQ(a.phi[4], 0.0);
  EXPECT_GT(a.sigma_alpha_T[4], 0.0);
  EXPECT_LT(a.sigma_alpha_T[4], 0.2 * deg);
  EXPECT_NEAR(a.sigma_phi[4], std::numbers::pi / std::sqrt(3.0), 1e-12);  // nothing is known of it
}

TEST(Attitude, TotalAngleIsExactWhereTheArcCosineIsNot) {
  EXPECT_NEAR(total_angle(3e-9, 4e-9) / 5e-9, 1.0, 1e-14);
  EXPECT_EQ(std::acos(std::cos(3e-9) * std::cos(4e-9)), 0.0);  // what is avoided
  EXPECT_NEAR(total_angle(0.3, -0.4), std::acos(std::cos(0.3) * std::cos(0.4)), 1e-15);
  EXPECT_NEAR(total_angle(2.0, 3.0), std::acos(std::cos(2.0) * std::cos(3.0)), 1e-15);
  EXPECT_EQ(total_angle(0.0, 0.0), 0.0);
}

TEST(Attitude, ClockAngleIsZeroAtPositivePitchAndGrowsTowardsPositiveYaw) {
  EXPECT_EQ(clock_angle(0.2, 0.0), 0.0);
  EXPECT_NEAR(clock_angle(0.0, 0.2), 90.0 * deg, 1e-15);
  EXPECT_NEAR(clock_angle(0.0, -0.2), -90.0 * deg, 1e-15);
  EXPECT_NEAR(std::abs(clock_angle(-0.2, 0.0)), 180.0 * deg, 1e-15);
}

// lib/misfit/README.md, 4.7: pinhole pixels read by (15), alpha_T by (17) from the angles at rest, against the tilt of the axis that was
// projected.
TEST(Attitude, EquationOneMakesTwelveDegreesTooSmall) {
  const Calibration pinhole = camera();
  Track track;
  const int turns = 720;
  for (int i = 0; i < turns; ++i) {
    const double phi = 360.0 * deg * i / turns;
    const double theta = std::atan(std::tan(12.0 * deg) * std::cos(phi));
    const double psi = std::atan(std::tan(12.0 * deg) * std::sin(phi));
    append(track, i * frame, pixels(pinhole, theta, psi));
  }
  const Attitude exact = attitude(track, pinhole, rig());
  const Attitude paper = attitude(track, camera(CameraModel::plane_by_plane), rig());
  double sum = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < track.t.size(); ++i) {
    EXPECT_NEAR(exact.eta[i], 12.0 * deg, 1e-12);
    const double error = total_angle(paper.theta[i], paper.psi[i]) - 12.0 * deg;
    sum += error;
    largest = std::min(largest, error);
  }
  EXPECT_NEAR(sum / turns / deg, -0.138, 0.001);
  EXPECT_NEAR(largest / deg, -0.309, 0.001);
}

TEST(Attitude, LostSamplesAreGapsOfSevenAndNeverBridged) {
  Track track = moving(60);
  track.ok[30] = false;
  track.P_y[30] = track.P_z[30] = lost;
  const Attitude a = attitude(track, camera(), rig());
  for (std::size_t i = 0; i < 60; ++i) {
    const auto away = static_cast<std::size_t>(std::abs(static_cast<int>(i) - 30));
    EXPECT_EQ(std::isnan(a.theta[i]), away == 0) << i;
    EXPECT_EQ(std::isnan(a.sigma_theta[i]), away == 0) << i;
    EXPECT_EQ(std::isnan(a.theta_mean[i]), away <= 1 || i == 0 || i == 59) << i;
    EXPECT_EQ(std::isnan(a.phi[i]), away <= 1 || i == 0 || i == 59) << i;
    EXPECT_EQ(std::isnan(a.alpha_T[i]), away <= 3 || i < 3 || i > 56) << i;
    EXPECT_EQ(std::isnan(a.sigma_alpha_T[i]), std::isnan(a.alpha_T[i])) << i;
  }
  EXPECT_THAT(a.notes, Contains(HasSubstr("1 of 60 samples is lost in the track")));
}

TEST(Attitude, RowThatIsMissingAltogetherIsAGapToo) {
  Track track = moving(60);
  track.t.erase(track.t.begin() + 30);
  track.P_y.erase(track.P_y.begin() + 30);
  track.P_z.erase(track.P_z.begin() + 30);
  track.sigma.pop_back();
  track.ok.pop_back();
  const Attitude a = attitude(track, camera(), rig());
  EXPECT_EQ(missing_in(a.theta), 0u);
  EXPECT_EQ(missing_in(a.theta_mean), 4u);  // the ends and both sides of the gap
  EXPECT_EQ(missing_in(a.alpha_T), 12u);
  EXPECT_THAT(a.notes, Contains(HasSubstr("1 step differs")));
}

TEST(Attitude, RatesOfSlightlyUnevenTimesAreThoseOfThePolynomial) {
  Track track;
  std::mt19937 generator(5);
  for (int i = 0; i < 40; ++i) {
    const double t = (i + 0.08 * (static_cast<double>(generator()) / 4294967296.0 - 0.5)) * frame;
    append(track, t, pixels(camera(), 0.1 + 0.5 * t, -0.2 * t));
  }
  const Attitude a = attitude(track, camera(), rig());
  EXPECT_EQ(missing_in(a.theta_rate), 6u);
  // The averages themselves stand up to 0.027 steps beside their time: 3 % of the rate between neighbours.
  for (std::size_t i = 3; i < 37; ++i) EXPECT_NEAR(a.theta_rate[i], 0.5, 0.5 * 0.06) << i;
}

TEST(Attitude, PixelsThatNoAngleExplainsAreLostAndSaid) {
  Track track = moving(40);
  track.P_z[20] = 5000.0;
  const Attitude a = attitude(track, camera(), rig());
  EXPECT_TRUE(std::isnan(a.theta[20]));
  EXPECT_THAT(a.notes, Contains(HasSubstr("1 of 40 samples is lost because no angle explains its pixels")));
  for (double& p : track.P_z) p = 5000.0;
  EXPECT_THROW((void)attitude(track, camera(), rig()), RunError);
}

TEST(Attitude, ImpossibleGeometryIsAnInputError) {
  RigGeometry g = rig();
  g.l_s = 3.0;
  EXPECT_THROW((void)attitude(moving(10), camera(), g), InputError);
  g = rig();
  g.V = 0.0;
  EXPECT_THROW((void)attitude(moving(10), camera(), g), InputError);
}

TEST(Attitude, ShortRecordHasAnglesButNoWindAngles) {
  const Attitude one = attitude(moving(1), camera(), rig());
  EXPECT_NEAR(one.theta[0], theta_at(0.0), 1e-12);
  EXPECT_TRUE(std::isnan(one.alpha_T[0]));
  const Attitude six = attitude(moving(6), camera(), rig());
  EXPECT_EQ(missing_in(six.alpha_T), 6u);
}

// Scatter of one sample's values over repeated measurements [rad]: measurement noise `pixel`, and calibration errors where `with_camera`.
struct Scatter {
  double theta, phi, alpha_T;
};
Scatter scatter(double pixel, bool with_camera, std::size_t at) {
  const Track clean = moving(13);
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  const int runs = 2000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int run = 0; run < runs; ++run) {
    Track track = clean;
    for (std::size_t i = 0; i < track.t.size(); ++i) {
      track.P_y[i] += pixel * normal(generator);
      track.P_z[i] += pixel * normal(generator);
    }
    Calibration c = camera();
    if (with_camera) {
      c.camera.h_c += 1e-3 * normal(generator);
      c.camera.K += 0.2 * normal(generator);
    }
    const Attitude a = attitude(track, c, rig());
    const Eigen::Vector3d values(a.theta[at], a.phi[at], a.alpha_T[at]);
    sum += values;
    squares += values.cwiseProduct(values);
  }
  const Eigen::Vector3d sigma = (squares / runs - (sum / runs).cwiseProduct(sum / runs)).cwiseSqrt();
  return {sigma[0], sigma[1], sigma[2]};
}

TEST(Attitude, SigmasAreTheScatterOfRepeatedMeasurements) {
  const std::size_t at = 6;
  const double tolerance = 3.0 / std::sqrt(2.0 * 2000.0);  // three times the sampling error of a standard deviation
  for (const bool with_camera : {false, true}) {
    Calibration c = camera();
    if (!with_camera) c.covariance.setZero();
    const double pixel = with_camera ? 0.1 : 0.5;
    const Attitude a = attitude(moving(13, pixel), c, rig());
    const Scatter seen = scatter(pixel, with_camera, at);
    EXPECT_NEAR(seen.theta / a.sigma_theta[at], 1.0, tolerance);
    EXPECT_NEAR(seen.phi / a.sigma_phi[at], 1.0, tolerance);
    EXPECT_NEAR(seen.alpha_T / a.sigma_alpha_T[at], 1.0, tolerance);
  }
}

TEST(Attitude, UnknownMeasurementNoiseIsEstimatedAndSaid) {
  const Track track = read_track(paths::source() / "tests/data/tracks/calm_head.csv");  // white noise of 0.5 px
  const Attitude a = attitude(track, camera(), rig());
  Track known = track;
  known.sigma.assign(known.t.size(), 0.5);
  const Attitude b = attitude(known, camera(), rig());
  EXPECT_NEAR(a.sigma_alpha_T[400] / b.sigma_alpha_T[400], 1.0, 0.1);
  EXPECT_THAT(a.notes, Contains(HasSubstr("estimated from sixth differences")));
  EXPECT_THAT(b.notes, testing::Not(Contains(HasSubstr("estimated from sixth differences"))));
}

TEST(Attitude, TooShortToEstimateTheNoiseLeavesSigmasEmpty) {
  const Attitude a = attitude(moving(12, lost), camera(), rig());
  EXPECT_TRUE(std::isfinite(a.alpha_T[6]));
  EXPECT_TRUE(std::isnan(a.sigma_alpha_T[6]));
  EXPECT_THAT(a.notes, Contains(HasSubstr("too few samples in a row")));
}

}  // namespace
}  // namespace misfit
