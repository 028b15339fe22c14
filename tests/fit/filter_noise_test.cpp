#include "misfit/fit/filter/filter_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// Covariance of dz = A z dt + noise of intensity D over a step, from one matrix exponential (C. F. Van Loan, IEEE TAC 23 (1978)).
Eigen::MatrixXd van_loan(const Eigen::MatrixXd& A, const Eigen::MatrixXd& D, double h) {
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  M << -A, D, Eigen::MatrixXd::Zero(n, n), A.transpose();
  const Eigen::MatrixXd E = exponential(M * h);
  return E.bottomRightCorner(n, n).transpose() * E.topRightCorner(n, n);
}

TEST(Discretise, RandomForceOnAFreeMassIsVanLoans) {
  for (const double h : {0.002, 0.0167, 0.1, 0.2, 0.5}) {
    const double accuracy = h <= 0.2 ? 1e-9 : 1e-7;  // eight-point quadrature over the step: two and five correlation times
    const FilterNoise noise{27.0, 0.1, {}};
    Eigen::Matrix3d A, D = Eigen::Matrix3d::Zero();  // force, rate, level
    A << -10.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    D(0, 0) = 2.0 * 27.0 * 27.0 / 0.1;
    const Eigen::MatrixXd Q = van_loan(A, D, h), Phi = exponential(A * h);
    const NoiseStep step = discretise(noise, h);
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        const double left = i == 0 ? 1.0 : Phi(i, 0), right = j == 0 ? 1.0 : Phi(j, 0);
        const double scale = std::sqrt(Q(i, i) * Q(j, j));
        EXPECT_NEAR(step.m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * left * right, Q(i, j), accuracy * scale)
            << h << i << j;
      }
    }
  }
}

TEST(Discretise, ForceAloneKeepsItsVariance) {
  const NoiseStep step = discretise({5.0, 0.1, {}}, 0.03);
  EXPECT_NEAR(25.0 * std::exp(-0.6) + step.m[0][0], 25.0, 1e-9);
}

TEST(Discretise, ColouredNoiseIsStationaryWithTheCorrelationOfADampedResonance) {
  const ChannelNoise channel{0.5, 1.3, 9.0, 0.2};
  constexpr double h = 1.0 / 59.94;
  const NoiseStep step = discretise({1.0, 0.1, {channel}}, h);
  const auto& p = step.coloured[0].phi;
  const auto& q = step.coloured[0].q;
  Eigen::Matrix2d F, Q;
  F << p[0], p[1], p[2], p[3];
  Q << q[0], q[1], q[1], q[2];
  const Eigen::Matrix2d G = 1.3 * 1.3 * Eigen::Matrix2d::Identity();
  EXPECT_LT((F * G * F.transpose() + Q - G).norm(), 1e-12);
  const double w = 2.0 * std::numbers::pi * 9.0, d = w * std::sqrt(1.0 - 0.04);
  EXPECT_NEAR(F(0, 0), std::exp(-0.2 * w * h) * (std::cos(d * h) + 0.2 * w / d * std::sin(d * h)), 1e-12) << "autocorrelation at one step";
  Eigen::Matrix2d A, D = Eigen::Matrix2d::Zero();  // of (j, j'/w)
  A << 0.0, w, -w, -0.4 * w;
  D(1, 1) = 4.0 * 0.2 * w * 1.3 * 1.3;
  EXPECT_LT((van_loan(A, D, h) - Q).norm(), 1e-10);
}

TEST(NoiseVector, KeepsTheForcesOfEveryUnitOfPorts) {
  SystemSpec spec;
  spec.outputs = {{.name = "speed", .unit = "rad/s", .noise = 0.1}, {.name = "current", .unit = "A", .noise = 0.02}};
  const FilterNoise noise{3.0, 0.2, {{0.1, 0.3, 8.0, 0.4}, {0.02, 0.05, 20.0, 0.2}}, false, {0.7, 11.0}};
  const NoiseVector packed = pack(noise, spec, noise);
  ASSERT_EQ(packed.value.size(), packed.names.size());
  const FilterNoise again = unpack(packed.value, spec);
  EXPECT_THAT(again.further_forces, testing::ElementsAre(testing::DoubleNear(0.7, 1e-15), testing::DoubleNear(11.0, 1e-14)));
  EXPECT_NEAR(again.force, 3.0, 1e-15);
  EXPECT_NEAR(again.channels[1].coloured_frequency, 20.0, 1e-13);
  for (int group = 0; group < 3; ++group)
    EXPECT_NEAR(packed.value[place_of_force(group, spec)], std::log(noise.force_of(group)), 1e-15) << group;
}

TEST(NoiseVector, WhiteNoiseIsNoLessThanThatOfReadingsInWholeSteps) {
  SystemSpec spec;
  spec.outputs = {{.name = "angle", .unit = "rad", .noise = 0.1}};
  FilterNoise noise{3.0, 0.2, {{0.01, 0.3, 8.0, 0.4}}};
  FilterNoise reference = noise;
  reference.channels[0].rounding = 0.005;
  EXPECT_NEAR(pack(noise, spec, reference).lower[place_in_noise::white(0)], std::log(0.005), 1e-15);
  noise.channels[0].white = 1e-6;
  EXPECT_NEAR(pack(noise, spec, reference).value[place_in_noise::white(0)], std::log(0.005), 1e-15);
  reference.channels[0].rounding = 1e-5;
  EXPECT_NEAR(pack(noise, spec, reference).lower[place_in_noise::white(0)], std::log(1e-4), 1e-15) << "a hundredth of the usual noise";
}

}  // namespace
}  // namespace misfit
