#include "misfit/inference/own_states.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/fit/planar_model.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_planar;

constexpr double frequency = 5.0, phase = 1.0;  // of the swing [rad/s], [rad]

/// An oscillator whose recorded angle is a swing with 2 mrad of noise that began long before.
struct Swing {
  explicit Swing(const EffectRequest& effect)
      : systems(testing_models::registry_with(R"toml([states]
x = { unit = "rad" }
v = { unit = "rad/s", rate_of = "x" }
[parameters]
stiffness = { unit = "1/s^2", value = 25.0, free = true }
[ports]
torque = { unit = "rad/s^2", rate = "v" }
[equations]
v = "torque - stiffness*x"
[outputs]
x = { unit = "rad", noise = 0.002 }
)toml")),
        model(assemble(testing_models::request_of("text", {effect}), *systems)) {
    signals.t = even_times(400, 0.02);
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.002);
    std::vector<double> x;
    for (double t : signals.t) x.push_back(angle(t) + noise(random));
    signals.measured.push_back({"x", "rad", x});
  }
  static double angle(double t) { return std::sin(frequency * t + phase); }
  [[nodiscard]] ReconstructedStates states() const { return reconstruct_states(model, signals); }
  [[nodiscard]] OwnStates own() const { return own_states_along(model, signals, states()); }
  [[nodiscard]] double first_time() const {
    const ReconstructedStates s = states();
    return signals.t[std::find(s.ok.begin(), s.ok.end(), true) - s.ok.begin()];
  }

  std::shared_ptr<Registry> systems;
  Model model;
  Signals signals;
};

const EffectRequest late = testing_models::effect("sensor_delay", {{"output", "x"}});

TEST(OwnStates, OfADelayBeginWithWhatTheSwingWasBeforeTheRecording) {
  constexpr double tau = 0.05;  // the effect's own start
  const Swing swing(late);
  const OwnStates own = swing.own();
  const double t = swing.first_time();
  EXPECT_NEAR(Swing::angle(t) - tau * own.start[1], Swing::angle(t - tau), 0.01) << "at rest: wrong by 0.2";
  EXPECT_NEAR(own.start[1], frequency * std::cos(frequency * (t - tau / 2.0) + phase), 0.15);
  EXPECT_NEAR(own.sigma[1], frequency / std::sqrt(2.0), 0.3) << "the RMS of the rate";
}

TEST(OwnStates, OfADelayFollowTheSwing) {
  const Swing swing(late);
  const OwnStates own = swing.own();
  for (Eigen::Index i = 5; i < own.z.rows() - 5; i += 7) {
    const double t = swing.signals.t[i];
    EXPECT_NEAR(Swing::angle(t) - 0.05 * own.z(i, 1), Swing::angle(t - 0.05), 0.015);
  }
}

TEST(OwnStates, OfAMemoryThatOutlivesTheRecordingAreAsUncertainAsTheSwingIsWide) {
  Swing swing(testing_models::effect("lag", {{"level", "x"}, {"port", "torque"}}));
  for (Parameter& p : swing.model.parameters) {
    if (p.name == "tau") p.value = 100.0;
  }
  const OwnStates own = swing.own();
  EXPECT_LT(std::abs(own.start[0]), 1.5);
  EXPECT_GT(own.sigma[0], 0.5);
  EXPECT_LT(own.sigma[0], 2.0);
}

TEST(OwnStates, DoNotLookAtWhatIsHeldOut) {
  Swing swing(late);
  swing.signals.validation_from = 6.0;
  const OwnStates before = swing.own();
  for (std::size_t i = 310; i < 400; ++i) swing.signals.measured[0].values[i] *= 3.0;
  const OwnStates after = swing.own();
  EXPECT_EQ(before.start, after.start);
  EXPECT_EQ(before.sigma, after.sigma);
}

TEST(OwnStates, OfPlayAreUncertainByNoMoreThanTheyMove) {
  const Swing swing(testing_models::effect("backlash", {{"displacement", "x"}, {"port", "torque"}}));
  const OwnStates own = swing.own();
  EXPECT_GT(own.sigma[0], 0.0);
  EXPECT_LE(own.sigma[0], own.z.maxCoeff() - own.z.minCoeff());
  EXPECT_LT(own.z.cwiseAbs().maxCoeff(), 1.0) << "the swing less the play";
}

TEST(OwnStates, ThatOnlyAddUpAreKnownWhereTheyBegin) {
  const Swing swing(testing_models::effect("turning_ripple", {{"speed", "v"}, {"port", "torque"}}));
  const OwnStates own = swing.own();
  EXPECT_EQ(own.start[0], 0.0);
  EXPECT_EQ(own.sigma[0], 0.0);
  const double first = swing.first_time();
  for (Eigen::Index i = 10; i < own.z.rows() - 10; i += 13)
    EXPECT_NEAR(own.z(i, 0), Swing::angle(swing.signals.t[i]) - Swing::angle(first), 0.05) << "the way that v goes";
}

/// A surface that follows a square wave of 10 deg at 60 deg/s and is 5 deg away from its command when the recording begins.
TEST(OwnStates, OfALimitedRateBeginWhereTheMotionIsNotAtTheCommand) {
  constexpr double step = 0.02, limit = 60.0 * std::numbers::pi / 180.0, command = 10.0 * std::numbers::pi / 180.0;
  const auto systems = testing_models::registry_with(R"toml([states]
x = { unit = "rad" }
[inputs]
u = { unit = "rad", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 0.001, free = true }
[equations]
x = "(u - x)/tau"
[outputs]
x = { unit = "rad", noise = 0.001 }
)toml");
  Model model =
      assemble(testing_models::request_of("text", {testing_models::effect("rate_limit", {{"input", "u"}, {"port", "u"}})}), *systems);
  for (Parameter& p : model.parameters) {
    if (p.name == "rate_limit") p.value = limit;
  }
  Signals signals;
  signals.t = testing_planar::even_times(600, step);
  signals.measured = {{"x", "rad", {}, 0.0}};
  signals.inputs = {{"u", "rad", {}, 0.0}};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.001);
  double x = command / 2.0;
  for (double t : signals.t) {
    const double u = std::fmod(t, 1.6) < 0.8 ? command : -command;
    signals.measured[0].values.push_back(x + noise(random));
    signals.inputs[0].values.push_back(u);
    x += std::clamp(u - x, -limit * step, limit * step);
  }
  const ReconstructedStates states = reconstruct_states(model, signals);
  const Eigen::Index first = std::find(states.ok.begin(), states.ok.end(), true) - states.ok.begin();
  const OwnStates own = own_states_along(model, signals, states);
  EXPECT_GT(own.sigma[0], 0.001) << "it is to be estimated";
  EXPECT_NEAR(own.start[0], states.x(first, 0), 2.0 * own.sigma[0]);
  for (Eigen::Index i = 200; i < 590; i += 13) EXPECT_NEAR(own.z(i, 0), signals.measured[0].values[static_cast<std::size_t>(i)], 0.03) << i;
}

TEST(OwnStates, OfAShortRecordingAreAtRest) {
  Swing swing(late);
  swing.signals.t.resize(12);
  swing.signals.measured[0].values.resize(12);
  const OwnStates own = swing.own();
  EXPECT_EQ(own.start[1], 0.0);
  EXPECT_TRUE(own.z.allFinite());
}

}  // namespace
}  // namespace misfit
