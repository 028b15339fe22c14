#include "misfit/inference/states.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/fit/planar_model.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_planar;

TEST(MeasurementNoise, FindsATenthOfADegreeOnTheValidationMotion) {
  EXPECT_NEAR(measurement_noise(validation_signals().measured[0].values) / degree, 0.1, 0.005);
}

TEST(MeasurementNoise, IsUnmovedByWildSamplesAndGaps) {
  auto values = validation_signals().measured[0].values;
  for (std::size_t i = 50; i < values.size(); i += 100) values[i] += 20.0 * degree;
  for (std::size_t i = 0; i < values.size(); i += 100) values[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(measurement_noise(values) / degree, 0.1, 0.015);
}

TEST(MeasurementNoise, OfAFewSamplesIsNotGiven) { EXPECT_TRUE(std::isnan(measurement_noise(std::vector<double>(14, 1.0)))); }

TEST(MeasurementNoise, OfSmoothMotionIsNearlyNothing) {
  std::vector<double> values;
  for (double t : even_times(2000, 1.0 / 59.94)) values.push_back(0.1 * std::sin(11.0 * t));  // ω h = 0.18
  EXPECT_LT(measurement_noise(values), 0.003 * 0.1);
}

TEST(UsualStep, IsTheMedianDifference) {
  EXPECT_DOUBLE_EQ(usual_step({0.0, 0.5, 1.0, 1.5, 7.0}), 0.5);
  EXPECT_DOUBLE_EQ(usual_step({}), 1.0);
}

TEST(ReconstructStates, IsExactOnAParabolaAlsoAtUnevenTimes) {
  const Model model = assemble(eq_8(), registry());
  std::vector<double> t, y;
  for (int i = 0; i < 50; ++i) {
    t.push_back(0.1 * i + (i % 3 == 0 ? 0.02 : 0.0));
    y.push_back(0.3 + 0.2 * t.back() - 0.05 * t.back() * t.back());
  }
  const ReconstructedStates s = reconstruct_states(model, measured(t, y));
  EXPECT_TRUE(s.shown[0] && s.shown[1]);
  for (Eigen::Index i = 2; i < 48; ++i) {
    const auto k = static_cast<std::size_t>(i);
    ASSERT_TRUE(s.ok[k]);
    EXPECT_NEAR(s.x(i, 0), y[k], 1e-12);
    EXPECT_NEAR(s.x(i, 1), 0.2 - 0.1 * t[k], 1e-11);
    EXPECT_NEAR(s.dx(i, 0), s.x(i, 1), 0.0);
    EXPECT_NEAR(s.dx(i, 1), -0.1, 1e-9);
  }
}

TEST(ReconstructStates, WidensItsReachWhereSamplesAreMissingUpToNine) {
  const Model model = assemble(eq_8(), registry());
  const auto t = even_times(60, 0.1);
  std::vector<double> y;
  for (double time : t) y.push_back(0.2 + 0.03 * time - 0.01 * time * time);
  y[10] = y[20] = y[22] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 40; i < 47; ++i) y[i] = std::numeric_limits<double>::quiet_NaN();
  const ReconstructedStates s = reconstruct_states(model, measured(t, y));
  EXPECT_TRUE(s.ok[10]);
  EXPECT_TRUE(s.ok[18]);
  ASSERT_TRUE(s.ok[21]);  // three of five, five of seven
  EXPECT_NEAR(s.x(21, 1), 0.03 - 0.02 * t[21], 1e-11);
  EXPECT_FALSE(s.ok[43]);  // two of nine
  EXPECT_FALSE(s.ok[0]);   // nothing before it
}

TEST(ReconstructStates, IsNotStretchedOverAGapInTime) {
  const Model model = assemble(eq_8(), registry());
  auto t = even_times(40, 0.1);
  for (std::size_t i = 20; i < t.size(); ++i) t[i] += 1.0;
  const ReconstructedStates s = reconstruct_states(model, measured(t, std::vector<double>(t.size(), 0.2)));
  EXPECT_FALSE(s.ok[19]);
  EXPECT_FALSE(s.ok[20]);
  EXPECT_TRUE(s.ok[18]);
  EXPECT_TRUE(s.ok[21]);
}

/// A level that an input of 3 K/s heats, with an effect that has a memory.
ReconstructedStates states_with(const EffectRequest& effect, double level) {
  static const auto known = testing_models::registry_with(R"toml([states]
T = { unit = "K" }
[inputs]
u = { unit = "K/s" }
[parameters]
loss = { unit = "1/s", value = 0.1, free = true }
[equations]
T = "u - loss*T"
[outputs]
T = { unit = "K", noise = 0.1 }
)toml");
  const Model model = assemble(testing_models::request_of("text", {effect}), *known);
  Signals signals;
  signals.t = even_times(40, 0.5);
  signals.measured.push_back({"T", "K", std::vector<double>(40, level)});
  signals.inputs.push_back({"u", "K/s", std::vector<double>(40, 3.0)});
  return reconstruct_states(model, signals);
}

TEST(ReconstructStates, AMemoryThatFollowsItsInputBeginsAtTheInput) {
  const ReconstructedStates s = states_with(testing_models::effect("input_lag", {{"input", "u"}, {"port", "dT/dt"}}), 20.0);
  EXPECT_NEAR(s.x(0, 1), 3.0, 1e-9);
  EXPECT_NEAR(s.x(39, 1), 3.0, 1e-9);
}

TEST(ReconstructStates, AMemoryThatStandsStillInsideAClearanceKeepsItsDeclaredStart) {
  const EffectRequest play = testing_models::effect("backlash", {{"displacement", "T"}, {"port", "dT/dt"}});
  EXPECT_EQ(states_with(play, 0.05).x(0, 1), 0.0) << "half of the clearance is 0.1";
  EXPECT_NEAR(states_with(play, 20.0).x(0, 1), 19.9, 1e-6) << "it was pushed there";
}

TEST(MotionFrequency, IsThatOfASine) {
  const Model model = assemble(eq_8(), registry());
  const auto t = even_times(3000, 1.0 / 59.94);
  std::vector<double> y;
  for (double s : t) y.push_back(0.2 + 0.05 * std::sin(10.0 * s));
  EXPECT_NEAR(motion_frequency(model, reconstruct_states(model, measured(t, y))), 10.0, 0.5);  // five-point lines flatten slopes by 5 %
}

TEST(MotionFrequency, OfAChannelThatStandsStillIsZero) {
  const Model model = assemble(eq_8(), registry());
  const auto t = even_times(100, 0.1);
  EXPECT_EQ(motion_frequency(model, reconstruct_states(model, measured(t, std::vector<double>(t.size(), 0.0)))), 0.0);
}

TEST(MotionFrequency, OfASwingAboutALargeLevelIsThatOfTheSwing) {
  const Model model = assemble(eq_8(), registry());
  constexpr double omega = 3.0, level = 1e9;
  ReconstructedStates s;
  s.x = RowMatrix(1000, 2);
  s.ok.assign(1000, true);
  s.shown = {true, true};
  for (Eigen::Index i = 0; i < 1000; ++i) {
    const double phase = 0.02 * 3.14159265358979323846 * static_cast<double>(i);
    s.x.row(i) << level + 10.0 * std::sin(phase), 10.0 * omega * std::cos(phase);
  }
  EXPECT_NEAR(motion_frequency(model, s), omega, 1e-3);
}

}  // namespace
}  // namespace misfit
