#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/sim/trajectory.h"
#include "tests/model/cases.h"
#include "tests/model/declared_texts.h"
#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::AllOf;
using testing::HasSubstr;

std::string draining_tank(const std::string& more) {
  return "[states]\nx1 = { unit = \"V\"" + more + R"toml( }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
k1 = { unit = "V^0.5/s", value = 0.5, free = true }
k4 = { unit = "1/s", value = 0.3, free = true }
[equations]
x1 = "-k1*sqrt(x1) + k4*u"
[outputs]
y = { unit = "V", formula = "x1" }
)toml";
}

/// 60 samples at 0.1 s: nothing flows in for the first 3 s, then 1 V.
Signals filling() {
  Signals s;
  s.name = "tank";
  s.inputs = {{"u", "V", {}, 0.0}};
  for (int i = 0; i < 60; ++i) {
    s.t.push_back(0.1 * i);
    s.inputs[0].values.push_back(i < 30 ? 0.0 : 1.0);
  }
  return s;
}

TEST(DeclaredTank, EmptiesStaysEmptyAndFillsAgain) {
  const auto known = registry_with(draining_tank(", min = 0.0"));
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  const Signals signals = filling();
  const InputTable inputs = input_table(signals, model);
  const double x0 = 0.25;  // sqrt(x) falls by k1/2 per second: empty after 2 s
  const RowMatrix x = run_states({stepper, signals, inputs}, {0, 60, &x0});
  ASSERT_EQ(x.rows(), 60);
  EXPECT_GE(x.minCoeff(), 0.0);
  for (int i = 0; i < 15; ++i) EXPECT_NEAR(x(i, 0), std::pow(0.5 - 0.025 * i, 2), 1e-6) << i;
  for (int i = 22; i <= 30; ++i) EXPECT_EQ(x(i, 0), 0.0) << i;
  EXPECT_GT(x(31, 0), 0.02);
  double level = 0.0;  // by small Euler steps from the moment at which the pump starts
  constexpr double h = 1e-5;
  for (int i = 0; i < 290000; ++i) level += h * (0.3 - 0.5 * std::sqrt(level));
  EXPECT_NEAR(x(59, 0), level, 1e-3);
}

TEST(DeclaredTank, ForgetsWhereItCameFromOnceItWasEmpty) {
  const auto known = registry_with(draining_tank(", min = 0.0"));
  Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  const Signals signals = filling();
  const InputTable inputs = input_table(signals, model);
  const double x0 = 0.25;
  Segment linear;
  run_segment({stepper, signals, inputs}, {0, 60, &x0, true}, linear);
  ASSERT_TRUE(linear.finite);
  EXPECT_EQ(linear.end_rows(0, 2), 0.0) << "by the initial state";
  const auto end = [&](double value, int parameter) {
    std::vector<double> values = model.values();
    values[static_cast<std::size_t>(parameter)] = value;
    stepper.evaluator().set_parameters(values.data());
    Segment run;
    run_segment({stepper, signals, inputs}, {0, 60, &x0}, run);
    return Eigen::VectorXd(run.end);
  };
  for (int p = 0; p < 2; ++p) {
    const Eigen::VectorXd difference =
        central_difference([&](double value) { return end(value, p); }, model.parameters[static_cast<std::size_t>(p)].value);
    EXPECT_NEAR(linear.end_rows(0, p), difference[0], 1e-4 * std::abs(difference[0])) << p;
  }
}

TEST(DeclaredTank, WithoutARangeFailsInWords) {
  const auto known = registry_with(draining_tank(""));
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  const Signals signals = filling();
  const InputTable inputs = input_table(signals, model);
  const double x0 = 0.25;
  Segment out;
  run_segment({stepper, signals, inputs}, {0, 60, &x0, true}, out);
  EXPECT_FALSE(out.finite);
  EXPECT_THAT(stepper.failure(), AllOf(HasSubstr("at t = "), HasSubstr("x1 is -"), HasSubstr("sqrt(x1)"), HasSubstr("equation x1"),
                                       HasSubstr("k1 = 0.5 V^0.5/s")));
}

TEST(DeclaredSystem, ThatGrowsBeyondAllBoundsIsNamedWithItsStates) {
  const auto known = registry_with(R"toml(
[states]
x = { unit = "-" }
[parameters]
k = { unit = "1/s", value = 10.0 }
[equations]
x = "k*exp(x)"
[outputs]
y = { unit = "-", formula = "x" }
)toml");
  const Model model = assemble(request_of("text"), *known);
  Stepper stepper(model);
  double x = 1.0;
  stepper.prepare(&x, nullptr, 0.0);
  bool fine = true;
  for (int i = 0; fine && i < 100; ++i) fine = stepper.step(&x, {0.1 * i, 0.1 * (i + 1), nullptr, nullptr});
  EXPECT_FALSE(fine);
  EXPECT_THAT(stepper.failure(), AllOf(HasSubstr("at t = "), HasSubstr("exp(x)"), HasSubstr("k = 10 1/s")));
}

TEST(DeclaredSystem, TellsFrictionOnItsPortHowMuchMassTheForceMoves) {
  const auto known = registry_with(R"toml(
[states]
y = { unit = "m" }
v = { unit = "m/s", rate_of = "y" }
[parameters]
m = { unit = "kg", value = 500.0 }
k = { unit = "N/m", value = 20.0 }
[ports]
F = { unit = "N", rate = "v" }
[equations]
v = "(F - k*y)/m"
[outputs]
y = { unit = "m" }
)toml");
  ModelRequest request =
      with_values(request_of("text", {effect("coulomb_friction", {{"rate", "v"}, {"port", "F"}})}), {{"friction", 60.0}, {"width", 0.01}});
  const Model model = assemble(request, *known);
  Stepper stepper(model);
  const double x[] = {0.3, 1.0};
  stepper.prepare(x, nullptr, 0.0);
  EXPECT_NEAR(stepper.fastest_rate(), 60.0 / 0.01 / 500.0, 1e-9);
}

}  // namespace
}  // namespace misfit
