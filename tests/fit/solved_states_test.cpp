#include "misfit/inference/solved_states.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/trajectory_start.h"
#include "misfit/inference/states.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

/// A pendulum whose bob a camera sees.
std::string pendulum_text(const std::string& outputs) {
  return R"toml(
[states]
theta = { unit = "rad" }
omega = { unit = "rad/s", rate_of = "theta" }
[parameters]
k = { unit = "1/s^2", value = 15.0, bounds = [1.0, 100.0], free = true }
c = { unit = "1/s", value = 0.1, bounds = [0.0, 10.0], free = true }
L = { unit = "m", value = 0.5 }
[equations]
omega = "-k*sin(theta) - c*omega"
[outputs]
)toml" + outputs;
}

const std::string both = R"toml(
x = { unit = "m", formula = "L*sin(theta)" }
y = { unit = "m", formula = "-L*cos(theta)" }
)toml";

constexpr double length = 0.5, stiffness = 9.81 / length, damping = 0.05, sigma = 0.002;

struct Swing {
  std::vector<Signals> signals;
  std::vector<double> theta, omega;
};

/// By small steps of its own.
Swing swing(double from, std::size_t samples, std::size_t outputs) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Swing out{{Signals{}}, {}, {}};
  Signals& s = out.signals.front();
  s.name = "swing";
  s.measured = {{"x", "m", {}, 0.0}, {"y", "m", {}, 0.0}};
  double theta = from, omega = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    s.t.push_back(0.01 * static_cast<double>(i));
    out.theta.push_back(theta);
    out.omega.push_back(omega);
    s.measured[0].values.push_back(length * std::sin(theta) + sigma * normal(random));
    s.measured[1].values.push_back(-length * std::cos(theta) + sigma * normal(random));
    for (int k = 0; k < 1000; ++k) {
      omega += 1e-5 * (-stiffness * std::sin(theta) - damping * omega);
      theta += 1e-5 * omega;
    }
  }
  s.measured.resize(outputs);
  return out;
}

Model model_of(const std::string& outputs) {
  const auto known = registry_with(pendulum_text(outputs));
  return assemble(request_of("text"), *known);
}

TEST(SolvedStates, FindTheAngleFromBothCoordinates) {
  constexpr std::size_t samples = 300;
  const Swing truth = swing(2.5, samples, 2);
  const ReconstructedStates states = reconstruct_states(model_of(both), truth.signals.front());
  EXPECT_TRUE(states.shown[0] && states.shown[1]);
  for (Eigen::Index i = 5; i + 5 < static_cast<Eigen::Index>(samples); ++i) {
    EXPECT_NEAR(states.x(i, 0), truth.theta[static_cast<std::size_t>(i)], 6.0 * sigma / length);
    EXPECT_NEAR(states.x(i, 1), truth.omega[static_cast<std::size_t>(i)], 0.8);
  }
}

/// One output is a state, the other depends on it and on one that nothing shows alone.
TEST(SolvedStates, TakeStatesThatAreShownAsMeasured) {
  const auto known = registry_with(R"toml(
[states]
a = { unit = "m" }
b = { unit = "m" }
[parameters]
k = { unit = "1/s", value = 1.0, free = true }
[equations]
a = "-k*a"
b = "-k*b"
[outputs]
a = { unit = "m" }
distance = { unit = "m", formula = "sqrt(a^2 + b^2)" }
)toml");
  Signals s;
  s.name = "record";
  s.measured = {{"a", "m", {}, 0.0}, {"distance", "m", {}, 0.0}};
  for (int i = 0; i < 20; ++i) {
    s.t.push_back(0.1 * i);
    s.measured[0].values.push_back(30.0 + i);
    s.measured[1].values.push_back(std::hypot(30.0 + i, 40.0));
  }
  const SolvedStates solved = solve_outputs(assemble(request_of("text"), *known), s, {true, false});
  ASSERT_EQ(solved.states, std::vector<int>{1});
  for (const double b : solved.values[0]) EXPECT_NEAR(std::abs(b), 40.0, 1e-6);
}

TEST(SolvedStates, FindTheAngleFromOneCoordinateWhereItsBranchIsKnown) {
  const Swing truth = swing(1.0, 300, 1);
  const Model model = model_of("x = { unit = \"m\", formula = \"L*sin(theta)\" }\n");
  const SolvedStates solved = solve_outputs(model, truth.signals.front(), {false, false});
  ASSERT_EQ(solved.states, std::vector<int>{0});
  for (std::size_t i = 0; i < truth.theta.size(); ++i) EXPECT_NEAR(solved.values.front()[i], truth.theta[i], 0.05);
}

TEST(SolvedStates, AreNoneWhereOneOutputHoldsTwo) {
  const Swing truth = swing(1.0, 300, 1);
  const Model model = model_of("x = { unit = \"m\", formula = \"L*theta + 0.1*L*omega*omega/k\" }\n");
  EXPECT_TRUE(solve_outputs(model, truth.signals.front(), {false, false}).states.empty());
}

TEST(SolvedStates, LetTheFilterBegin) {
  const Swing truth = swing(0.8, 1500, 2);
  const TrajectoryStart start = trajectory_start(model_of(both), truth.signals);
  FilterOptions one;
  one.threads = 1;
  const Fit fit = filter_error(start.from, truth.signals, one).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_NEAR(fit.parameters.at("k").value, stiffness, 4.0 * fit.parameters.at("k").sigma);
  EXPECT_NEAR(fit.parameters.at("c").value, damping, 4.0 * fit.parameters.at("c").sigma);
  EXPECT_NEAR(fit.noise.at("x").value, sigma, 0.2 * sigma);
}

}  // namespace
}  // namespace misfit
