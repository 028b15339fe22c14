// Statistics of motions that a fitted model makes, against the measured one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/swing.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing_text_study::TextStudy;

SimulatedMotion of_recording(const std::string& recording, const std::string& more_outputs = "") {
  TextStudy study(testing_swing::system() + more_outputs, recording);
  Identification identification = study.identification("filter_error", "");
  return compare_stage(identification.session(), identification.fit()).motion.value();
}

SimulatedMotion of_swing(unsigned seed, double reach) { return of_recording(testing_swing::recording(seed, reach)); }

/// The input repeats the motion, so that the bands are narrow, and the error of an initial state as measured lies outside of them.
TEST(MotionsOfARightModel, AreNotSaidToDiffer) {
  int significant = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const SimulatedMotion motion = of_swing(seed, 100.0);
    EXPECT_EQ(motion.failed, 0U);
    significant += motion.p_value <= 0.01 ? 1 : 0;
  }
  EXPECT_EQ(significant, 0) << "at 1 %, of 8; from initial states as measured 5 of 6 were";
}

TEST(MotionsOfAModelWithoutTheEndOfItsSensor, AreSaidToDiffer) {
  constexpr double reach = 0.3;  // [m], of a motion of 1 m
  int significant = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) significant += of_swing(seed, reach).p_value <= 0.01 ? 1 : 0;
  EXPECT_GE(significant, 3) << "of 4";
}

/// x of every second row, and 5 ms after each of them the speed until the next row: two sensors, each with a clock of its own.
std::string with_speed_between(const std::string& recording) {
  std::istringstream lines(recording);
  std::string line, next, out = "t[s],u[V],x[m],v[m/s]\n";
  std::getline(lines, line);
  for (int i = 0; i < 250 && std::getline(lines, line) && std::getline(lines, next); ++i) {
    double t = 0.0, u = 0.0, x = 0.0, later = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%*d,%lf", &t, &u, &x) != 3) break;
    if (std::sscanf(next.c_str(), "%*f,%*f,%*d,%lf", &later) != 1) break;
    char rows[120];
    std::snprintf(rows, sizeof rows, "%.3f,%.2f,%.5f,\n%.3f,%.2f,,%.4f\n", t, u, x, t + 0.005, u, (later - x) / 0.01);
    out += rows;
  }
  return out;
}

TEST(MotionsOfASensorWithItsOwnClock, HaveLagsOfThatClock) {
  const SimulatedMotion motion = of_recording(with_speed_between(testing_swing::recording(1)), "v = { unit = \"m/s\", noise = 0.6 }\n");
  ASSERT_FALSE(motion.series.empty());
  const auto& groups = motion.series.front().groups;
  const auto correlation = std::find_if(groups.begin(), groups.end(), [](const MotionGroup& g) { return g.name == "autocorrelation"; });
  ASSERT_NE(correlation, groups.end());
  for (const MotionNumber& n : correlation->numbers) {
    EXPECT_NEAR(n.at / 0.02, std::round(n.at / 0.02), 1e-6) << "x is read every 20 ms";
    EXPECT_TRUE(std::isfinite(n.measured)) << n.at;
  }
}

}  // namespace
