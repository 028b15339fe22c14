#include "misfit/diagnose/pulses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace misfit {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t samples = 1500;
constexpr double step = 15.0;

/// A force that is an autoregression of unit variance with this memory, seen with a sigma of 0.3; an input that changes every 40 samples.
MissingForce noise(unsigned seed, double memory) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  MissingForce out;
  out.experiment = "fridge";
  out.ports = {"dT/dt"};
  out.port_units = {"K/s"};
  out.force.resize(1);
  out.sigma = {std::vector<double>(samples, 0.3)};
  out.quantities = {"T", "door_given"};
  out.quantity_units = {"K", "-"};
  out.values.resize(2);
  double f = normal(random);
  for (std::size_t k = 0; k < samples; ++k) {
    f = memory * f + std::sqrt(1.0 - memory * memory) * normal(random);
    out.t.push_back(step * static_cast<double>(k));
    out.force[0].push_back(f);
    out.values[0].push_back(5.0);
    out.values[1].push_back(k / 40 % 2 == 0 ? 0.0 : 1.0);
  }
  return out;
}

MissingForce with_pulses(std::size_t count, std::size_t apart, double size) {
  MissingForce out = noise(1, 0.0);
  for (std::size_t pulse = 1; pulse <= count; ++pulse) {
    for (std::size_t k = 0; k < 10; ++k) out.force[0][pulse * apart + k] += size;
  }
  return out;
}

TEST(Pulses, OfAForceThatIsThereForShortStretchesOnlyAreCountedWithTheirTimes) {
  const std::vector<ForcePulses> found = pulses_of({with_pulses(4, 311, 20.0)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().port, "dT/dt");
  EXPECT_THAT(found.front().begin, ElementsAre(311 * step, 622 * step, 933 * step, 1244 * step));
  EXPECT_THAT(found.front().end, ElementsAre(321 * step, 632 * step, 943 * step, 1254 * step));
  for (const double peak : found.front().peak) EXPECT_NEAR(peak, 20.0, 4.0);
  EXPECT_THAT(found.front().sentence,
              AllOf(HasSubstr("what is missing on dT/dt comes in 4 pulses of 2.5 min, all upward, of up to 2"),
                    HasSubstr("at t = 4665 s, 9330 s, 13995 s, 18660 s: something acts then that no column shows")));
}

TEST(Pulses, ThatBeginWhereAnInputChangesAreSaidToDoSo) {
  EXPECT_THAT(pulses_of({with_pulses(4, 320, 20.0)}).front().sentence, HasSubstr(": most of them begin where door changes"));
}

TEST(Pulses, AreNotSeenInNoiseWhiteOrSlow) {
  for (const double memory : {0.0, 0.5, 0.9, 0.99}) {
    for (unsigned seed = 0; seed < 50; ++seed) EXPECT_THAT(pulses_of({noise(seed, memory)}), IsEmpty()) << memory << ", seed " << seed;
  }
}

TEST(Pulses, TwoAreNone) { EXPECT_THAT(pulses_of({with_pulses(2, 311, 20.0)}), IsEmpty()); }

TEST(Pulses, AForceThatIsThereForAThirdOfTheTimeIsNone) {
  MissingForce out = noise(2, 0.0);
  for (std::size_t k = 0; k < samples; ++k) out.force[0][k] += k / 50 % 3 == 0 ? 20.0 : 0.0;
  EXPECT_THAT(pulses_of({out}), IsEmpty());
}

/// What is next to nothing elsewhere because the recording says nothing of it is no pulse where it does.
TEST(Pulses, AreNotWhereTheForceIsSeen) {
  MissingForce out = noise(3, 0.0);
  for (std::size_t k = 0; k < samples; ++k) {
    if (k % 300 < 20) continue;
    out.force[0][k] *= 0.01;
    out.sigma[0][k] = std::sqrt(0.3 * 0.3 + 1.0 - 0.01 * 0.01);
  }
  EXPECT_THAT(pulses_of({out}), IsEmpty());
}

/// A random force that is next to nothing is not known any better than before the recording: what is left is rounding.
TEST(Pulses, AreNotLookedForWhereTheForceIsNotKnown) {
  MissingForce out = with_pulses(4, 311, 20.0);
  for (double& f : out.force[0]) f *= 1e-4;
  out.sigma[0].assign(samples, 1.0);
  EXPECT_THAT(pulses_of({out}), IsEmpty());
}

}  // namespace
}  // namespace misfit
