#include "misfit/fit/regression/linear_guess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace misfit {
namespace {

/// tau y' = gain u + rest − y under a held random input.
GuessData first_order(double step, double noise) {
  GuessData data;
  data.inputs.emplace_back();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr double tau = 5.0, gain = 2.0, rest = 1.0;
  double y = rest, u = 0.0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 40 == 0) u = normal(random);
    data.t.push_back(step * k);
    data.y.push_back(y + noise * normal(random));
    data.inputs[0].push_back(u);
    y += (gain * u + rest - y) * (1.0 - std::exp(-step / tau));
  }
  return data;
}

TEST(LinearGuess, FindsATimeConstant) {
  const LinearGuess guess = guess_linear(first_order(0.5, 0.01));
  EXPECT_EQ(guess.order, 1);
  EXPECT_NEAR(guess.tau, 5.0, 2.0);
  EXPECT_NEAR(guess.gain[0], 2.0, 0.3);
  EXPECT_NEAR(guess.rest, 1.0, 0.2);
}

TEST(LinearGuess, FindsAFreeSwingAboutItsRest) {
  for (const double step : {0.001, 0.05}) {
    GuessData data;
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (double t = 0.0; t < 40.0; t += step) {
      data.t.push_back(t);
      data.y.push_back(3.14 + 0.5 * std::exp(-0.05 * t) * std::cos(6.0 * t) + 1e-3 * normal(random));
    }
    const LinearGuess guess = guess_linear(data);
    EXPECT_EQ(guess.order, 2) << guess.why;
    EXPECT_NEAR(std::sqrt(guess.stiffness), 6.0, 0.2);
    EXPECT_NEAR(guess.rest, 3.14, 0.02);
    EXPECT_GT(guess.damping, 0.0);
    EXPECT_LT(guess.damping, 1.0);
  }
}

TEST(LinearGuess, GapsAndMissingValuesDoNotSpoilIt) {
  GuessData data = first_order(0.5, 0.01);
  for (std::size_t k = 300; k < 330; ++k) data.y[k] = std::nan("");
  for (std::size_t k = 1000; k < data.t.size(); ++k) data.t[k] += 500.0;
  const LinearGuess guess = guess_linear(data);
  EXPECT_NEAR(guess.tau, 5.0, 2.0);
}

TEST(LinearGuess, SaysWhereThereIsNone) {
  GuessData still;
  for (int k = 0; k < 100; ++k) {
    still.t.push_back(k);
    still.y.push_back(2.0);
  }
  const LinearGuess guess = guess_linear(still);
  EXPECT_EQ(guess.order, 1);
  EXPECT_EQ(guess.rest, 2.0);
  EXPECT_NE(guess.why.find("no linear model"), std::string::npos);
}

}  // namespace
}  // namespace misfit
