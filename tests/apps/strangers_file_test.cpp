// A file of somebody else's, from nothing to a verdict: misfit init DATA.csv, misfit run DATA --auto.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/apps/program.h"

namespace {

using namespace program;
using testing::HasSubstr;

/// Voltage in, speed out; dry friction of 100 rad/s^2.
std::string motor() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(-12.0, 12.0);
  std::string text = "t[s],u[V],w[rad/s]\n";
  double w = 0.0, u = 0.0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 120 == 0) u = level(random);
    text += fmt::format("{:.3f},{:.3f},{:.3f}\n", 0.005 * k, u, w + 0.3 * normal(random));
    for (int i = 0; i < 100; ++i) w += 5e-5 * (200.0 * u - 10.0 * w - 100.0 * std::tanh(w / 0.1));
  }
  return text;
}

/// Of a house the weather, measured but no command, and a thermostat's heater; nothing is missing.
std::string house() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::string text = "t[s],T_out[degC],heater[W],T_in[degC]\n";
  double inside = 20.0, heat = 4500.0;
  const auto outside = [](double t) { return 4.0 + 5.0 * std::sin(7.27e-5 * t) + 2.0 * std::sin(9e-6 * t); };
  for (int k = 0; k < 1500; ++k) {
    if (inside < 19.5) heat = 4500.0;
    if (inside > 21.0) heat = 0.0;
    text += fmt::format("{},{:.3f},{},{:.3f}\n", 600 * k, outside(600.0 * k) + 0.05 * normal(random), heat, inside + 0.03 * normal(random));
    for (int i = 0; i < 60; ++i) inside += 10.0 * (180.0 * (outside(600.0 * k + 10.0 * i) - inside) + heat) / 6e6;
  }
  return text;
}

/// Water of 30 l that is heated while some of it is drawn, with the names of the house: T_in is the inlet.
std::string heater() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::string text = "t[s],power[kW],flow[l/min],T_in[degC],T_out[degC]\n";
  double T = 40.0, power = 3.0, flow = 1.0;
  for (int k = 0; k < 1500; ++k) {
    if (k % 90 == 0) power = 6.0 * uniform(random);
    if (k % 50 == 0) flow = 4.0 * uniform(random);
    const double inlet = 12.0 + 2.0 * std::sin(0.005 * k) + 0.3 * std::sin(0.007 * k);
    text += fmt::format("{},{:.3f},{:.2f},{:.2f},{:.2f}\n", 5 * k, power, flow, inlet, T + 0.08 * normal(random));
    flow = std::round(100.0 * flow) / 100.0;
    for (int i = 0; i < 20; ++i) T += 0.25 * (1000.0 * power / 4186.0 + flow / 60.0 * (inlet - T) - 2.0 / 4186.0 * (T - 20.0)) / 30.0;
  }
  return text;
}

struct Verdict {
  std::string model, kind, sentence;
};

Verdict verdict_on(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  const fs::path data = folder.write(name + ".csv", text), study = folder.path() / name;
  const Outcome begun = run({"init", data.string(), "--out", study.string()});
  EXPECT_EQ(begun.status, 0) << begun.err;
  EXPECT_THAT(begun.out, HasSubstr("next: misfit run " + study.string() + " --auto"));
  const Outcome outcome = run({"run", study.string(), "--auto"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json verdict = json::parse(content(study / "out" / "verdict.json"));
  return {content(study / "model.toml"), verdict.at("verdict"), verdict.at("sentence")};
}

TEST(StrangersFile, OfAMotorWithDryFrictionItNamesTheFriction) {
  const Verdict v = verdict_on("motor", motor());
  EXPECT_THAT(v.model, HasSubstr("w = \"(w_rest + w_gain_u*u - w)/w_tau\""));
  EXPECT_THAT(v.sentence, testing::StartsWith("coulomb_friction (port = dw/dt, rate = w) was missing"));
}

TEST(StrangersFile, OfAHouseItTakesTheWeatherAsAnInputAndAddsNothing) {
  const Verdict v = verdict_on("house", house());
  EXPECT_THAT(
      v.model,
      HasSubstr("T_in = \"(zero_degC + T_in_rest + T_in_gain_T_out*(T_out - zero_degC) + T_in_gain_heater*heater - T_in)/T_in_tau\""));
  EXPECT_THAT(v.model, HasSubstr("T_out = { unit = \"K\", hold = \"first_order\" }"));
  EXPECT_TRUE(v.kind == "nothing_missing" || v.kind == "random_force" || v.kind == "not_decided") << v.sentence;
}

TEST(StrangersFile, OfAHeaterItTakesTheInletAsAnInputAndNamesWhatTheFlowDoes) {
  const Verdict v = verdict_on("heater", heater());
  EXPECT_THAT(v.model, HasSubstr("T_in = { unit = \"K\""));
  EXPECT_THAT(v.model, HasSubstr("T_out = \"(zero_degC + T_out_rest"));
  EXPECT_THAT(v.sentence,
              testing::StartsWith("bilinear_exchange (input = flow, level = T_out, other = T_in, port = dT_out/dt) was missing"));
}

/// One step of the lag promises 15, nearly significant, and a drift of a gain explains 86 of the 210 that the lag does. Simulated by the
/// bench of strangers (thermal_house, seed 461).
TEST(StrangersFile, OfAHouseWithHeavyWallsItNamesWhatTheyStore) {
  const Verdict v = verdict_on("walls", content(paths::source() / "tests/apps/records/house_with_heavy_walls.csv"));
  EXPECT_THAT(v.sentence, testing::StartsWith("lag was missing"));
}

/// A random force follows what walls of 12 h store; its first refit, from that estimate, does not explain the free run, and the one from
/// the study's own values does: 83.8e-6 1/s and 44979 s. Simulated by the bench of strangers (thermal_house, seed 540).
TEST(StrangersFile, OfAHouseWhoseWallsARandomForceFollowsItNamesWhatTheyStore) {
  const Verdict v = verdict_on("slow_walls", content(paths::source() / "tests/apps/records/house_with_slow_walls.csv"));
  EXPECT_THAT(v.sentence, testing::StartsWith("lag was missing"));
}

/// Walls of 20 MJ/K behind 90 W/K (222000 s, a third of the week): a random force of 1e5 s stood for what they store, so that no score was
/// significant, and 33 % of the gain (5.556 mK/W) were missing. Simulated by a reader of the README, by Euler steps of 5 s.
TEST(StrangersFile, OfAHouseWithAHiddenMassThatASlowForceStandsForItNamesThat) {
  const Verdict v = verdict_on("mass", content(paths::source() / "tests/apps/records/house_with_a_hidden_mass.csv"));
  EXPECT_THAT(v.sentence, testing::StartsWith("lag was missing"));
}

/// Walls of 24 MJ/K behind 200 W/K (120000 s): beside a force of 1e5 s that stands for them a drift was significant and the lag was not
/// (9 predicted, 193 once fitted). Simulated by another reader of the README, by Runge-Kutta steps of 6 s.
TEST(StrangersFile, OfAHouseWithASlowWallBesideWhichADriftIsSignificantItNamesTheWall) {
  const Verdict v = verdict_on("wall", content(paths::source() / "tests/apps/records/house_with_a_slow_wall.csv"));
  EXPECT_THAT(v.sentence, testing::StartsWith("lag was missing"));
}

/// Where the limited input begins was taken from what a search starts with: by that alone a share of 1.0005 came 12 higher than the whole,
/// so that "only a part of it" was found. The truth is 1.3768 rad/s. Simulated by the bench of strangers (servo, seed 550).
TEST(StrangersFile, OfAServoThatMovesNoFasterItNamesTheRateLimit) {
  const Verdict v = verdict_on("servo", content(paths::source() / "tests/apps/records/servo_with_a_slew_limit.csv"));
  EXPECT_THAT(v.sentence, testing::StartsWith("rate_limit (input = u, port = u) was missing"));
}

/// Every measurement is a multiple of 0.0586 K, of which the noise is more than any other; with 0.2 of a step of its own, it gains little
/// to know that. Simulated by the bench of strangers (thermal_house, seed 460).
TEST(StrangersFile, OfAHouseWithACoarseThermometerItNamesTheSteps) {
  const TemporaryFolder folder;
  folder.write("house.csv", content(paths::source() / "tests/apps/records/house_with_coarse_thermometer.csv"));
  const std::string study = (folder.path() / "house").string();
  ASSERT_EQ(run({"init", (folder.path() / "house.csv").string(), "--out", study}).status, 0);
  const Outcome outcome = run({"discover", study, "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json first = json::parse(content(folder.path() / "house/out/candidates.json")).at(0);
  EXPECT_EQ(first.at("effect"), "sensor_quantisation");
  EXPECT_TRUE(first.at("accepted").get<bool>()) << outcome.out;
  EXPECT_THAT(first.at("why").get<std::string>(), HasSubstr("seen in the measurements themselves"));
  EXPECT_NEAR(first.at("parameters").at("step").at("value").get<double>(), 0.058641, 1e-6);
  EXPECT_NEAR(first.at("held_out_gain").get<double>(), -18.5, 6.0)
      << "-160 with a sawtooth that is predicted to a hundredth of a step; of cells of one step on both sides it is -18";
}

/// Steps of 0.81 K on a range of 16 K, most measurements equal to the one before: with them as noise the house follows in 3010 ± 370 s.
/// What the bench of strangers simulated (thermal_house, seed 493) gives 12519 ± 40 s and 5.2762 ± 0.0092 mK/W before it is rounded.
TEST(StrangersFile, OfAHouseWithAThermometerOfTwentyStepsItFindsWhatTheHouseDoes) {
  const TemporaryFolder folder;
  folder.write("house.csv", content(paths::source() / "tests/apps/records/house_with_large_steps.csv"));
  const std::string study = (folder.path() / "house").string();
  ASSERT_EQ(run({"init", (folder.path() / "house.csv").string(), "--out", study}).status, 0);
  const Outcome outcome = run({"add", study, "sensor_quantisation", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::filesystem::path rung = folder.path() / "house/out/rungs/01_sensor_quantisation";
  EXPECT_THAT(content(rung / "study.toml"), HasSubstr(R"(fixed = ["rounded"])"));
  const json parameters = json::parse(content(rung / "out/fit/filter_error/fit.json")).at("parameters");
  const auto expect_within = [&](const char* name, double truth) {
    const double value = parameters.at(name).at("value").get<double>(), sigma = parameters.at(name).at("sigma").get<double>();
    EXPECT_NEAR(value, truth, 2.5 * sigma) << name;
    EXPECT_LT(sigma, 0.05 * truth) << name;
  };
  expect_within("T_tau", 12519.0);
  expect_within("T_gain_Q", 0.0052762);
}

}  // namespace
