#include "misfit/inference/own_states.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(OwnStates, OfPlayAreTakenAsKnown) {
  const Swing swing(testing_models::effect("backlash", {{"displacement", "x"}, {"port", "torque"}}));
  EXPECT_EQ(swing.own().sigma[0], 0.0);
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
