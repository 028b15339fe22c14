// The spherical parachute against what is known without it: mechanics of a rigid line, symmetry, the planar system.
#include "tests/models/spherical.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_spherical;

TEST(SphericalParachute, WithoutForcesTheAxisGoesRoundAGreatCircleAtConstantSpeed) {
  const Model m = with({});
  const State x0 = from_angles(0.3, 0.4, 0.5, 0.8);
  const double w = std::sqrt(x0[2] * x0[2] + x0[3] * x0[3] + n_x_rate(x0) * n_x_rate(x0));
  constexpr double t = 0.4;
  const State x = run(m, x0, t);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(x[i], x0[i] * std::cos(w * t) + x0[i + 2] / w * std::sin(w * t), 1e-11);
}

TEST(SphericalParachute, SphericalPendulumUnderItsWeightKeepsEnergyAndAngularMomentumAboutTheVertical) {
  const Model m = with({effect("gravity")});
  const auto energy = [](const State& x) {
    return 0.5 * I * (x[2] * x[2] + x[3] * x[3] + n_x_rate(x) * n_x_rate(x)) - weight * R * x[1];  // z is down
  };
  const auto momentum = [](const State& x) { return I * (n_x(x) * x[2] - x[0] * n_x_rate(x)); };
  const State x0 = from_angles(0.5, 0.9, 0.3, 0.6);
  const double E = energy(x0), L = momentum(x0);
  double low = x0[1], high = x0[1];
  run(m, x0, 1.0, [&](const State& x) {
    EXPECT_NEAR(energy(x), E, 1e-9 * I);
    EXPECT_NEAR(momentum(x), L, 1e-9 * I);
    low = std::min(low, x[1]);
    high = std::max(high, x[1]);
  });
  EXPECT_GT(high - low, 0.2) << "it must have fallen";
}

TEST(SphericalParachute, MovingInOnePlaneItIsThePlanarSystem) {
  ModelRequest r = parachute(true);
  r.effects = {effect("static_moment"), effect("pitch_damping"), effect("gravity"), effect("coning")};
  Model planar = assemble(r, registry());
  set_line(planar, "C_m", 12.0 * degree, 0.0, -0.0062 / degree);
  set_line(planar, "C_mq", 12.0 * degree, -0.25, 0.3);
  Evaluator in_plane(planar);
  const Model m = with({effect("static_moment"), effect("pitch_damping"), effect("gravity")});
  for (double eta : {0.02, 0.2, 0.45}) {
    for (double eta_rate : {-1.5, 0.0, 2.0}) {
      const double x[] = {eta, eta_rate}, u[] = {0.0, 0.0};
      double d[2];
      in_plane.rates(x, u, 0.0, d);
      const State dx = rates(m, from_angles(eta, 0.0, eta_rate, 0.0));
      EXPECT_NEAR(dx[3], std::cos(eta) * d[1] - std::sin(eta) * eta_rate * eta_rate, 1e-10 * (1.0 + std::abs(d[1])));
      EXPECT_NEAR(dx[2], 0.0, 1e-12);
    }
  }
}

TEST(SphericalParachute, GoingRoundTheTiltAcceleratesAsThePlanarSystemWithConing) {
  ModelRequest r = parachute(true);
  Model planar = assemble(r, registry());
  set_line(planar, "C_m", 12.0 * degree, 0.0, -0.0062 / degree);
  set_line(planar, "C_mq", 12.0 * degree, -0.25, 0.3);
  Evaluator in_plane(planar);
  const Model m = with({effect("static_moment"), effect("pitch_damping"), effect("gravity")});
  const double eta = 0.25, phi = 0.7, eta_rate = 0.8, phi_rate = 3.0;
  const double x[] = {eta, eta_rate}, u[] = {phi, phi_rate};
  double d[2];
  in_plane.rates(x, u, 0.0, d);
  const State at = from_angles(eta, phi, eta_rate, phi_rate), dx = rates(m, at);
  const double n_x_second = -(at[2] * at[2] + at[3] * at[3] + at[0] * dx[2] + at[1] * dx[3] + n_x_rate(at) * n_x_rate(at)) / n_x(at);
  // n_x = cos(eta): n_x'' = -cos(eta) eta'^2 - sin(eta) eta''
  EXPECT_NEAR(n_x_second, -std::cos(eta) * eta_rate * eta_rate - std::sin(eta) * d[1], 1e-10);
}

TEST(SphericalParachute, SteadyConingIsHeldByTheStaticMoment) {
  // eta' = 0: I phi'^2 sin(eta) cos(eta) = -M. The canopy goes round at V-ratio R phi' sin(eta)/V, so that alpha_T > eta.
  constexpr double eta = 0.3, V = 35.1, q_SD = 736.0 * 1.9554 * 1.5816;
  double phi_rate = 0.0, alpha = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double across = R * phi_rate * std::sin(eta), v = std::hypot(V, across);
    alpha = std::atan2(std::hypot(V * std::sin(eta), across), V * std::cos(eta));
    const double M = q_SD * (-0.0062 / degree) * (alpha - 12.0 * degree) / std::sin(alpha) * V * std::sin(eta) / v;
    phi_rate = std::sqrt(-M / (I * std::sin(eta) * std::cos(eta)));
  }
  const State x = from_angles(eta, 1.1, 0.0, phi_rate);
  Model m = with({effect("static_moment")});
  EXPECT_NEAR(quantities(m, x)["alpha_T"], alpha, 1e-12);
  const State dx = rates(m, x);
  const double inward = (dx[2] * x[0] + dx[3] * x[1]) / std::sin(eta);
  EXPECT_GT(phi_rate, 3.0) << "it must matter";
  EXPECT_NEAR(inward, -phi_rate * phi_rate * std::sin(eta), 1e-9);
}

TEST(SphericalParachute, WithoutGravityNothingKnowsWhereUpIs) {
  const Model m = with({effect("static_moment"), effect("pitch_damping"), effect("coulomb_friction"), effect("magnus"),
                        effect("relative_dynamic_pressure"), effect("lateral_damping")},
                       {{"friction", 20.0}, {"C_spin", 0.1}, {"relative_pressure", 1.0}, {"C_lateral", 0.2}});
  for (const State& x : some_states) {
    for (double angle : {0.3, 1.9, -2.6}) {
      const State expected = turned(rates(m, x), angle), got = rates(m, turned(x, angle));
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(got[i], expected[i], 1e-10 * (1.0 + std::abs(expected[i])));
    }
  }
}

/// Written out with vectors: l = v x n/|v x n| is across the plane of axis and relative wind, whatever the tilt.
TEST(SphericalParachute, LateralDampingActsAcrossThePlaneOfAxisAndRelativeWind) {
  constexpr double C = -1.2, V = 35.1, factor = 736.0 * 1.9554 * 1.5816 * 1.5816 / (2.0 * V);
  const Model free = with({}), damped = with({effect("lateral_damping")}, {{"C_lateral", C}});
  for (const State& x : some_states) {
    const Eigen::Vector3d n(n_x(x), x[0], x[1]), rate(n_x_rate(x), x[2], x[3]);
    const Eigen::Vector3d cross = (Eigen::Vector3d(V, 0.0, 0.0) - R * rate).cross(n);
    const double sine = cross.norm() / (Eigen::Vector3d(V, 0.0, 0.0) - R * rate).norm();
    const Eigen::Vector3d l = cross.normalized();
    const Eigen::Vector3d expected = C * factor / I * rate.dot(l) * l * std::pow(sine, 4) / (std::pow(sine, 4) + std::pow(0.02, 4));
    const State a = rates(free, x), b = rates(damped, x);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(b[i + 2] - a[i + 2], expected[i + 1], 1e-9);
  }
}

TEST(SphericalParachute, AMomentThatLagsIsNoneWhereItsMemoryIsEmptyAndTheStaticOneWhereItHasCaughtUp) {
  constexpr double tau = 0.06;
  const Model free = with({}), at_once = with({effect("static_moment")});
  const Model lagging = with({effect("static_moment"), effect("aerodynamic_lag")}, {{"share_lag", 1.0}, {"tau_lag", tau}});
  Evaluator evaluator(lagging);
  for (const State& x : some_states) {
    std::array<double, 6> state{x[0], x[1], x[2], x[3], 0.0, 0.0}, rate{};
    evaluator.rates(state.data(), nullptr, 0.0, rate.data());
    const State nothing = rates(free, x), whole = rates(at_once, x);
    for (std::size_t i = 2; i < 4; ++i) EXPECT_NEAR(rate[i], nothing[i], 1e-9 * (1.0 + std::abs(nothing[i])));
    state[4] = tau * rate[4];
    state[5] = tau * rate[5];
    evaluator.rates(state.data(), nullptr, 0.0, rate.data());
    for (std::size_t i = 2; i < 4; ++i) EXPECT_NEAR(rate[i], whole[i], 1e-9 * (1.0 + std::abs(whole[i])));
    EXPECT_NEAR(rate[4], 0.0, 1e-9);
  }
}

TEST(SphericalParachute, FrictionOpposesTheRotationWhateverThePlaneOfTheTilt) {
  const Model free = with({}), rubbing = with({effect("coulomb_friction")}, {{"friction", 20.0}, {"width", 0.01}});
  for (const State& x : some_states) {
    const State a = rates(free, x), b = rates(rubbing, x);
    const double speed = std::sqrt(x[2] * x[2] + x[3] * x[3] + n_x_rate(x) * n_x_rate(x));
    for (std::size_t i = 2; i < 4; ++i) EXPECT_NEAR(b[i] - a[i], -20.0 / I * x[i] / speed, 1e-9);
  }
}

TEST(SphericalParachute, MomentsAboutFixedAxesAreTorqueCrossAxis) {
  const Model m = with({effect("vortex_shedding")}, {{"y_cosine", 0.004}, {"z_cosine", -0.007}});
  const Model free = with({});
  constexpr double q_SD = 736.0 * 1.9554 * 1.5816, M_y = 0.004 * q_SD, M_z = -0.007 * q_SD;
  for (const State& x : some_states) {
    const State a = rates(free, x), b = rates(m, x);
    // tau = (tau_x, M_y, M_z) without a part along n gives n'' of (tau x n)/I; a part along n does nothing, so tau_x = 0 will do.
    EXPECT_NEAR(b[2] - a[2], M_z * n_x(x) / I, 1e-10);
    EXPECT_NEAR(b[3] - a[3], -M_y * n_x(x) / I, 1e-10);
  }
}

TEST(SphericalParachute, TheTrimGoesWithTheDirectionOfTheWind) {
  // At rest along the wind the canopy feels no angle of attack: nothing moves. theta and psi of the axis are those of the wind.
  constexpr double theta = -0.05, psi = 0.03;
  const Model m = with({effect("static_moment"), effect("flow_angularity")}, {{"flow_theta", theta}, {"flow_psi", psi}});
  const double length = std::sqrt(1.0 + std::tan(theta) * std::tan(theta) + std::tan(psi) * std::tan(psi));
  const State along = {std::tan(psi) / length, std::tan(theta) / length, 0.0, 0.0};
  EXPECT_NEAR(quantities(m, along)["alpha_T"], 0.0, 1e-7);
  for (double value : rates(m, along)) EXPECT_NEAR(value, 0.0, 1e-10);
  EXPECT_GT(std::abs(rates(m, {0.0, 0.0, 0.0, 0.0})[2]), 0.1);
}

TEST(SphericalParachute, TheWakeTakesHalfOfTheStaticMomentAtItsCentreAndPushesAwayOnBothSides) {
  const double depth = 0.5, push = 0.15, width = 22.0 * degree;
  const std::map<std::string, double> wake = {
      {"wake_depth", depth}, {"wake_push", push}, {"wake_phi", -90.0 * degree}, {"wake_width", width}};
  const Model plain = with({effect("static_moment")}), m = with({effect("static_moment"), effect("strut_wake")}, wake);
  const double eta = 0.3, open = 1.0 / (1.0 + std::pow(0.02 / std::sin(eta), 4));
  const State centre = from_angles(eta, -90.0 * degree, 0.0, 0.0);
  EXPECT_NEAR(rates(m, centre)[2] / rates(plain, centre)[2], 1.0 - depth * open, 1e-12);
  const auto turning = [&](double phi) {
    const State x = from_angles(eta, phi, 0.0, 0.0), dx = rates(m, x);
    return std::cos(phi) * dx[2] - std::sin(phi) * dx[3];
  };
  EXPECT_NEAR(turning(-90.0 * degree), 0.0, 1e-10);
  EXPECT_GT(turning(-70.0 * degree), 0.5) << "beyond the wake: forward";
  EXPECT_LT(turning(-110.0 * degree), -0.5);
  EXPECT_NEAR(turning(-70.0 * degree), -turning(-110.0 * degree), 1e-9);
  EXPECT_NEAR(turning(90.0 * degree), 0.0, 1e-9) << "nothing opposite";
  EXPECT_NEAR(turning(-90.0 * degree + 1e-3), turning(270.0 * degree + 1e-3), 1e-9) << "a whole turn is none";
}

/// The state goes through zero tilt without a jump, and derivatives there are those of neighbouring differences, at rest and in motion.
TEST(SphericalParachute, IsRegularThroughZeroTilt) {
  const Model m =
      with({effect("static_moment"), effect("pitch_damping"), effect("gravity"), effect("strut_wake"), effect("coulomb_friction")},
           {{"wake_depth", 0.4}, {"wake_push", 0.2}, {"wake_phi", 0.5}, {"friction", 5.0}, {"width", 0.3}});
  Evaluator evaluator(m);
  for (const State& x : {State{0.0, 0.0, 0.0, 0.0}, State{0.0, 0.0, 0.7, -1.1}}) {
    State dx{};
    std::vector<double> D(4 * static_cast<std::size_t>(kRowStride));
    Slots slots;
    evaluator.linearise_rates({x.data(), nullptr, 0.0}, slots, dx.data(), D.data());
    for (std::size_t j = 0; j < 4; ++j) {
      const Eigen::VectorXd difference = central_difference(
          [&](double value) {
            State moved = x;
            moved[j] = value;
            const State d = rates(m, moved);
            return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(d.data(), 4));
          },
          x[j]);
      for (std::size_t i = 0; i < 4; ++i) {
        const double slope = difference[static_cast<Eigen::Index>(i)];
        EXPECT_NEAR(D[i * kRowStride + j], slope, 2e-6 * (1.0 + std::abs(slope))) << i << ", " << j;
      }
    }
    const State near = rates(m, {x[0] + 1e-9, x[1] - 1e-9, x[2], x[3]});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(near[i], dx[i], 1e-5);
  }
}

}  // namespace
}  // namespace misfit
