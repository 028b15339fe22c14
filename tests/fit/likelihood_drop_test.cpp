// A model that takes an output as it is, compared with one that reads it in whole steps.
#include "misfit/fit/filter/likelihood_drop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace misfit {
namespace {

/// Two outputs of three samples, each with S = 0.04: of the first 0.5, 0 and 2 from the prediction, of the second 0.5 throughout.
struct ThreeSamples {
  FilterData data;
  FilterTrace trace;

  ThreeSamples() {
    trace.e = {0.5, 0.5, 0.0, 0.5, 2.0, 0.5};
    trace.S.assign(6, 0.04);
    data.use.assign(6, SampleRole::counted);
    data.use[4] = SampleRole::validation;
  }
};

/// At 0.5 from a prediction of sigma 0.2 the cell of one step ends at the prediction: p = Φ(5) − Φ(0); at 0 it is Φ(2.5) − Φ(−2.5) =
/// 0.98758067 (tables). What is held out and the other output do not count.
TEST(ChangeInCells, IsTheProbabilityOfTheCellInsteadOfADensity) {
  const ThreeSamples run;
  const double normalising = 0.5 * std::log(2.0 * std::numbers::pi * 0.04);
  const double beside = (normalising + 0.5 * 0.25 / 0.04) + std::log(0.5 - 2.8665157e-7), at_it = normalising + std::log(0.98758067);
  EXPECT_NEAR(beside, 1.7413530, 1e-6) << "a density would count 0.5 for far too much";
  EXPECT_NEAR(change_in_cells(run.data, run.trace, {1.0, 0.0}), beside + at_it, 1e-7);
}

/// log [Φ((d + q/2)/√S) − Φ((d − q/2)/√S)] for q = 2: of a step of two units the density of one unit is half.
TEST(ChangeInCells, IsPerUnitOfTheOutput) {
  ThreeSamples run;
  for (std::size_t at : {0UL, 1UL, 3UL, 5UL}) run.data.use[at] = SampleRole::none;
  const double sure = std::log(1.0 - 2.0 * 2.8665157e-7);  // within five sigmas
  EXPECT_NEAR(change_in_cells(run.data, run.trace, {2.0, 0.0}), 0.5 * std::log(2.0 * std::numbers::pi * 0.04) + sure - std::log(2.0), 1e-7);
}

TEST(ChangeInCells, IsNoneWithoutSteps) {
  const ThreeSamples run;
  EXPECT_EQ(change_in_cells(run.data, run.trace, {}), 0.0);
  EXPECT_EQ(change_in_cells(run.data, run.trace, {0.0, 0.0}), 0.0);
}

/// Of a step much finer than the prediction is known the probability is the density.
TEST(ChangeInCells, VanishesWithTheStep) {
  const ThreeSamples run;
  EXPECT_NEAR(change_in_cells(run.data, run.trace, {0.002, 0.0}), 0.0, 1e-3);
}

}  // namespace
}  // namespace misfit
