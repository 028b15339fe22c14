#include "misfit/math/stable_zero.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace misfit {
namespace {

TEST(StableZero, OfExactPointsOnAParabolaIsExact) {
  // value = (12 − a)(a + 3) / 1000: zero at 12, slope −0.015 there
  std::vector<double> x;
  std::vector<double> value;
  for (double a = 3.0; a <= 18.0; a += 1.0) {
    x.push_back(a);
    value.push_back((12.0 - a) * (a + 3.0) / 1000.0);
  }
  const auto zero = stable_zero({x, value, std::vector<double>(x.size(), 0.001)});
  ASSERT_TRUE(zero.has_value());
  EXPECT_NEAR(zero->x, 12.0, 1e-9);
}

TEST(StableZero, ItsSigmaIsTheScatterOverManyDraws) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0.0, 0.001);
  double sum = 0.0;
  double squares = 0.0;
  double stated = 0.0;
  constexpr int draws = 2000;
  for (int k = 0; k < draws; ++k) {
    std::vector<double> x;
    std::vector<double> value;
    for (double a = 6.0; a <= 18.0; a += 1.5) {
      x.insert(x.end(), {a, a});
      for (int branch = 0; branch < 2; ++branch) value.push_back((12.4 - a) * 0.006 + noise(generator));
    }
    const auto zero = stable_zero({x, value, std::vector<double>(x.size(), 0.001)});
    ASSERT_TRUE(zero.has_value());
    sum += zero->x;
    squares += zero->x * zero->x;
    stated += zero->sigma / draws;
  }
  const double mean = sum / draws;
  const double scatter = std::sqrt(squares / draws - mean * mean);
  EXPECT_NEAR(mean, 12.4, 4.0 * scatter / std::sqrt(draws));
  EXPECT_GT(stated, 0.95 * scatter);  // draws whose chi² is high by chance are widened: at most a quarter too large
  EXPECT_LT(stated, 1.25 * scatter);
}

TEST(StableZero, BranchesThatDisagreeWidenIt) {
  std::vector<double> x;
  std::vector<double> agree;
  std::vector<double> differ;
  for (double a = 9.0; a <= 16.0; a += 1.0) {
    x.insert(x.end(), {a, a});
    agree.insert(agree.end(), {(12.4 - a) * 0.006, (12.4 - a) * 0.006});
    differ.insert(differ.end(), {(12.0 - a) * 0.006, (12.8 - a) * 0.006});
  }
  const std::vector<double> sigma(x.size(), 0.0005);
  const auto narrow = stable_zero({x, agree, sigma});
  const auto wide = stable_zero({x, differ, sigma});
  ASSERT_TRUE(narrow && wide);
  EXPECT_NEAR(wide->x, narrow->x, 1e-6);
  EXPECT_GT(wide->sigma, 3.0 * narrow->sigma);
}

TEST(StableZero, AnUnstableCrossingIsNone) {
  EXPECT_FALSE(stable_zero({{1.0, 2.0, 3.0, 4.0}, {-2.0, -1.0, 1.0, 2.0}, {0.1, 0.1, 0.1, 0.1}}).has_value());
  EXPECT_FALSE(stable_zero({{1.0, 2.0}, {1.0, 2.0}, {0.1, 0.1}}).has_value());
}

}  // namespace
}  // namespace misfit
