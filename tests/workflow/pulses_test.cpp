// A fridge whose door nobody records: what is missing is there for a few minutes at a time.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing::HasSubstr;
using testing_text_study::TextStudy;

constexpr const char* fridge = R"toml([system]
doc = "a fridge with a compressor"
[states]
T = { unit = "K", scale = 2.0, initial = "free" }
[inputs]
P = { unit = "W", hold = "zero_order" }
room = { unit = "K" }
[parameters]
leak = { unit = "1/s", value = 1e-4, free = true, bounds = [0.0, 1e-2] }
cold = { unit = "K/s/W", value = 5e-5, free = true, bounds = [0.0, 1e-2] }
[equations]
T = "leak*(room - T) - cold*P"
[outputs]
T = { unit = "K", noise = 0.04 }
)toml";

constexpr std::array doors = {1500, 6900, 9300, 15600, 21000, 25500, 28800};  // [s]

/// A sample every 15 s, steps of a second between; a thermostat; the door stands open for two and a half minutes from each of the times.
std::string recording() {
  std::string text = "t[s],P[W],room[K],T[K]\n";
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.04);
  double T = 278.0, P = 0.0;
  for (int i = 0; i < 2160; ++i) {
    const int t = 15 * i;
    const double measured = T + noise(random), room = 295.0 + (i / 400 % 2 == 0 ? 0.5 : -0.5);
    if (measured > 279.1) P = 110.0;
    if (measured < 277.1) P = 0.0;
    char row[80];
    std::snprintf(row, sizeof row, "%d,%.0f,%.1f,%.3f\n", t, P, room, measured);
    text += row;
    for (int s = t; s < t + 15; ++s) {
      const bool open = std::any_of(doors.begin(), doors.end(), [&](int from) { return s >= from && s < from + 150; });
      T += (7.6e-5 + (open ? 5.6e-4 : 0.0)) * (room - T) - 4e-5 * P;
    }
  }
  return text;
}

TEST(ADoorThatNobodyRecords, IsPulsesOfAForceAndNoCurve) {
  TextStudy study(fridge, recording());
  Identification identification = study.identification("filter_error", "");
  const auto diagnosis = diagnose_stage(identification.session());
  ASSERT_TRUE(diagnosis);
  ASSERT_TRUE(diagnosis->pulses) << diagnosis->sentences.front();
  const ForcePulses& pulses = diagnosis->pulses->front();
  ASSERT_EQ(pulses.begin.size(), doors.size()) << pulses.sentence;
  for (std::size_t i = 0; i < doors.size(); ++i) {
    EXPECT_NEAR(pulses.begin[i], doors[i], 45.0);
    EXPECT_NEAR(pulses.end[i] - pulses.begin[i], 150.0, 75.0);
    EXPECT_NEAR(pulses.peak[i], 5.6e-4 * 17.0, 0.35 * 5.6e-4 * 17.0);
  }
  EXPECT_THAT(pulses.sentence, HasSubstr("all upward"));
  EXPECT_THAT(diagnosis->sentences.front(), HasSubstr("7 pulses"));
  EXPECT_TRUE(lacks_pulses_only(identification.session()));
}

}  // namespace
