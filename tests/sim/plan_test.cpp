// Free runs, their steps chosen without a key, against CVODE of SUNDIALS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "misfit/sim/planner.h"
#include "tests/model/cases.h"
#include "tests/model/declared_texts.h"
#include "tests/sim/reference_integrator.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::AllOf;
using testing::HasSubstr;

using Vector = std::vector<double>;

Vector evenly(double step, int samples) {
  Vector t;
  for (int i = 0; i < samples; ++i) t.push_back(step * i);
  return t;
}

struct World {
  const char* name;
  std::string text;
  Vector t, x0;
  Rates rates;
  bool stiff = false;
  std::vector<double> input = {};
  double most_parts = 0.0;  ///< per sample interval, on average
  double accuracy = 1e-6;   ///< error of each state, of its range: a thousandth of what a measurement with noise of 0.1 % would show
};
void PrintTo(const World& world, std::ostream* out) { *out << world.name; }

/// States at the times of `t`, where the rates of a driven world have kinks.
RowMatrix reference(const World& world) {
  RowMatrix out(world.t.size(), world.x0.size());
  ReferenceIntegrator integrator(world.rates, world.x0, world.t.front(), world.stiff);
  for (std::size_t i = 0; i < world.t.size(); ++i) {
    out.row(i) = Eigen::Map<const Eigen::RowVectorXd>(integrator.x().data(), out.cols());
    if (i + 1 < world.t.size()) integrator.advance(world.t[i], world.t[i + 1], !world.input.empty());
  }
  return out;
}

std::string system_text(const std::string& states, const std::string& equations, const std::string& more = "") {
  return "[states]\n" + states + more + "[parameters]\ns = { unit = \"s\", value = 1.0 }\n[equations]\n" + equations +
         "[outputs]\nx = { unit = \"-\" }\n";
}

World driven_duffing() {
  constexpr double rate = 610.0;
  World w{"DrivenDuffing",
          system_text("x = { unit = \"-\" }\nv = { unit = \"1/s\" }\n", "x = \"v\"\nv = \"(1e5*u - 20*v*s - 1.8e5*x - 7e5*x^3)/s^2\"\n",
                      "[inputs]\nu = { unit = \"-\" }\n"),
          evenly(1.0 / rate, 600),
          {0.0, 0.0},
          {},
          false,
          {},
          64.0,
          1e-5};
  for (const double t : w.t) {
    w.input.push_back(0.0);
    for (int k = 1; k < 30; ++k) w.input.back() += 0.03 * std::cos(6.28318530718 * 4.1 * k * t + 0.7 * k * k);
  }
  w.rates = [u = w.input](const Vector& x, Vector& dx, double t) {
    const auto i = std::min(static_cast<std::size_t>(std::max(std::floor(t * rate * (1.0 + 1e-14) + 1e-9), 0.0)), u.size() - 2);
    const double share = t * rate - static_cast<double>(i), now = u[i] + share * (u[i + 1] - u[i]);
    dx = {x[1], 1e5 * now - 20.0 * x[1] - 1.8e5 * x[0] - 7e5 * x[0] * x[0] * x[0]};
  };
  return w;
}

World van_der_pol() {
  return {"VanDerPolOfMu1000",
          system_text("x = { unit = \"-\" }\nv = { unit = \"1/s\" }\n", "x = \"v\"\nv = \"1000*(1 - x^2)*v/s - x/s^2\"\n"),
          evenly(1.0, 1700),
          {2.0, 0.0},
          [](const Vector& x, Vector& dx, double) {
            dx = {x[1], 1000.0 * (1.0 - x[0] * x[0]) * x[1] - x[0]};
          },
          true,
          {},
          20.0};
}

World robertson() {
  Vector t{0.0};
  for (double next = 1e-5; next < 100.0; next *= 1.5) t.push_back(next);
  return {"Robertson",
          system_text("x = { unit = \"-\" }\nb = { unit = \"-\" }\nc = { unit = \"-\" }\n",
                      "x = \"(-0.04*x + 1e4*b*c)/s\"\nb = \"(0.04*x - 1e4*b*c - 3e7*b^2)/s\"\nc = \"3e7*b^2/s\"\n"),
          t,
          {1.0, 0.0, 0.0},
          [](const Vector& x, Vector& dx, double) {
            const double slow = 0.04 * x[0] - 1e4 * x[1] * x[2], fast = 3e7 * x[1] * x[1];
            dx = {-slow, slow - fast, fast};
          },
          true,
          {},
          100.0};
}

World gap_of_an_hour() {
  Vector t = evenly(10.0, 60);
  for (int i = 0; i < 60; ++i) t.push_back(4190.0 + 10.0 * i);
  return {
      "GapOfAnHour",
      system_text("x = { unit = \"-\" }\nv = { unit = \"1/s\" }\n", "x = \"v\"\nv = \"-1e-3*v/s + (1e-4*sin(0.01*t/s) - 4e-4*x)/s^2\"\n"),
      t,
      {1.0, 0.0},
      [](const Vector& x, Vector& dx, double now) {
        dx = {x[1], -1e-3 * x[1] - 4e-4 * x[0] + 1e-4 * std::sin(0.01 * now)};
      },
      false,
      {},
      40.0};
}

World lorenz() {
  return {"LorenzOverALyapunovTime",
          system_text("x = { unit = \"-\" }\ny = { unit = \"-\" }\nz = { unit = \"-\" }\n",
                      "x = \"10*(y - x)/s\"\ny = \"(x*(28 - z) - y)/s\"\nz = \"(x*y - 8/3*z)/s\"\n"),
          evenly(0.02, 56),
          {1.0, 1.0, 20.0},
          [](const Vector& x, Vector& dx, double) {
            dx = {10.0 * (x[1] - x[0]), x[0] * (28.0 - x[2]) - x[1], x[0] * x[1] - 8.0 / 3.0 * x[2]};
          },
          false,
          {},
          64.0};
}

/// A ball on stiff ground: the contact lasts 3 ms of a flight of a second, and the force on it has a kink.
World bouncing_ball() {
  return {"BouncingBall",
          system_text("x = { unit = \"-\", scale = 1.0 }\nv = { unit = \"1/s\", scale = 4.0 }\n",
                      "x = \"v\"\nv = \"(1e6*max(-x, 0)*(1 - 0.1*v*s) - 9.81)/s^2\"\n"),
          evenly(0.01, 300),
          {1.0, 0.0},
          [](const Vector& x, Vector& dx, double) {
            dx = {x[1], -9.81 + 1e6 * std::max(-x[0], 0.0) * (1.0 - 0.1 * x[1])};
          },
          false,
          {},
          40.0,
          1e-5};
}

class FreeRunOf : public testing::TestWithParam<World> {
 protected:
  FreeRunOf() {
    signals_.name = "made up";
    signals_.t = world_.t;
    if (!world_.input.empty()) signals_.inputs = {{"u", "-", world_.input, 0.0}};
    inputs_ = input_table(signals_, model_);
  }

  RowMatrix run() { return run_states({stepper_, signals_, inputs_}, {0, signals_.samples(), world_.x0.data()}); }

  const World& world_ = GetParam();
  const std::shared_ptr<Registry> known_ = registry_with(world_.text);
  const Model model_ = assemble(request_of("text"), *known_);
  Stepper stepper_{model_};
  Signals signals_;
  InputTable inputs_;
};
INSTANTIATE_TEST_SUITE_P(Every, FreeRunOf,
                         testing::Values(driven_duffing(), van_der_pol(), robertson(), gap_of_an_hour(), lorenz(), bouncing_ball()),
                         [](const auto& world) { return world.param.name; });

/// Largest error of each state, of its range.
Vector errors_of(const RowMatrix& x, const RowMatrix& exact) {
  Vector out;
  for (Eigen::Index j = 0; j < x.cols(); ++j)
    out.push_back((x.col(j) - exact.col(j)).cwiseAbs().maxCoeff() / (exact.col(j).maxCoeff() - exact.col(j).minCoeff()));
  return out;
}

TEST_P(FreeRunOf, ErrsByLessThanAnyReadingWouldShow) {
  const RowMatrix exact = reference(world_);
  inputs_.plan = plan_run({stepper_, signals_, inputs_}, world_.x0.data());
  EXPECT_EQ(inputs_.plan.lack, "");
  const RowMatrix x = run();
  ASSERT_EQ(x.rows(), exact.rows()) << stepper_.failure();
  const Vector errors = errors_of(x, exact);
  for (std::size_t j = 0; j < errors.size(); ++j) {
    EXPECT_LT(errors[j], world_.accuracy) << "state " << j;
    RecordProperty("state_" + std::to_string(j), std::to_string(errors[j]));
  }
  const double parts = static_cast<double>(inputs_.plan.parts.size()) / static_cast<double>(signals_.samples() - 1);
  EXPECT_LT(parts, world_.most_parts) << in_words({inputs_.plan});
  std::printf("%s: errors", world_.name);
  for (const double error : errors) std::printf(" %.1e", error);
  std::printf(" of the range; %s\n", in_words({inputs_.plan}).c_str());
}

/// A plan that is made along a reference carries the model's own motion too, a little beside it.
TEST_P(FreeRunOf, AlongAReferenceErrsByLessThanAPerCentAtAToleranceOf1em7) {
  const RowMatrix exact = reference(world_);
  inputs_.plan = plan_along({stepper_, signals_, inputs_}, exact, 1e-7);
  EXPECT_EQ(inputs_.plan.lack, "");
  const RowMatrix x = run();
  ASSERT_EQ(x.rows(), exact.rows()) << stepper_.failure();
  for (const double error : errors_of(x, exact)) EXPECT_LT(error, 1e-2);
}

TEST(IntegrationPlan, OfAMotionThatOneStepPerSampleFollowsIsOneStepPerSample) {
  const Model model = Case{"", parachute(true)}.model();
  Stepper stepper(model);
  Signals signals;
  signals.t = evenly(1.0 / 60.0, 200);
  signals.inputs = {{"phi", "rad", Vector(200, 0.3), 0.0}, {"phi_rate", "rad/s", Vector(200, 0.0), 0.0}};
  InputTable inputs = input_table(signals, model);
  const Vector x0 = {0.2, 0.4};
  const RowMatrix before = run_states({stepper, signals, inputs}, {0, 200, x0.data()});
  inputs.plan = plan_along({stepper, signals, inputs}, before, kSearchTolerance);
  EXPECT_EQ(inputs.plan.parts, std::vector<StepPart>(199));
  EXPECT_EQ(run_states({stepper, signals, inputs}, {0, 200, x0.data()}), before) << "the same bits as without a plan";
}

TEST(IntegrationPlan, SaysWhereTwentyThousandStepsDoNotSuffice) {
  const auto known = registry_with(system_text("x = { unit = \"-\" }\n", "x = \"1e9*cos(1e9*t/s)*(1 + 1e-9*x)/s\"\n"));
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  Signals signals;
  signals.t = {0.0, 1.0};
  const double x0 = 0.0;
  const IntegrationPlan plan = plan_run({stepper, signals, input_table(signals, model)}, &x0);
  EXPECT_THAT(plan.lack, AllOf(HasSubstr("at t = "), HasSubstr("state x"), HasSubstr("of its range")));
}

TEST(IntegrationPlan, KeepsToAFastestRateThatTheSystemGives) {
  const std::string text = system_text("x = { unit = \"-\" }\n", "x = \"-x/s\"\n");
  for (const double rate : {100.0, 1e4}) {
    const auto known = registry_with("[system]\nfastest_rate = " + std::to_string(rate) + "\n" + text);
    const Model model = assemble(request_of("text"), *known);
    Stepper stepper(model);
    Signals signals;
    signals.t = {0.0, 0.1};
    const double x0 = 1.0;
    const IntegrationPlan plan = plan_run({stepper, signals, input_table(signals, model)}, &x0, kSearchTolerance);
    EXPECT_GE(static_cast<double>(plan.parts.size()), std::min(0.1 * rate / kLargestProduct, 1000.0)) << rate;
  }
}

TEST(IntegrationPlan, RefinedHasEveryPartInTwo) {
  IntegrationPlan plan;
  plan.parts = {{0.5, true}, {1.0, false}, {1.0, false}};
  plan.first = {0, 2, 3};
  const IntegrationPlan finer = refined(plan);
  EXPECT_EQ(finer.parts, (std::vector<StepPart>{{0.25, true}, {0.5, true}, {0.75, false}, {1.0, false}, {0.5, false}, {1.0, false}}));
  EXPECT_EQ(finer.first, (std::vector<std::size_t>{0, 4, 6}));
}

TEST(IntegrationPlan, AtAFinerToleranceErrsByTheRatioAskedFor) {
  constexpr double ratio = 0.05;
  const World duffing = driven_duffing();
  const auto known = registry_with(duffing.text);
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  Signals signals;
  signals.t = duffing.t;
  signals.inputs = {{"u", "-", duffing.input, 0.0}};
  const RowMatrix exact = reference(duffing);
  InputTable inputs = input_table(signals, model);
  std::vector<double> errors;
  for (const double tolerance : {1e-6, 0.0}) {
    inputs.plan = plan_along({stepper, signals, inputs}, exact, tolerance > 0.0 ? tolerance : finer_tolerance({inputs.plan}, ratio));
    const RowMatrix x = run_states({stepper, signals, inputs}, {0, signals.samples(), duffing.x0.data()});
    errors.push_back((x - exact).col(0).norm());
  }
  EXPECT_LT(errors[1], 2.0 * ratio * errors[0]);
  EXPECT_GT(errors[1], 0.02 * ratio * errors[0]) << "no finer than is needed";
}

TEST(IntegrationPlan, PartsBesideShortOnesAreAtMostTwiceAsLong) {
  const World ball = bouncing_ball();
  const auto known = registry_with(ball.text);
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  Signals signals;
  signals.t = ball.t;
  const InputTable inputs = input_table(signals, model);
  const RowMatrix exact = reference(ball);
  const IntegrationPlan plan = plan_along({stepper, signals, inputs}, exact, kSearchTolerance);
  double before = 1.0;
  for (std::size_t i = 0; i + 1 < signals.samples(); ++i) {
    double from = 0.0;
    if (plan.of(i).size() == 1) before = 1.0;
    for (const StepPart& part : plan.of(i)) {
      EXPECT_LE(part.to - from, 2.0 * before * (1.0 + 1e-9)) << i;
      before = part.to - from;
      from = part.to;
    }
    EXPECT_EQ(from, 1.0);
  }
}

}  // namespace
}  // namespace misfit
