// What acts at one place of the way only: a slide that a magnet beside it catches, over a hundredth of its way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tests/discover/found.h"
#include "tests/discover/slide.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double magnet_at = 0.06, magnet_width = 0.012;  // [m]

/// [m/s^2] Towards the magnet, `size` at most.
double pull(double x, double size) {
  const double at = (x - magnet_at) / magnet_width;
  return -size * at * std::exp(0.5 - 0.5 * at * at);
}

Signals beside_a_magnet(double size, unsigned seed) {
  return slide({.samples = 1800, .force = 8.0, .seed = seed}, [size](double x) { return pull(x, size); });
}

TEST(AForceAtOnePlaceOfTheWay, IsFoundAsACurveOfIt) {
  const Discovery found = Found(beside_a_magnet(2.0, 5), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "x");
  EXPECT_EQ(found.unexplained_port, "dv/dt");
}

/// Eight hats over the whole way see something of it too, but hardly tell a force from an error of the potentiometer.
TEST(AForceAtOnePlaceOfTheWay, IsAForceAlsoWhereWideCurvesShowIt) {
  const Discovery found = Found(beside_a_magnet(5.0, 5), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "x");
  EXPECT_EQ(found.unexplained_port, "dv/dt");
}

/// A ripple along the way, and dry friction, explain a part of it, on what is held out too.
TEST(AForceAtOnePlaceOfTheWay, IsNoEffectThatExplainsLessThanHalfOfIt) {
  const Discovery found = Found(beside_a_magnet(8.0, 5), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "x");
  EXPECT_EQ(found.unexplained_port, "dv/dt");
}

TEST(AForceAtOnePlaceOfTheWay, HasKnotsAsCloseAsItIsNarrowAndOthersAllAlongTheWay) {
  const Discovery found = Found(beside_a_magnet(2.0, 5), slide_text).discover_missing({.only = "unknown_force"});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.roles, (std::map<std::string, std::string>{{"of", "x"}, {"port", "dv/dt"}}));
  ASSERT_GT(first.knots.size(), 8U);
  EXPECT_TRUE(std::is_sorted(first.knots.begin(), first.knots.end()));
  const auto near =
      std::count_if(first.knots.begin(), first.knots.end(), [](double knot) { return std::abs(knot - magnet_at) < 2.0 * magnet_width; });
  EXPECT_GE(near, 3) << "a pull to and fro";
  EXPECT_LT(first.knots.front(), -0.1);
  EXPECT_GT(first.knots.back(), 0.1);
}

TEST(AForceAtOnePlaceOfTheWay, IsNotFoundWhereThereIsNone) {
  const Discovery found = Found(beside_a_magnet(0.0, 6), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << found.verdict;
}

}  // namespace
}  // namespace misfit
