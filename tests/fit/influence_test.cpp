#include "misfit/fit/regression/influence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace misfit {
namespace {

/// A smooth command, what follows it, and one that nobody moves.
struct Records {
  std::vector<double> command, follower, other;
};

Records records() {
  Records out;
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  double u = 0.0, wanted = 0.0, y = 0.0, z = 0.0;
  for (int k = 0; k < 4000; ++k) {
    if (k % 50 == 0) wanted = normal(random);
    u += (wanted - u) / 12.0;
    y += (u - y) / 15.0;
    z += normal(random) - 0.05 * z;
    out.command.push_back(u + 0.01 * normal(random));
    out.follower.push_back(y + 0.01 * normal(random));
    out.other.push_back(z);
  }
  return out;
}

TEST(InfluenceOnAColumn, ThePastOfACommandHelpsToPredictWhatFollowsIt) {
  const Records r = records();
  EXPECT_TRUE(influence_on(r.follower, {r.command}).matters());
  EXPECT_FALSE(influence_on(r.command, {r.follower}).matters());
  EXPECT_FALSE(influence_on(r.other, {r.command, r.follower}).matters());
  EXPECT_FALSE(influence_on(r.follower, {r.other}).matters());
}

/// An input that changes within the time looked ahead says nothing of it beforehand.
TEST(InfluenceOnAColumn, AKnownInputCountsWithWhatItDoesMeanwhile) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> u, y;
  double level = 0.0;
  for (int k = 0; k < 3000; ++k) {
    u.push_back(normal(random));
    y.push_back(level);
    level += (u.back() - level) / 40.0;
  }
  EXPECT_TRUE(influence_on(y, {}, {u}).matters());
}

TEST(InfluenceOnAColumn, GapsAndShortRecordsSayNothingWrong) {
  Records r = records();
  for (std::size_t k = 700; k < 900; ++k) r.follower[k] = std::nan("");
  EXPECT_TRUE(influence_on(r.follower, {r.command}).matters());
  EXPECT_FALSE(influence_on({1.0, 2.0, 1.0}, {{1.0, 1.0, 2.0}}).matters());
  EXPECT_FALSE(influence_on(r.other, {}).matters());
}

TEST(InfluenceOnAColumn, ALargeLevelChangesNothing) {
  const Records r = records();
  Records high = r;
  for (auto* column : {&high.command, &high.follower}) {
    for (double& v : *column) v += 1e9;
  }
  const Influence low_level = influence_on(r.follower, {r.command}), high_level = influence_on(high.follower, {high.command});
  EXPECT_NEAR(high_level.own, low_level.own, 1e-3);
  EXPECT_NEAR(high_level.others, low_level.others, 1e-3);
}

TEST(InfluenceOnAColumn, AConstantColumnDoesNotCount) {
  const Records r = records();
  const std::vector<double> constant(r.command.size(), 0.1);
  EXPECT_EQ(influence_on(r.follower, {r.command, constant}, {constant}).others, influence_on(r.follower, {r.command}).others);
}

}  // namespace
}  // namespace misfit
