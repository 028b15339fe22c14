// What recurs every day is looked for by the hour, in recordings that last for days.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing::Contains;
using testing::HasSubstr;
using testing_text_study::TextStudy;

constexpr const char* house = R"toml([system]
doc = "a house with a heater"
[states]
T = { unit = "K", scale = 3.0, initial = "free" }
[inputs]
out = { unit = "K", hold = "zero_order" }
P = { unit = "W", hold = "zero_order" }
[parameters]
loss = { unit = "1/s", value = 1e-5, free = true, bounds = [0.0, 1e-3] }
gain = { unit = "K/s/W", value = 1e-7, free = true, bounds = [0.0, 1e-5] }
[equations]
T = "loss*(out - T) + gain*P"
[outputs]
T = { unit = "K", noise = 0.05 }
)toml";

/// A sample every ten minutes, minutes of Euler between; the window stands open from seven to half past eight, or not.
std::string recording(int days, bool window) {
  std::string text = "t[s],out[K],P[W],T[K]\n";
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::uniform_real_distribution<double> power(0.0, 3000.0);
  constexpr double pi = std::numbers::pi, day = 86400.0;
  double T = 292.0, P = 0.0;
  for (int i = 0; i < 144 * days; ++i) {
    const double out = std::round(10.0 * (276.0 + 4.0 * std::sin(2.0 * pi * (600.0 * i / day - 0.4)))) / 10.0;
    if (i % 7 == 0) P = std::round(power(random));
    char row[80];
    std::snprintf(row, sizeof row, "%d,%.1f,%.0f,%.2f\n", 600 * i, out, P, T + noise(random));
    text += row;
    for (int minute = 0; minute < 10; ++minute) {
      const double hour = std::fmod(600.0 * i + 60.0 * minute, day) / 3600.0;
      const double open = window && hour >= 7.0 && hour < 8.5 ? 3e-5 : 0.0;
      T += 60.0 * ((1.25e-5 + open) * (out - T) + 1.5e-7 * P);
    }
  }
  return text;
}

TEST(TimeOfDay, ShowsTheWindowThatIsOpenEveryMorning) {
  TextStudy study(house, recording(8, true));
  Identification identification = study.identification("filter_error", "");
  const auto diagnosis = diagnose_stage(identification.session());
  ASSERT_TRUE(diagnosis);
  ASSERT_FALSE(diagnosis->sentences.empty());
  EXPECT_THAT(diagnosis->sentences.front(), testing::HasSubstr("too high where time of day is between"));
  const auto& map = diagnosis->maps.front();
  EXPECT_EQ(map.quantity, "time of day");
  EXPECT_EQ(map.quantity_unit, "h");
  const auto lowest = std::min_element(map.amplitude.begin(), map.amplitude.end()) - map.amplitude.begin();
  EXPECT_NEAR(map.x[static_cast<std::size_t>(lowest)], 7.75, 1.5);
  EXPECT_THAT(diagnosis->missing.front().quantities, testing::Contains("time of day"));
  const Discovery found = identification.discover();
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "time of day");
}

/// As `misfit help system` writes what recurs every day.
std::string window(const std::string& held) {
  return "window = { port = \"dT/dt\", formula = \"g*if(cos(2*pi*(t - noon)/day) > edge, out - T, 0*T)\", parameters = { "
         "g = { unit = \"1/s\", value = 1e-6, free = true }, noon = { unit = \"s\", value = 27900.0" +
         held + " }, day = { unit = \"s\", value = 86400.0" + held + " }, edge = { unit = \"-\", value = 0.98" + held + " } } }\n";
}

TEST(TimeOfDay, TheFormulaOfTheHelpFindsHowWideTheWindowStands) {
  TextStudy study(house, recording(8, true));
  const Fit fit = study.fit("filter_error", window(", free = false"));
  ASSERT_TRUE(fit.usable()) << fit.message;
  const Estimate g = fit.parameters.at("g");
  EXPECT_NEAR(g.value, 3e-5, 0.03 * 3e-5) << "noon is 7:45, and edge that of 1.53 h, which is 2 % too long";
  EXPECT_LT(g.sigma, 3e-7);
}

TEST(TimeOfDay, WhatJumpsHasNoDerivativeByItsHoursAndTheFilterSaysSo) {
  TextStudy study(house, recording(8, true));
  const Fit fit = study.fit("filter_error", window(""));
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("nothing in these data depends on noon, day and edge; fix them")));
}

TEST(TimeOfDay, IsNothingWhereNothingRecursAndIsNotLookedAtInADayOrTwo) {
  TextStudy null(house, recording(8, false));
  Identification identification = null.identification("filter_error", "");
  const auto diagnosis = diagnose_stage(identification.session());
  ASSERT_TRUE(diagnosis);
  EXPECT_TRUE(diagnosis->maps.front().sentence.empty()) << diagnosis->maps.front().sentence;
  EXPECT_EQ(identification.discover().outcome, SearchOutcome::none_missing);
  TextStudy brief(house, recording(2, true));
  Identification of_two_days = brief.identification("filter_error", "");
  const auto of_two = diagnose_stage(of_two_days.session());
  ASSERT_TRUE(of_two);
  for (const auto& map : of_two->maps) EXPECT_NE(map.quantity, "time of day");
}

}  // namespace
