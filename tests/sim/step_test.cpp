#include "misfit/sim/step.h"

#include <gtest/gtest.h>

#include "tests/model/cases.h"
#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_models;

class StepOf : public testing::TestWithParam<Case> {
 protected:
  const Model model_ = GetParam().model();
  Stepper stepper_{model_};
  const std::vector<int> free_ = model_.free_parameters();
  const int n_ = model_.states(), columns_ = static_cast<int>(free_.size());

  Interval interval(const Sample& from, const Sample& to, double h) const { return {from.t, from.t + h, from.inputs(), to.inputs()}; }

  Eigen::VectorXd stepped(std::vector<double> x, const Interval& over) {
    EXPECT_TRUE(stepper_.step(x.data(), over));
    return Eigen::Map<Eigen::VectorXd>(x.data(), n_);
  }

  /// Φ and Γ against central differences of step() over one interval.
  void expect_derivatives(const Sample& at, const Interval& over) {
    std::vector<double> D(static_cast<std::size_t>(n_) * kRowStride, std::nan("")), x = at.x;
    Slots slots;
    ASSERT_TRUE(stepper_.step_linear(x.data(), over, slots, D.data()));
    const Eigen::VectorXd plain = stepped(at.x, over);
    EXPECT_LE((Eigen::Map<Eigen::VectorXd>(x.data(), n_) - plain).norm(), 1e-13 * (1.0 + plain.norm()));
    const Eigen::MatrixXd linear = dense(D, n_, n_, slots, columns_);
    const auto compare = [&](int column, const Eigen::VectorXd& difference, const std::string& name) {
      for (int i = 0; i < n_; ++i)
        EXPECT_NEAR(linear(i, column), difference[i], 2e-6 * std::abs(difference[i]) + 1e-8 * (1.0 + std::abs(plain[i])))
            << "state " << i << " by " << name;
    };
    for (int j = 0; j < n_; ++j) {
      const auto moved = [&](double value) {
        std::vector<double> from = at.x;
        from[static_cast<std::size_t>(j)] = value;
        return stepped(from, over);
      };
      compare(j, central_difference(moved, at.x[static_cast<std::size_t>(j)]), "state " + std::to_string(j));
    }
    std::vector<double> p = model_.values();
    for (int c = 0; c < columns_; ++c) {
      double& value = p[static_cast<std::size_t>(free_[static_cast<std::size_t>(c)])];
      const double nominal = value;
      const auto moved = [&](double to) {
        value = to;
        stepper_.evaluator().set_parameters(p.data());
        return stepped(at.x, over);
      };
      compare(n_ + c, central_difference(moved, nominal),
              model_.parameters[static_cast<std::size_t>(free_[static_cast<std::size_t>(c)])].name);
      value = nominal;
      stepper_.evaluator().set_parameters(p.data());
    }
  }
};

TEST_P(StepOf, PhiAndGammaAreCentralDifferencesOfTheStep) {
  const auto samples = samples_of(model_, 4);
  for (std::size_t s = 0; s + 1 < samples.size(); ++s) {
    stepper_.prepare(samples[s].x.data(), samples[s].u.data(), samples[s].t);
    expect_derivatives(samples[s], interval(samples[s], samples[s + 1], 1.0 / 60.0));
  }
}

TEST_P(StepOf, PhiAndGammaAreCentralDifferencesOfTheStepWithSubsteps) {
  const auto samples = samples_of(model_, 4);
  for (std::size_t s = 0; s + 1 < samples.size(); ++s) {
    stepper_.prepare(samples[s].x.data(), samples[s].u.data(), samples[s].t);
    const double h = 1.7 / std::max(stepper_.fastest_rate(), 15.0);  // 0.5 per sub-step: four of them
    expect_derivatives(samples[s], interval(samples[s], samples[s + 1], h));
  }
}

TEST_P(StepOf, PhiAndGammaAreCentralDifferencesOfImplicitSteps) {
  const std::vector<StepPart> parts = {{0.4, true}, {0.7, false}, {1.0, true}};
  const auto samples = samples_of(model_, 4);
  for (std::size_t s = 0; s + 1 < samples.size(); ++s) {
    Interval over = interval(samples[s], samples[s + 1], 1.0 / 60.0);
    over.parts = parts;
    expect_derivatives(samples[s], over);
  }
}

TEST_P(StepOf, ImplicitStepsMoveAsExplicitOnesThatAreShort) {
  const std::vector<StepPart> implicit = {{1.0, true}};
  std::vector<StepPart> fine;
  for (int k = 1; k <= 64; ++k) fine.push_back({k / 64.0, false});
  for (const Sample& at : samples_of(model_, 4)) {
    constexpr double small = 0.02;  // times the fastest rate: the fifth power of it is left
    Interval over = interval(at, at, 1e-3);
    over.t1 = over.t0 + small / std::max(stepper_.linearised_rate(at.x.data(), over, 0.0), 15.0);
    over.parts = implicit;
    const Eigen::VectorXd by_radau = stepped(at.x, over);
    over.parts = fine;
    const Eigen::VectorXd by_runge = stepped(at.x, over);
    EXPECT_LE((by_radau - by_runge).norm(), 1e-9 * (1.0 + by_runge.norm()));
  }
}

TEST_P(StepOf, AUsedStepperGivesTheSameBitsAsAFreshOne) {
  const auto samples = samples_of(model_, 3);
  std::vector<double> D(static_cast<std::size_t>(n_) * kRowStride, std::nan(""));
  Slots slots;
  for (const Sample& at : samples) {
    std::vector<double> x = at.x;
    ASSERT_TRUE(stepper_.step_linear(x.data(), interval(at, at, 0.02), slots, D.data()));
  }
  for (const Sample& at : samples) {
    Stepper fresh(model_);
    Slots own;
    std::vector<double> first(D.size(), std::nan("")), x1 = at.x, x2 = at.x;
    ASSERT_TRUE(stepper_.step_linear(x1.data(), interval(at, at, 0.02), slots, D.data()));
    ASSERT_TRUE(fresh.step_linear(x2.data(), interval(at, at, 0.02), own, first.data()));
    EXPECT_EQ(x1, x2);
    EXPECT_EQ(dense(D, n_, n_, slots, columns_), dense(first, n_, n_, own, columns_));
  }
}

INSTANTIATE_TEST_SUITE_P(Every, StepOf, testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });

/// lib/misfit/README.md (8) to (10) written out again, with plain doubles and a straight C_m: nothing of the toolkit is in it.
struct ByHand {
  bool induced;
  double D = 1.5816, S = 1.9554, R = 3.15, m = 0.206, m_a = 0.294, q = 736.0, V = 35.1;
  double trim = 12.0 * degree, slope = -0.0062 / degree, damping = -0.25;
  double phi0 = 0.3, phi_rate = 0.9;

  void rates(double t, const double* x, double* dx) const {
    const double eta = x[0], rate = x[1], I = (m + m_a) * R * R, phi = phi0 + phi_rate * t;
    double C_m = slope * (eta - trim), direction = 1.0;
    if (induced) {
      const double w_eta = V * std::sin(eta) + R * rate, w_phi = R * phi_rate * std::sin(eta);
      const double alpha = std::atan(std::hypot(w_eta, w_phi) / (V * std::cos(eta)));
      C_m = slope * (alpha - trim);
      direction = w_eta / std::hypot(w_eta, w_phi);
    }
    dx[0] = rate;
    dx[1] = (q * S * D * (C_m * direction + D / (2.0 * V) * damping * rate) + m * 9.80665 * R * std::cos(phi) * std::cos(eta)) / I +
            phi_rate * phi_rate * std::sin(eta) * std::cos(eta);
  }
  /// Runge–Kutta with steps of T/n.
  std::array<double, 2> run(double eta, double T, int n) const {
    std::array<double, 2> x = {eta, 0.0};
    const double h = T / n;
    for (int i = 0; i < n; ++i) {
      double k[4][2], stage[2] = {x[0], x[1]};
      for (int s = 0; s < 4; ++s) {
        rates(i * h + (s == 0 ? 0.0 : s == 3 ? h : h / 2.0), stage, k[s]);
        const double part = s == 2 ? h : h / 2.0;
        for (int j = 0; j < 2; ++j) stage[j] = x[static_cast<std::size_t>(j)] + part * k[s][j];
      }
      for (std::size_t j = 0; j < 2; ++j) x[j] += h / 6.0 * (k[0][j] + 2.0 * k[1][j] + 2.0 * k[2][j] + k[3][j]);
    }
    return x;
  }
};

class ParachuteForm : public testing::TestWithParam<bool> {
 protected:
  /// The toolkit's motion from rest at 15 deg, over T in n steps, in a stretch where all curves are straight and no angle passes 0.
  static std::array<double, 2> run(double T, int n) {
    ModelRequest request = parachute(GetParam());
    const std::string damping = GetParam() ? "C_mq" : "C_m_alphadot";
    request.curves["C_m"].knots = {0.5 * degree, 60.0 * degree};
    request.curves[damping].knots = {0.5 * degree, 60.0 * degree};
    Model model = assemble(request, registry());
    set_line(model, "C_m", 12.0 * degree, 0.0, -0.0062 / degree);
    set_line(model, damping, 0.0, -0.25, 0.0);
    Stepper stepper(model);  // prepare() is not called: no sub-steps, the order shows
    const ByHand hand{GetParam()};
    std::array<double, 2> x = {15.0 * degree, 0.0};
    for (int i = 0; i < n; ++i) {
      const double t0 = T * i / n, t1 = T * (i + 1) / n;
      const double u0[] = {hand.phi0 + hand.phi_rate * t0, hand.phi_rate}, u1[] = {hand.phi0 + hand.phi_rate * t1, hand.phi_rate};
      EXPECT_TRUE(stepper.step(x.data(), {t0, t1, u0, u1}));
    }
    return x;
  }
};
INSTANTIATE_TEST_SUITE_P(BothForms, ParachuteForm, testing::Bool(), [](const auto& form) { return form.param ? "Induced" : "Paper"; });

TEST_P(ParachuteForm, MovesAsTheEquationsWrittenOutByHandWithTinySteps) {
  const auto exact = ByHand{GetParam()}.run(15.0 * degree, 1.0, 100000), ours = run(1.0, 1000);
  EXPECT_GT(std::abs(exact[0] - 15.0 * degree), 0.5 * degree) << "it must have moved";
  EXPECT_NEAR(ours[0], exact[0], 1e-9);
  EXPECT_NEAR(ours[1], exact[1], 1e-8);
}

TEST_P(ParachuteForm, ConvergesWithTheFourthPowerOfTheStep) {
  const auto exact = ByHand{GetParam()}.run(15.0 * degree, 0.8, 20000);
  const auto error = [&](int n) {
    const auto x = run(0.8, n);
    return std::hypot(x[0] - exact[0], (x[1] - exact[1]) / 13.0);  // rad, and rad/s over the frequency of the motion
  };
  const double coarse = error(80), fine = error(160), finest = error(320);
  EXPECT_GT(finest, 1e-12) << "rounding would hide the order";
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.2);
  EXPECT_NEAR(std::log2(fine / finest), 4.0, 0.1);
}

TEST(StepTest, AZeroOrderInputIsHeldAndAFirstOrderOneRunsStraight) {
  Model held = assemble(cart({}), registry());
  set(held, "stiffness", 0.0);
  Stepper cart_stepper(held);
  double x[2] = {0.0, 0.0};
  const double u0[] = {3.0}, u1[] = {99.0};
  ASSERT_TRUE(cart_stepper.step(x, {0.0, 0.1, u0, u1}));
  EXPECT_NEAR(x[1], 3.0 / 2.0 * 0.1, 1e-15);

  ModelRequest request = parachute(false);
  request.effects = {effect("gravity")};
  request.curves.clear();
  const Model planar = assemble(request, registry());
  Stepper stepper(planar);
  double y[2] = {90.0 * degree, 0.0};  // cos(eta) = 0: gravity alone does nothing, whatever phi
  const double p0[] = {0.0, 0.0}, p1[] = {0.1, 0.0};
  ASSERT_TRUE(stepper.step(y, {0.0, 1e-3, p0, p1}));
  EXPECT_NEAR(y[1], 0.0, 1e-15);
  double z[2] = {0.0, 0.0};
  ASSERT_TRUE(stepper.step(z, {0.0, 1e-3, p0, p1}));
  EXPECT_NEAR(z[1], 0.206 * 9.80665 / (0.5 * 3.15) * std::sin(0.1) / 0.1 * 1e-3,
              1e-10);  // mean of cos(phi) over 0 … 0.1; Simpson's rule errs by phi⁴/2880 of it
}

TEST(StepTest, ANonFiniteStateIsReportedNotReturnedAsGood) {
  const Model model = Case{"", parachute(true)}.model();
  Stepper stepper(model);
  const double u[] = {0.0, std::nan("")};
  double x[2] = {0.1, 0.0};
  EXPECT_FALSE(stepper.step(x, {0.0, 0.02, u, u}));
  double y[2] = {0.1, 0.0};
  Slots slots;
  std::vector<double> D(2 * static_cast<std::size_t>(kRowStride));
  EXPECT_FALSE(stepper.step_linear(y, {0.0, 0.02, u, u}, slots, D.data()));
}

TEST(StepTest, FastestRateIsThatOfTheFastestEffectAtTheStateGiven) {
  const Model model =
      assemble(with_values(parachute(true, {effect("coulomb_friction")}), {{"friction", 20.0}, {"width", 0.01}}), registry());
  Stepper stepper(model);
  const double x[2] = {0.2, 0.0}, u[2] = {0.0, 0.0};
  stepper.prepare(x, u, 0.0);
  EXPECT_NEAR(stepper.fastest_rate(), 20.0 / 0.01 / (0.5 * 3.15 * 3.15), 1e-9);
}

}  // namespace
}  // namespace misfit
