#include "misfit/data/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(Reference, FoldsSignedAnglesByOddnessAndKeepsBothBranches) {
  const TemporaryFolder folder;
  const auto path = folder.write("static.csv", "alpha[deg],C_m[-],sigma[-]\n-10,-0.011,0.001\n0,0,0.001\n10,0.010,0.001\n14,-0.01,0.001\n");
  const Reference reference = read_reference(path, "C_m");
  EXPECT_EQ(reference.name, "static");
  EXPECT_EQ(reference.of, "alpha_T");
  EXPECT_EQ(reference.of_unit, "rad");
  ASSERT_EQ(reference.x.size(), 4U);
  EXPECT_NEAR(reference.x[1], 10.0 * degree, 1e-15);
  EXPECT_DOUBLE_EQ(reference.value[1], 0.011);
  EXPECT_DOUBLE_EQ(reference.value[2], 0.010);
  ASSERT_EQ(reference.notes.size(), 1U);
  expect_parts(reference.notes[0], {"1 points", "alpha", "odd"});
}

TEST(Reference, ADampingCurveIsEven) {
  const TemporaryFolder folder;
  const auto path = folder.write("damping.csv", "alpha[deg],C_m_alphadot[-]\n-10,0.2\n10,0.3\n");
  const Reference reference = read_reference(path, "C_m_alphadot");
  EXPECT_EQ(reference.value, (std::vector<double>{0.2, 0.3}));
  EXPECT_FALSE(reference.trim.has_value());
}

TEST(Reference, TrimOfExactPointsOnAParabolaIsExact) {
  // value = (12 − a)(a + 3) / 1000: zero at 12, slope −0.015 there
  std::vector<double> x;
  std::vector<double> value;
  for (double a = 3.0; a <= 18.0; a += 1.0) {
    x.push_back(a);
    value.push_back((12.0 - a) * (a + 3.0) / 1000.0);
  }
  const auto trim = stable_zero(x, value, std::vector<double>(x.size(), 0.001), "deg");
  ASSERT_TRUE(trim.has_value());
  EXPECT_NEAR(trim->value, 12.0, 1e-9);
  EXPECT_EQ(trim->unit, "deg");
}

TEST(Reference, SigmaOfTheTrimIsTheScatterOverManyDraws) {
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
    const auto trim = stable_zero(x, value, std::vector<double>(x.size(), 0.001), "deg");
    ASSERT_TRUE(trim.has_value());
    sum += trim->value;
    squares += trim->value * trim->value;
    stated += trim->sigma / draws;
  }
  const double mean = sum / draws;
  const double scatter = std::sqrt(squares / draws - mean * mean);
  EXPECT_NEAR(mean, 12.4, 4.0 * scatter / std::sqrt(draws));
  EXPECT_GT(stated, 0.95 * scatter);  // draws whose chi² is high by chance are widened: at most a quarter too large
  EXPECT_LT(stated, 1.25 * scatter);
}

TEST(Reference, BranchesThatDisagreeWidenTheTrim) {
  std::vector<double> x;
  std::vector<double> agree;
  std::vector<double> differ;
  for (double a = 9.0; a <= 16.0; a += 1.0) {
    x.insert(x.end(), {a, a});
    agree.insert(agree.end(), {(12.4 - a) * 0.006, (12.4 - a) * 0.006});
    differ.insert(differ.end(), {(12.0 - a) * 0.006, (12.8 - a) * 0.006});
  }
  const std::vector<double> sigma(x.size(), 0.0005);
  const auto narrow = stable_zero(x, agree, sigma, "deg");
  const auto wide = stable_zero(x, differ, sigma, "deg");
  ASSERT_TRUE(narrow && wide);
  EXPECT_NEAR(wide->value, narrow->value, 1e-6);
  EXPECT_GT(wide->sigma, 3.0 * narrow->sigma);
}

TEST(Reference, AnUnstableCrossingIsNoTrim) {
  EXPECT_FALSE(stable_zero({1.0, 2.0, 3.0, 4.0}, {-2.0, -1.0, 1.0, 2.0}, {0.1, 0.1, 0.1, 0.1}, "deg").has_value());
  EXPECT_FALSE(stable_zero({1.0, 2.0}, {1.0, 2.0}, {0.1, 0.1}, "deg").has_value());
}

TEST(Reference, TheStaticTestOfTheCanopyTrimsNearThirteenDegrees) {
  // The four means about the crossing: 0.0128 at 10.5, 0.0046 at 12, −0.0030 at 13.5, −0.0151 at 15 deg: zero at 12.9 by straight
  // interpolation.
  const Reference reference = read_reference(MISFIT_SOURCE_DIR "/tests/data/files/static_test.csv", "C_m");
  ASSERT_TRUE(reference.trim.has_value());
  EXPECT_EQ(reference.x.size(), 25U);
  EXPECT_NEAR(reference.trim->value, 12.9 * degree, 0.15 * degree);
  EXPECT_GT(reference.trim->sigma, 0.03 * degree);
  EXPECT_LT(reference.trim->sigma, 0.2 * degree);
}

TEST(Reference, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto wrong = folder.write("wrong.csv", "alpha[deg],C_n[-]\n1,2\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(wrong, "C_m")); }), {"wrong.csv", "C_m", "C_n"});
  const auto sigma = folder.write("sigma.csv", "alpha[deg],C_m[-],sigma[-]\n1,2,0.1\n2,1,0\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(sigma, "C_m")); }), {"sigma.csv:3", "sigma", "positive"});
  const auto empty = folder.write("empty.csv", "alpha[deg],C_m[-]\n1,\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(empty, "C_m")); }), {"empty.csv", "no row"});
}

}  // namespace
}  // namespace misfit
