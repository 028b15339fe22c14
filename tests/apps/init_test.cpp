// misfit init: a file of columns becomes a study, or words say why not.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;
using testing::HasSubstr;

/// A swing that an input pushes: semicolons, decimal commas, milliseconds.
std::string swing() {
  std::string text = "# a logger wrote this\nt_ms;u_V;angle[deg]\n";
  double y = 10.0, rate = 0.0;
  for (int k = 0; k < 600; ++k) {
    const double u = k / 50 % 2;
    std::string row = std::to_string(20 * k) + ";" + std::to_string(u) + ";" + std::to_string(y) + "\n";
    for (char& c : row)
      if (c == '.') c = ',';
    text += row;
    rate += 0.02 * (-9.0 * (y - 5.0 * u) - 0.3 * rate);
    y += 0.02 * rate;
  }
  return text;
}

TEST(Init, WritesAStudyWithModelDataAndFigures) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("swing.csv", swing()), out = folder.path() / "study";
  const Outcome outcome = run({"init", data.string(), "--out", out.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("semicolons between cells, decimal commas, 1 comment line"));
  EXPECT_THAT(outcome.out, HasSubstr("one sample every 0.02 s (50 Hz)"));
  EXPECT_EQ(first_line(out / "swing.csv"), "t[s],u[V],angle[deg]");
  const std::string model = content(out / "model.toml");
  EXPECT_THAT(model, HasSubstr("angle_rate = { unit = \"rad/s\", rate_of = \"angle\""));
  EXPECT_THAT(model, HasSubstr("u = { unit = \"V\", hold = \"zero_order\" }"));
  EXPECT_THAT(model, HasSubstr("angle_gain_u = { unit = \"rad/V\""));
  EXPECT_THAT(content(out / "study.toml"), HasSubstr("data = \"swing.csv\""));
  for (const char* file : {"data_swing.svg", "data_swing.csv", "data_swing.gp"}) EXPECT_TRUE(fs::exists(out / "figures" / file)) << file;
}

TEST(Init, AMeasuredRateWithoutAUnitHasThatOfWhatItIsTheRateOf) {
  const TemporaryFolder folder;
  std::string text = "t[s],theta[rad],omega\n";
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k;
    text += std::to_string(t) + "," + std::to_string(std::cos(3.0 * t)) + "," + std::to_string(-3.0 * std::sin(3.0 * t)) + "\n";
  }
  const fs::path data = folder.write("swing.csv", text), out = folder.path() / "study";
  const Outcome outcome = run({"init", data.string(), "--out", out.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("column 'omega' names no unit: taken as rad/s"));
  EXPECT_EQ(first_line(out / "swing.csv"), "t[s],theta[rad],omega[rad/s]");
}

/// An axis under a controller, which sees the axis through noise: its current is predicted by the position as well as the other way round.
std::string axis() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::string text = "t_s,current_A,pos_mm\n";
  double x = 0.0, v = 0.0, wanted = 0.0;
  for (int k = 0; k < 800; ++k) {
    if (k % 100 == 0) wanted = 20.0 * normal(random);
    const double seen = x + 0.02 * normal(random), current = 0.05 * (wanted - seen) - 0.004 * v;
    text += std::to_string(0.01 * k) + "," + std::to_string(current) + "," + std::to_string(seen) + "\n";
    v += 0.01 * (900.0 * current - 2.0 * v);
    x += 0.01 * v;
  }
  return text;
}

TEST(Init, TheOnlyCurrentBesideAPositionDrivesIt) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("axis.csv", axis());
  const Outcome outcome = run({"init", data.string(), "--out", (folder.path() / "s").string(), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found.at("columns").at(1).at("use"), "input") << found.at("columns").at(1).at("why");
  EXPECT_EQ(found.at("columns").at(2).at("use"), "output");
}

/// Day and night move the room by little beside what a heater does to the tank in it.
std::string tank() {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> level(0, 3);
  std::string rows = "time[min],heater[W],room[degC],water[degC]\n";
  double water = 24.0, power = 0.0;
  for (int i = 0; i < 2400; ++i) {
    if (i % 80 == 0) power = 100.0 * level(random);
    const double room = 21.0 + 1.5 * std::sin(2.0 * std::numbers::pi * i / 1440.0);
    char row[96];
    std::snprintf(row, sizeof row, "%d,%.0f,%.1f,%.2f\n", i, power, room + 0.05 * normal(random), water + 0.05 * normal(random));
    rows += row;
    for (int k = 0; k < 60; ++k) water += (power - 9.0 * (water - room)) / 250e3;
  }
  return rows;
}

TEST(Init, ATemperatureThatNothingHelpsToPredictIsThatOfTheSurroundings) {
  const TemporaryFolder folder;
  folder.write("tank.csv", tank());
  const Outcome outcome = run({"init", (folder.path() / "tank.csv").string(), "--out", (folder.path() / "tank").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"input room", "output water", "nothing else in the file helps to predict it"});
}

/// Counted from 0 K, where no room was, the level without input would be uncertain by a hundred kelvin; the tank has none: it takes the
/// room's temperature.
TEST(Init, CountsLevelsFromTheZeroOfWhatWasRecorded) {
  const TemporaryFolder folder;
  folder.write("tank.csv", tank());
  const std::string out = (folder.path() / "tank").string();
  ASSERT_EQ(run({"init", (folder.path() / "tank.csv").string(), "--out", out}).status, 0);
  const std::string model = content(fs::path(out) / "model.toml");
  EXPECT_THAT(model, HasSubstr("zero_degC = { unit = \"K\", value = 273.15"));
  EXPECT_THAT(model,
              HasSubstr("(zero_degC + water_rest + water_gain_heater*heater + water_gain_room*(room - zero_degC) - water)/water_tau"));
  const Outcome fitted = run({"fit", out});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const json parameters = json::parse(content(fs::path(out) / "out" / "fit" / "filter_error" / "fit.json")).at("parameters");
  const double rest = parameters.at("water_rest").at("value"), sigma = parameters.at("water_rest").at("sigma");
  EXPECT_LT(sigma, 3.0) << "of a room between 19 and 23 degC";
  EXPECT_NEAR(rest, 0.0, 3.0 * sigma);
  EXPECT_NEAR(parameters.at("water_gain_heater").at("value"), 1.0 / 9.0, 0.002) << "K/W";
}

/// A recording of others (configs/two_heaters): the heater's warmth comes late, so that a few seconds ahead the past slope says it all,
/// whatever the columns are called.
TEST(Init, ATemperatureThatAHeaterMovesLateIsAnOutput) {
  const std::string recorded = content(paths::source() / "configs" / "two_heaters" / "two_heaters.csv");
  for (const bool rename : {false, true}) {
    const TemporaryFolder folder;
    std::string renamed = recorded;
    if (rename) renamed.replace(0, renamed.find('\n'), "t[s],heater_1[%],heater_2[%],front[degC],back[degC]");
    const fs::path data = folder.write("heaters.csv", renamed);
    const Outcome outcome = run({"init", data.string(), "--out", (folder.path() / "heaters").string(), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json columns = json::parse(outcome.out).at("columns");
    for (std::size_t i : {1U, 2U}) EXPECT_EQ(columns.at(i).at("use"), "input") << columns.at(i);
    for (std::size_t i : {3U, 4U}) EXPECT_EQ(columns.at(i).at("use"), "output") << columns.at(i);
  }
}

/// What init writes is a study that fits as it stands, and its model follows the swing better than a constant.
TEST(Init, WritesAStudyThatFits) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("swing.csv", swing()), out = folder.path() / "study";
  ASSERT_EQ(run({"init", data.string(), "--out", out.string()}).status, 0);
  const Outcome fitted = run({"fit", (out / "study.toml").string()});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const json fit = json::parse(content(out / "out" / "fit" / "filter_error" / "fit.json"));
  EXPECT_NE(fit.at("status"), "failed");
  EXPECT_LT(fit.at("rms").at("angle").at("value").get<double>(), 2.0) << "deg; the swing is some 10 deg";
}

TEST(Init, NeverWritesOverAStudyUnlessForced) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("swing.csv", swing()), out = folder.path() / "study";
  fs::create_directory(out);
  folder.write("study/study.toml", "mine");
  const Outcome refused = run({"init", data.string(), "--out", out.string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(content(out / "study.toml"), "mine");
  EXPECT_EQ(run({"init", data.string(), "--out", out.string(), "--force"}).status, 0);
  EXPECT_THAT(content(out / "study.toml"), HasSubstr("[study]"));
}

TEST(Init, PrintsWhatItFoundAsJson) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("swing.csv", swing());
  const Outcome outcome = run({"init", data.string(), "--out", (folder.path() / "s").string(), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found.at("rows"), 600);
  EXPECT_EQ(found.at("columns").at(1).at("use"), "input");
  EXPECT_EQ(found.at("columns").at(2).at("use"), "output");
}

TEST(Init, RefusesInWordsWhatIsNoRecording) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const char* word) {
    const fs::path data = folder.write("x.csv", text);
    const Outcome outcome = run({"init", data.string(), "--out", (folder.path() / "none").string()});
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr(word));
    EXPECT_FALSE(fs::exists(folder.path() / "none")) << "nothing is written";
  };
  refused("", "empty");
  refused("y\n1\n", "one column");
  refused("a,b\n1,2\n3,1\n2,2\n", "no column of time");
  refused("t_s,y\n0,1\n1,two\n2,3\n", "'two' is not a number");
  const Outcome missing = run({"init", (folder.path() / "nowhere.csv").string()});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("no such file"));
}

}  // namespace
