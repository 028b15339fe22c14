// Known answers for the parachute from outside the toolkit: lib/misfit/README.md 4.5, closed forms, the spherical pendulum.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/model/cases.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double D = 1.5816, S = 1.9554, R = 3.15, q = 736.0, V = 35.1, I = (0.206 + 0.294) * R * R;
constexpr double slope = -0.0062 / degree;  ///< C_m per rad at the trim of 12 deg, as in the validation truth
const double trim = 12.0 * degree;

/// The parachute with static moment and damping alone, phi at rest: C_m a line through the trim, constant damping.
Model bare(bool induced, double damping) {
  ModelRequest r = parachute(induced);
  r.effects = {effect("static_moment"), effect("pitch_damping")};
  Model m = assemble(r, registry());
  set_line(m, "C_m", trim, 0.0, slope);
  set_line(m, induced ? "C_mq" : "C_m_alphadot", trim, damping, 0.0);
  return m;
}

struct NormalEquations {
  double stiffness, damping;  ///< eta'' = −stiffness eta − damping eta'
};
NormalEquations at_trim(const Model& m) {
  Evaluator evaluator(m);
  const double x[] = {trim, 0.0}, u[] = {0.0, 0.0};
  double dx[2];
  std::vector<double> A(2 * static_cast<std::size_t>(kRowStride));
  Slots slots;
  evaluator.linearise_rates({x, u, 0.0}, slots, dx, A.data());
  EXPECT_NEAR(dx[1], 0.0, 1e-10) << "the trim is an equilibrium";
  EXPECT_NEAR(A[1], 1.0, 1e-15);
  return {-A[kRowStride], -A[kRowStride + 1]};
}

TEST(PlanarParachute, InducedAngleIsAsLargeAsTheTiltAndDampsByItself) {
  const NormalEquations l = at_trim(bare(true, 0.0));
  const double omega0 = std::sqrt(l.stiffness);
  EXPECT_NEAR(omega0 * R / V, 1.14, 0.01) << "lib/misfit/README.md, 4.5";
  const double zeta = l.damping / (2.0 * omega0);
  EXPECT_NEAR(zeta, 0.57, 0.02) << "lib/misfit/README.md, 4.5, which takes cos(alpha_T) as 1";
  EXPECT_NEAR(zeta, omega0 * R / (2.0 * V) * std::cos(trim), 1e-9) << "d alpha_T/d eta' = R cos(alpha_T)/V at the trim";
}

TEST(PlanarParachute, StiffnessAtTrimIsThatOfTheStaticCurve) {
  const double expected = -q * S * D * slope / I;
  EXPECT_NEAR(at_trim(bare(false, 0.0)).stiffness, expected, 1e-9 * expected);
  EXPECT_NEAR(at_trim(bare(true, 0.0)).stiffness, expected, 1e-9 * expected);
}

TEST(PlanarParachute, BothFormsDampAlikeWhenCmAlphadotIsCmqAndTheInducedPart) {
  const double C_mq = -0.25;
  const double C_m_alphadot = C_mq + 2.0 * R / D * slope * std::cos(trim);
  EXPECT_NEAR(C_m_alphadot, -1.634, 0.002) << "the induced part is five times the other";
  const NormalEquations induced = at_trim(bare(true, C_mq)), paper = at_trim(bare(false, C_m_alphadot));
  EXPECT_NEAR(induced.damping, paper.damping, 1e-10 * paper.damping);
  EXPECT_NEAR(induced.stiffness, paper.stiffness, 1e-10 * paper.stiffness);
}

TEST(PlanarParachute, OffersTheDerivedCurveInThePapersMeaning) {
  const Model m = bare(true, -0.25);
  const std::vector<double> constants = m.values();
  const auto derived = m.system->derived_curves(constants.data());
  ASSERT_EQ(derived.size(), 1U);
  EXPECT_EQ(derived[0].name, "C_m_alphadot");
  double value = 0.0;
  for (const auto& term : derived[0].terms) value += term.factor(trim) * (term.curve == "C_m" ? slope : -0.25);
  EXPECT_NEAR(value, -0.25 + 2.0 * R / D * slope * std::cos(trim), 1e-12);
}

TEST(PlanarParachute, AtRestTheInducedFormFeelsThePapersMoment) {
  const Model induced = bare(true, -0.25), paper = bare(false, -0.25);
  Evaluator a(induced), b(paper);
  const double u[] = {0.7, 0.0};
  for (double eta : {-0.3, -0.1, 0.05, 0.2, 0.45}) {
    const double x[] = {eta, 0.0};
    double da[2], db[2];
    a.rates(x, u, 0.0, da);
    b.rates(x, u, 0.0, db);
    EXPECT_NEAR(da[1], db[1], 1e-9 * std::abs(db[1]) + 1e-12) << eta;
  }
}

TEST(PlanarParachute, MovingWithoutTiltIsFeltAsAnAngleOnTheSideItMovesTo) {
  // No tilt, eta' alone: the wind comes at atan(R eta'/V), on the side to which the canopy moves.
  const Model m = bare(true, 0.0);
  Evaluator evaluator(m);
  const double x[] = {0.0, 0.8}, u[] = {0.0, 0.0};
  double dx[2];
  evaluator.rates(x, u, 0.0, dx);
  const double alpha = std::atan(R * 0.8 / V);
  const Curve& curve = *m.find_curve("C_m");
  const CurvePoint at = curve.spline.at(alpha);
  double C_m = 0.0;
  for (std::size_t j = 0; j < 4; ++j) C_m += at.w[j] * m.parameters[static_cast<std::size_t>(curve.first + at.first) + j].value;
  EXPECT_NEAR(dx[1], q * S * D * C_m / I, 1e-9 * std::abs(dx[1]));
}

/// A free spherical pendulum without forces goes round a great circle at constant speed: n(t) = a cos(wt) + b sin(wt). Its tilt from the x
/// axis and its clock angle are geometry; eta'' must be phi'² sin(eta) cos(eta).
TEST(Coning, IsTheTermOfTheSphericalPendulum) {
  const std::array<double, 3> a = {std::cos(0.3), std::sin(0.3), 0.0}, b = {0.0, 0.0, 1.0};
  constexpr double w = 2.3;
  const auto n = [&](double t, std::size_t i) { return a[i] * std::cos(w * t) + b[i] * std::sin(w * t); };
  const auto eta = [&](double t) { return std::atan2(std::hypot(n(t, 1), n(t, 2)), n(t, 0)); };
  const auto phi = [&](double t) { return std::atan2(n(t, 1), n(t, 2)); };
  ModelRequest r = parachute(false);
  r.effects = {effect("coning")};
  r.curves.clear();
  const Model m = assemble(r, registry());
  Evaluator evaluator(m);
  constexpr double h = 1e-3;
  for (double t : {0.05, 0.2, 0.35, 0.5}) {
    const double eta_rate = (eta(t + h) - eta(t - h)) / (2.0 * h);
    const double second = (-eta(t + 2 * h) + 16.0 * eta(t + h) - 30.0 * eta(t) + 16.0 * eta(t - h) - eta(t - 2 * h)) / (12.0 * h * h);
    const double phi_rate = (8.0 * (phi(t + h) - phi(t - h)) - (phi(t + 2 * h) - phi(t - 2 * h))) / (12.0 * h);
    const double x[] = {eta(t), eta_rate}, u[] = {phi(t), phi_rate};
    double dx[2];
    evaluator.rates(x, u, 0.0, dx);
    EXPECT_GT(second, 0.1) << "it must matter";
    EXPECT_NEAR(dx[1], second, 1e-6 * second) << "t = " << t;
  }
}

TEST(Gravity, IsTheWeightOfThePaperAtTheCentreOfPressure) {
  ModelRequest r = parachute(false);
  r.effects = {effect("gravity")};
  r.curves.clear();
  const Model m = assemble(r, registry());
  Evaluator evaluator(m);
  const double x[] = {trim, 0.0}, u[] = {0.5, 0.0};
  double dx[2];
  evaluator.rates(x, u, 0.0, dx);
  EXPECT_NEAR(dx[1] * I, 6.3635352 * std::cos(0.5) * std::cos(trim), 1e-6);
}

TEST(DynamicPressureDrift, ChangesPressureAndWindTogether) {
  // q up by 21 %: V up by 10 %, static moment by 21 %, damping (q/V) by 10 %.
  ModelRequest r = parachute(false, {effect("dynamic_pressure_drift")});
  r.effects.erase(r.effects.begin() + 2, r.effects.begin() + 4);
  Model m = assemble(r, registry());
  set_line(m, "C_m", trim, 0.0, slope);
  set_line(m, "C_m_alphadot", trim, -0.25, 0.0);
  const auto acceleration = [&](double eta, double rate, double t) {
    Evaluator evaluator(m);
    const double x[] = {eta, rate}, u[] = {0.0, 0.0};
    double dx[2];
    evaluator.rates(x, u, t, dx);
    return dx[1];
  };
  const double t = 10.0;
  set(m, "pressure_drift", 0.21 * q / t);
  EXPECT_NEAR(acceleration(0.3, 0.0, t), 1.21 * acceleration(0.3, 0.0, 0.0), 1e-9);
  EXPECT_NEAR(acceleration(trim, 1.0, t), 1.1 * acceleration(trim, 1.0, 0.0), 1e-9);
}

}  // namespace
}  // namespace misfit
