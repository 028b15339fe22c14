// A lid: what is above the edge is gone within a sampling interval, so that how fast is in no recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/discover/found.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string kettle_text = R"toml(
[states]
above_room = { unit = "K", scale = 30.0, initial = { kind = "free", value = 0.0 } }
[inputs]
power = { unit = "W", hold = "zero_order" }
[parameters]
gain = { unit = "K/W", value = 0.1, free = true }
tau = { unit = "s", value = 500.0, free = true }
[equations]
above_room = "(gain*power - above_room)/tau"
[outputs]
above_room = { unit = "K", noise = 0.2 }
)toml";

/// Water that boils 80 K above the room: exactly, from sample to sample.
Signals kettle_that_boils() {
  constexpr double step = 5.0, gain = 1.0 / 6.0, tau = 700.0, boils = 80.0;
  constexpr std::array<double, 5> powers = {0.0, 0.0, 500.0, 1000.0, 2000.0};
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "kettle";
  s.measured = {{"above_room", "K", {}, 0.0}};
  s.inputs = {{"power", "W", {}, 0.0}};
  double level = 0.0, power = 0.0;
  for (int n = 0; n < 600; ++n) {
    if (n % 30 == 0) power = n % 60 == 0 ? 2000.0 : powers[random() % powers.size()];
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(power);
    s.measured[0].values.push_back(level + 0.15 * normal(random));
    level = std::min(boils, gain * power + (level - gain * power) * std::exp(-step / tau));
  }
  return s;
}

TEST(ALid, IsAnOverflowOfWhichTheEdgeIsKnownAndNotHowFast) {
  const Found world(kettle_that_boils(), kettle_text);
  const Discovery found = world.discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& best = found.candidates.front();
  ASSERT_EQ(best.effect, "overflow") << found.verdict;
  EXPECT_TRUE(best.accepted) << best.why;
  EXPECT_THAT(best.fixed, testing::ElementsAre("spill"));
  EXPECT_EQ(best.parameters.at("spill").sigma, 0.0);
  EXPECT_GT(best.parameters.at("spill").value, 3.0 / 5.0) << "over within an interval of 5 s";
  EXPECT_GT(found.force.at("dabove_room/dt").sigma, 0.0) << "of the model without a lid, whose random force is known";
  const Estimate& edge = best.parameters.at("threshold");
  EXPECT_GT(edge.sigma, 0.0);
  EXPECT_LT(edge.sigma, 0.05);
  EXPECT_NEAR(edge.value, 80.0, 4.0 * edge.sigma);
}

}  // namespace
}  // namespace misfit
