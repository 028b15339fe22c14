#include "misfit/recording/recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "misfit/core/error.h"
#include "misfit/recording/column_facts.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;

RecordingSurvey survey(const std::string& content) {
  const TemporaryFolder folder;
  return survey_recording(folder.write("x.csv", content));
}

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.csv", content);
  return message_of<InputError>([&] { static_cast<void>(survey_recording(file)); });
}

std::string rows(const std::string& header, int count, const std::function<std::string(int)>& row) {
  std::string out = header + "\n";
  for (int k = 0; k < count; ++k) out += row(k) + "\n";
  return out;
}

const ColumnSurvey& column(const RecordingSurvey& s, const std::string& name) {
  for (const auto& c : s.columns) {
    if (c.name == name) return c;
  }
  throw std::logic_error("no column " + name);
}

TEST(Recording, TimeInputAndOutputAreFoundWithTheirReasons) {
  const RecordingSurvey s = survey(
      rows("k,t_ms,valve,level_cm", 200, [](int k) { return fmt::format("{},{},{},{}", k, 250 * k, k / 20 % 2, std::sin(0.1 * k)); }));
  EXPECT_EQ(column(s, "t").use, ColumnUse::time);
  EXPECT_DOUBLE_EQ(s.step, 0.25);
  EXPECT_EQ(column(s, "valve").use, ColumnUse::input);
  EXPECT_EQ(column(s, "level").use, ColumnUse::output);
  EXPECT_EQ(column(s, "level").unit, "cm");
  ASSERT_EQ(s.parts.size(), 1U);
  EXPECT_DOUBLE_EQ(s.parts[0].columns[0].values.back(), 0.25 * 199);
  EXPECT_EQ(s.parts[0].find("level")->unit, "cm");
}

TEST(Recording, WhatStandsStillBetweenJumpsIsAnInputWhateverItIsCalled) {
  const RecordingSurvey s =
      survey(rows("time[s],a,b", 200, [](int k) { return fmt::format("{},{},{}", 0.1 * k, (k / 20 * 7) % 5, std::cos(0.3 * k)); }));
  EXPECT_EQ(column(s, "a").use, ColumnUse::input);
  EXPECT_THAT(column(s, "a").why, HasSubstr("constant between jumps"));
  EXPECT_EQ(column(s, "b").use, ColumnUse::output);
}

/// More than half of the samples of all three equal the one before.
TEST(Recording, AMeasurementThatStandsBetweenStepsOfItsLastDigitIsAnOutput) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const RecordingSurvey s = survey(rows("time[s],T_boiler,T_room,on,p", 600, [&](int k) {
    const double boiler = 20.0 + 10.0 * (1.0 - std::exp(-k / 200.0)), room = 20.0 + 0.3 * std::sin(0.01 * k) + 0.03 * normal(random);
    return fmt::format("{},{:.1f},{:.1f},{},{}", k, boiler, room, k / 50 % 2, 5 * (k / 30));  // p: a staircase, 0 % to 95 %
  }));
  EXPECT_GT(column(s, "T_boiler").repeat_share, 0.5);
  EXPECT_EQ(column(s, "T_boiler").use, ColumnUse::output);
  EXPECT_GT(column(s, "T_room").repeat_share, 0.5);
  EXPECT_EQ(column(s, "T_room").use, ColumnUse::output);
  EXPECT_EQ(column(s, "on").use, ColumnUse::input);
  EXPECT_EQ(column(s, "p").use, ColumnUse::input);
}

TEST(Recording, WhereAllColumnsLookLikeInputsTheOutputIsOneThatIsNotCalledSo) {
  const RecordingSurvey s = survey(rows("t_s,level,heater", 200, [](int k) { return fmt::format("{},{},{}", k, k / 40 % 3, k / 20 % 2); }));
  EXPECT_EQ(column(s, "level").use, ColumnUse::output);
  EXPECT_EQ(column(s, "heater").use, ColumnUse::input);
}

/// "force" may be what drives or what is measured; a stimulation that somebody sets drives.
TEST(Recording, AColumnThatIsSetDrivesOneThatVariesAlsoWhereThatIsCalledLikeAnInput) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> level(0.0, 1.0);
  double stim = 0.0;
  const RecordingSurvey s = survey(rows("t_s,stim,force[N]", 400, [&](int k) {
    if (k % 40 == 0) stim = level(random);
    return fmt::format("{},{:.4f},{}", 0.05 * k, stim, 100.0 * stim + 0.3 * std::sin(7.0 * k));
  }));
  EXPECT_EQ(column(s, "stim").use, ColumnUse::input);
  EXPECT_EQ(column(s, "force").use, ColumnUse::output);
  EXPECT_THAT(column(s, "force").why, HasSubstr("called like an input, but it varies"));
}

TEST(Recording, AMeasuredRateIsKnownByItsValues) {
  const RecordingSurvey s = survey(rows("t_s,theta_rad,omega_degps", 300, [](int k) {
    const double t = 0.01 * k;
    return fmt::format("{},{},{}", t, std::sin(3.0 * t), 3.0 * std::cos(3.0 * t) * 180.0 / 3.14159265358979);
  }));
  EXPECT_EQ(column(s, "omega").use, ColumnUse::rate);
  EXPECT_EQ(column(s, "omega").rate_of, "theta");
}

/// At 250 Hz the difference of neighbouring samples is noise.
TEST(Recording, AMeasuredRateIsKnownThroughTheNoiseOfQuickSampling) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const RecordingSurvey s = survey(rows("t_s,phi_rad,p_radps", 3000, [&](int k) {
    const double t = 0.004 * k;
    return fmt::format("{},{},{}", t, std::sin(2.0 * t) + 0.002 * normal(random), 2.0 * std::cos(2.0 * t) + 0.02 * normal(random));
  }));
  EXPECT_EQ(column(s, "p").use, ColumnUse::rate);
}

TEST(Recording, CommandsBehindAnotherWordAreInputsAndSmoothOnesAreSaidToBe) {
  const RecordingSurvey s = survey(rows("t_us,roll_cmd,rudder_deg,T_in[degC]", 300, [](int k) {
    return fmt::format("{},{},{},{}", 4000 * k, std::sin(0.8 * k * k), std::sin(0.05 * k), 20.0 + std::cos(0.03 * k));
  }));
  EXPECT_NEAR(s.step, 0.004, 1e-9) << "microseconds";
  EXPECT_EQ(column(s, "roll_cmd").use, ColumnUse::input);
  EXPECT_FALSE(column(s, "roll_cmd").is_measured_input);
  EXPECT_EQ(column(s, "rudder").use, ColumnUse::input);
  EXPECT_TRUE(column(s, "rudder").is_measured_input);
  EXPECT_EQ(column(s, "T_in").unit, "degC");
}

TEST(Jumps, AreStepsWhateverAWaveBesideThemDoes) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> steps, wave, noise, both, commands;
  for (int k = 0; k < 1000; ++k) {
    steps.push_back(k / 50 % 2);
    wave.push_back(std::sin(0.02 * k));
    noise.push_back(normal(random));
    both.push_back(steps.back() + 0.1 * wave.back());
    commands.push_back(std::sin(0.8 * k * k));
  }
  EXPECT_TRUE(jumps(steps));
  EXPECT_TRUE(jumps(both));
  EXPECT_FALSE(jumps(wave));
  EXPECT_FALSE(jumps(noise));
  EXPECT_FALSE(jumps(commands)) << "each sample another one";
  EXPECT_FALSE(jumps(std::vector<double>(100, 1.0)));
  EXPECT_FALSE(jumps({}));
}

TEST(Recording, ColumnsAreWhatTheUserChooses) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.csv", rows("t_s,u_V,a,b_m,c", 300, [](int k) {
                                   return fmt::format("{},{},{},{},{}", 0.1 * k, std::sin(0.1 * k), std::cos(0.2 * k), std::sin(0.3 * k),
                                                      std::cos(0.7 * k));
                                 }));
  const RecordingSurvey s = survey_recording(file, {}, {.inputs = {"a"}, .outputs = {"b"}});
  EXPECT_EQ(column(s, "a").use, ColumnUse::input);
  EXPECT_EQ(column(s, "a").why, "named by --input");
  EXPECT_EQ(column(s, "b").use, ColumnUse::output);
  EXPECT_NE(column(s, "u").use, ColumnUse::input) << "others are none";
  EXPECT_NE(column(s, "c").use, ColumnUse::output);
  const RecordingSurvey outputs = survey_recording(file, {}, {.outputs = {"b_m"}});
  EXPECT_EQ(column(outputs, "b").use, ColumnUse::output);
  EXPECT_EQ(column(outputs, "u").use, ColumnUse::input) << "by its name";
  EXPECT_NE(column(outputs, "a").use, ColumnUse::output);
  expect_parts(message_of<InputError>([&] { static_cast<void>(survey_recording(file, {}, {.inputs = {"bb"}})); }),
               {"--input", "'bb'", "did you mean 'b'"});
  expect_parts(message_of<InputError>([&] { static_cast<void>(survey_recording(file, {}, {.outputs = {"t"}})); }),
               {"--output", "'t_s'", "increases"});
  expect_parts(message_of<InputError>([&] {
                 static_cast<void>(survey_recording(file, {}, {.inputs = {"a"}, .outputs = {"b_m", "a"}}));
               }),
               {"column 'a'", "--input and by --output"});
}

TEST(Recording, TheWeatherIsNoOutputOfTheHeatingAndHeadersAreTakenAsTheyStand) {
  const std::string house = rows("Zeit;Außentemperatur (°C);heating power [kW];T_in (C)", 300, [](int k) {
    return fmt::format("{:02}.03.2024 {:02}:{:02};{},5;{};{},{}", 1 + k / 144, k / 6 % 24, k % 6 * 10, k % 17, k / 30 % 2, 20 + k % 3,
                       k % 10);
  });
  const RecordingSurvey s = survey(house);
  EXPECT_EQ(column(s, "Aussentemperatur").use, ColumnUse::input);
  EXPECT_EQ(column(s, "heating_power").use, ColumnUse::input);
  EXPECT_EQ(column(s, "T_in").use, ColumnUse::output);
  EXPECT_EQ(column(s, "T_in").unit, "degC");
  EXPECT_DOUBLE_EQ(s.step, 600.0);
  const TemporaryFolder folder;
  const RecordingSurvey chosen =
      survey_recording(folder.write("x.csv", house), {}, {.inputs = {"heating power", "Außentemperatur"}, .outputs = {"T_in"}});
  EXPECT_EQ(column(chosen, "heating_power").use, ColumnUse::input);
  for (const char* name : {"outdoor_temperature", "T_out", "ambient_K", "solar_gain"}) {
    const RecordingSurvey named = survey(rows(fmt::format("t[s],{},T_room", name), 200,
                                              [](int k) { return fmt::format("{},{},{}", k, std::sin(0.1 * k), std::cos(0.07 * k)); }));
    EXPECT_EQ(named.columns[1].use, ColumnUse::input) << name;
  }
}

/// Of an unknown unit one thing is said: what its numbers are taken as.
TEST(Recording, AnUnknownUnitIsSaidOnceWithWhatItIsTakenAs) {
  const RecordingSurvey s = survey(rows("t[s],theta[rad],omega[foo],level[blob]", 300, [](int k) {
    const double t = 0.01 * k;
    return fmt::format("{},{},{},{}", t, std::sin(3.0 * t), 3.0 * std::cos(3.0 * t), std::cos(7.0 * t));
  }));
  EXPECT_EQ(column(s, "omega").unit, "rad/s");
  EXPECT_THAT(s.remarks, testing::UnorderedElementsAre(
                             HasSubstr("no column is an input"), "column 'omega[foo]': the unit 'foo' is not known: taken as rad/s",
                             "column 'level[blob]': unknown unit 'blob' — did you mean 'lb'? Now its numbers are taken as they are"));
}

TEST(Recording, UnitsThatMayBeSomethingElseAreSaid) {
  const RecordingSurvey s = survey(rows("t_s,p_s,acc_x[g],T (in),theta_rad", 100, [](int k) {
    return fmt::format("{},{},{},{},{}", 0.1 * k, std::sin(0.1 * k), std::sin(0.7 * k), std::cos(0.4 * k), std::cos(1.3 * k));
  }));
  EXPECT_THAT(s.remarks, testing::UnorderedElementsAre(
                             HasSubstr("no column is an input"), "column 'acc_x[g]': g is read as gram, not as 9.81 m/s^2",
                             "column 'T (in)': (in) is read as inch", HasSubstr("units read from the last letter of names: 'p_s' in s;")));
}

RecordingSurvey survey_with(const std::string& content, const RecordingChoice& choice) {
  const TemporaryFolder folder;
  return survey_recording(folder.write("x.csv", content), {}, choice);
}

TEST(Recording, AnUnknownUnitOfTimeStopsAndKnownOnesAreConverted) {
  const auto with = [](const std::string& time) {
    return rows(time + ",y", 50, [](int k) { return fmt::format("{},{}", 2000 * k, std::sin(0.1 * k)); });
  };
  EXPECT_THAT(refusal(with("t[ticks]")), HasSubstr("'ticks' is no known unit of time; known are s, ms, us, ns, min, h and d, and dates"));
  EXPECT_DOUBLE_EQ(survey(with("time[us]")).step, 2e-3);
  EXPECT_DOUBLE_EQ(survey(with("timestamp_ns")).step, 2e-6);
}

TEST(Recording, ATemperatureWithoutAUnitIsNoTimeWhereThereIsOne) {
  for (const char* name : {"T", "T1", "T_2"}) {
    const RecordingSurvey dated = survey(rows(fmt::format("{},DateTime,q", name), 50, [](int k) {
      return fmt::format("{},2026-01-02 03:04:{:02},{}", 20.0 + 0.1 * k, k, std::sin(0.3 * k));
    }));
    EXPECT_EQ(dated.columns[0].use, ColumnUse::output) << name;
    EXPECT_EQ(dated.columns[1].use, ColumnUse::time);
    const RecordingSurvey elapsed = survey(rows(fmt::format("{},Elapsed Time (s),q", name), 50, [](int k) {
      return fmt::format("{},{},{}", 20.0 + 0.1 * k + (k % 3 == 0 ? 0.3 : 0.0), 0.5 * k, std::sin(0.3 * k));
    }));
    EXPECT_EQ(elapsed.columns[1].use, ColumnUse::time) << name;
    EXPECT_DOUBLE_EQ(elapsed.step, 0.5);
  }
  const RecordingSurvey alone = survey(rows("T,y_s", 50, [](int k) { return fmt::format("{},{}", 0.1 * k, std::sin(0.3 * k)); }));
  EXPECT_EQ(alone.columns[0].use, ColumnUse::time);
}

TEST(Recording, DatesAreATimeInSeconds) {
  const RecordingSurvey s =
      survey(rows("when,T [\xC2\xB0"
                  "C]",
                  30, [](int k) { return fmt::format("2026-01-02T03:04:{:02}.5Z,{}", k, 20.0 + std::sin(0.3 * k)); }));
  EXPECT_DOUBLE_EQ(s.step, 1.0);
  EXPECT_EQ(s.parts[0].columns[0].values.front(), 0.0);
  EXPECT_EQ(column(s, "T").unit, "degC");
  EXPECT_THAT(s.remarks, Contains(HasSubstr("column 'when' holds dates: read as seconds since 2026-01-02T03:04:00.5Z")));
}

/// Then t modulo 24 h is what the clock shows.
TEST(Recording, DatesOverDaysCountFromMidnight) {
  const RecordingSurvey s = survey(rows(
      "when,T[K]", 90, [](int k) { return fmt::format("2026-01-{:02} {:02}:30+02:00,{}", 2 + k / 24, k % 24, 20.0 + std::sin(0.3 * k)); }));
  EXPECT_EQ(s.parts[0].columns[0].values.front(), 1800.0);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("read as seconds since the midnight before 2026-01-02 00:30+02:00")));
}

TEST(Recording, AnIdSplitsAndIsNoInputAlsoWhereRowsAlternate) {
  const auto row = [](int k) {
    const int step = k / 2;
    return fmt::format("{},{},{}", 0.1 * step, k % 2 + 1, std::sin(0.1 * k));
  };
  const RecordingSurvey s = survey(rows("t_s,id,y", 60, row));
  EXPECT_EQ(column(s, "id").use, ColumnUse::segment);
  ASSERT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(s.parts[0].rows(), 30U);
  EXPECT_EQ(s.parts[1].rows(), 30U);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("column 'id' numbers 2 recordings, 1 to 2: an experiment each")));
  const RecordingSurvey counted =
      survey(rows("t_s,id,y", 60, [](int k) { return fmt::format("{},{},{}", 0.1 * k, k, std::sin(0.1 * k)); }));
  EXPECT_EQ(column(counted, "id").use, ColumnUse::unused);
  EXPECT_EQ(counted.parts.size(), 1U);
}

TEST(Recording, AnOnOffSignalCalledRunIsNoNumberOfARecording) {
  const RecordingSurvey s =
      survey(rows("t_s,run,y", 120, [](int k) { return fmt::format("{},{},{}", 0.1 * k, k / 20 % 2, std::sin(0.1 * k)); }));
  EXPECT_EQ(column(s, "run").use, ColumnUse::input);
  EXPECT_EQ(s.parts.size(), 1U);
}

TEST(Recording, WhatIsChosenIsTakenAndSaid) {
  const std::string content = rows("t_s,clock_ms,a,b,c", 100, [](int k) {
    return fmt::format("{},{},{},{},{}", 0.1 * k, 50 * k, std::sin(0.3 * k), std::cos(0.2 * k), k / 10 % 2);
  });
  const RecordingSurvey s = survey_with(content, {{"a"}, {"b"}, "clock_ms", {}, {}});
  EXPECT_DOUBLE_EQ(s.step, 0.05);
  EXPECT_EQ(column(s, "a").why, "named by --input");
  EXPECT_EQ(column(s, "b").use, ColumnUse::output);
  EXPECT_EQ(column(s, "c").use, ColumnUse::unused);
  EXPECT_EQ(s.parts[0].columns.size(), 3U);
  const RecordingSurvey by_output = survey_with(content, {{}, {"b"}, "", {}, {}});
  EXPECT_EQ(column(by_output, "c").use, ColumnUse::input);
  EXPECT_EQ(column(by_output, "a").use, ColumnUse::unused);
  EXPECT_THAT(message_of<InputError>([&] {
                static_cast<void>(survey_with(content, {{"aa"}, {}, "", {}, {}}));
              }),
              HasSubstr("no column 'aa' — did you mean 'a'"));
}

TEST(Recording, ATimeThatIsChosenIsTakenWhateverTheFirstColumnIsCalled) {
  const std::string content =
      rows("t[s],clock_ms,y", 50, [](int k) { return fmt::format("{},{},{}", 0.1 * k, 50 * k, std::sin(0.3 * k)); });
  EXPECT_NEAR(survey_with(content, {{}, {}, "clock_ms", {}, {}}).step, 0.05, 1e-9);
}

TEST(Recording, NamesMayBeGivenWhereTheFileHasNone) {
  const std::string content = rows("", 50, [](int k) { return fmt::format("{},{}", 0.1 * k, std::sin(0.3 * k)); });
  const RecordingSurvey s = survey_with(content, {{}, {}, "", {"t[s]", "w[rpm]"}, {}});
  EXPECT_EQ(column(s, "w").unit, "rpm");
}

TEST(Recording, OfALogIsReadLikeATable) {
  const RecordingSurvey s = survey_recording(paths::source() / "tests/data/logs/records.npy", {}, {{"on"}, {"w"}, "", {}, {}});
  EXPECT_EQ(s.format, "NPY (NumPy)");
  EXPECT_EQ(s.rows, 40U);
  EXPECT_EQ(column(s, "w").unit, "rad/s");
}

TEST(Recording, GapsRepeatedTimesMissingValuesAndConstantsAreSaid) {
  const RecordingSurvey s = survey(rows("t_s,y,c,segment", 100, [](int k) {
    const double t = k == 31 ? 3.0 : k >= 60 ? 0.1 * k + 5.0 : 0.1 * k;
    return fmt::format("{},{},2.5,{}", t, k == 10 || k == 11 ? std::string("nan") : fmt::format("{}", std::sin(t)), k / 50);
  }));
  EXPECT_EQ(column(s, "y").missing, 2U);
  EXPECT_EQ(column(s, "c").use, ColumnUse::constant);
  EXPECT_EQ(column(s, "segment").use, ColumnUse::segment);
  ASSERT_EQ(s.gaps.size(), 2U) << "the row left out, and the pause";
  EXPECT_NEAR(s.gaps.back().to - s.gaps.back().from, 5.1, 1e-9);
  ASSERT_EQ(s.parts.size(), 2U) << "an experiment per number of the segment";
  EXPECT_EQ(s.parts[0].rows(), 49U);
  EXPECT_EQ(s.parts[1].rows(), 50U);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("repeat")));
  EXPECT_THAT(s.remarks, Contains(HasSubstr("2 of 100 values are missing")));
  EXPECT_THAT(s.remarks, Contains(HasSubstr("gaps in time")));
}

TEST(Recording, StepsOfAnUnevenClockAreNoGaps) {
  const RecordingSurvey s = survey(rows("t_s,y", 100, [](int k) {
    const int longer = k / 4;  // of the steps until then, by 2 ms
    return fmt::format("{},{}", 3.5e-3 * k + 2e-3 * longer, std::sin(0.1 * k));
  }));
  EXPECT_TRUE(s.gaps.empty());
  EXPECT_THAT(s.remarks, Contains(HasSubstr("uneven steps of time: usually 0.0035 s, at most 0.0055 s")));
}

TEST(Recording, AColumnWithoutAValueIsSaid) {
  const RecordingSurvey s = survey(rows("t_s,torque,y", 100, [](int k) { return fmt::format("{},NaN,{}", 0.1 * k, std::sin(0.1 * k)); }));
  EXPECT_EQ(column(s, "torque").use, ColumnUse::constant);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("column 'torque' has no value at all")));
}

TEST(Recording, TimeThatRunsBackwardBeginsAnotherExperiment) {
  const RecordingSurvey s = survey(rows("t_s,y", 100, [](int k) { return fmt::format("{},{}", 0.1 * (k % 60), std::sin(0.3 * k)); }));
  ASSERT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(s.parts[0].rows(), 60U);
  EXPECT_EQ(s.parts[1].rows(), 40U);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("backward")));
}

TEST(Recording, OneTimeThatIsWrongLeavesItsRowOutAndDoesNotSplitTheRecording) {
  for (const double wrong : {0.0, 2.5, 900.0}) {
    const RecordingSurvey s =
        survey(rows("t_s,y", 100, [wrong](int k) { return fmt::format("{},{}", k == 50 ? wrong : 0.1 * k, std::sin(0.3 * k)); }));
    ASSERT_EQ(s.parts.size(), 1U) << wrong;
    EXPECT_EQ(s.parts[0].rows(), 99U) << wrong;
    EXPECT_THAT(s.remarks, Contains(HasSubstr("1 row whose time is not between"))) << wrong;
  }
}

TEST(Recording, TimesOfWhichMostAreThatOfTheRowBeforeAreNoTime) {
  try {
    survey(rows("t_s,y", 100, [](int k) { return fmt::format("{},{}", k / 10, std::sin(0.3 * k)); }));
    FAIL() << "whole seconds of a recording at 10 Hz";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("90 of 100 rows have the time of the row before"));
    EXPECT_THAT(error.what(), HasSubstr("--time NAME"));
  }
}

/// An NPY file of records of t and y.
std::string npy(const std::vector<std::array<double, 2>>& records) {
  std::string head = fmt::format("{{'descr': [('t', '<f8'), ('y', '<f8')], 'fortran_order': False, 'shape': ({},), }}", records.size());
  head.resize(118, ' ');
  std::string out = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + head;
  for (const auto& record : records) out.append(reinterpret_cast<const char*>(record.data()), sizeof record);
  return out;
}

TEST(Recording, TimeThatRunsBackwardBeginsAnotherExperimentInALogAsWell) {
  std::vector<std::array<double, 2>> records;
  for (int k = 0; k < 90; ++k) records.push_back({0.1 * (k % 30), std::sin(0.3 * k)});
  const TemporaryFolder folder;
  const RecordingSurvey s = survey_recording(folder.write("runs.npy", npy(records)));
  ASSERT_EQ(s.parts.size(), 3U);
  EXPECT_EQ(s.parts[2].rows(), 30U);
  EXPECT_THAT(s.remarks, Contains(HasSubstr("time runs backward 2 times: 3 recordings in one file")));
}

TEST(Recording, TheStepOfADigitisedColumnIsFound) {
  const RecordingSurvey s = survey(rows("t_s,y_V,z_V", 400, [](int k) {
    return fmt::format("{},{},{:.9f}", 0.1 * k, 0.005 * std::round(std::sin(0.05 * k) / 0.005), std::sin(0.05 * k));
  }));
  EXPECT_NEAR(column(s, "y").resolution, 0.005, 1e-9);
  EXPECT_NE(column(s, "z").resolution, 0.005);
}

TEST(Recording, ColumnsNumberedAlikeAreOfOneKind) {
  EXPECT_TRUE(are_numbered_alike("temperature_1", "Temperature_2"));
  EXPECT_TRUE(are_numbered_alike("T9", "T12"));
  EXPECT_FALSE(are_numbered_alike("T1", "T1"));
  EXPECT_FALSE(are_numbered_alike("T_in", "T_out"));
  EXPECT_FALSE(are_numbered_alike("plate", "plate2")) << "one without a number may be the whole";
  EXPECT_FALSE(are_numbered_alike("heater_1", "temperature_1"));
}

TEST(Recording, AMeasurementThatStandsAtItsLimitIsSaid) {
  const RecordingSurvey s =
      survey(rows("t_s,u,y", 300, [](int k) { return fmt::format("{},{},{}", k, std::cos(0.07 * k), std::min(0.8, std::sin(0.05 * k))); }));
  EXPECT_THAT(s.remarks, Contains(HasSubstr("'y' stays at its highest value, 0.8")));
  EXPECT_EQ(s.remarks.size(), 1U);
}

TEST(Recording, SaysWhatIsWrong) {
  const auto numbers = [](int k) { return fmt::format("{},{}", 0.1 * k, std::sin(0.1 * k)); };
  EXPECT_THAT(refusal(rows("a,b", 50, numbers)), HasSubstr("no column of time"));
  EXPECT_THAT(refusal(rows("n,y", 50, [](int k) { return fmt::format("{},{}", k, std::sin(0.1 * k)); })), HasSubstr("'n' counts rows"));
  EXPECT_THAT(refusal(rows("t_s,y", 50, [&](int k) { return k == 7 ? std::string("0.7,broken") : numbers(k); })),
              testing::AllOf(HasSubstr("x.csv:9"), HasSubstr("'broken' is not a number")));
  EXPECT_THAT(refusal(rows("t_s,y", 50, [](int k) { return fmt::format("{},7", 0.1 * k); })), HasSubstr("nothing was measured"));
  EXPECT_THAT(refusal(rows("t_s,y", 5, numbers)), HasSubstr("too few"));
}

}  // namespace
}  // namespace misfit
