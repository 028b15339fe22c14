#include "misfit/inference/curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_planar;

TEST(ChooseKnots, ValuesThatAreNotKnownAreNoneOfTheVisited) {
  std::vector<double> visited, with_gaps;
  for (int i = 0; i < 2000; ++i) {
    const double value = std::sin(0.1 * i);
    visited.push_back(value);
    with_gaps.push_back(value);
    if (i % 3 == 0) with_gaps.push_back(std::nan(""));
  }
  EXPECT_EQ(choose_knots(with_gaps, 8, "C"), choose_knots(visited, 8, "C"));
}

}  // namespace
}  // namespace misfit
