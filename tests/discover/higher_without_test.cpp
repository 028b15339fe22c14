// A fit that has ended below the maximum of its model, as the refit of an effect shows that explains nothing itself.
#include <gtest/gtest.h>

#include "misfit/discover/refit.h"
#include "tests/discover/found.h"
#include "tests/discover/slide.h"

namespace misfit {
namespace {

using namespace testing_models;

/// The slide as it is, fitted; and an estimate with another stiffness, as one that a search could not leave would be.
struct TwoEstimates {
  Found found{slide({}, [](double) { return 0.0; }), slide_text};
  FilterEstimate lower = found.estimate;
  Refit refit;  ///< whose effect has no strength

  TwoEstimates() {
    refit.ok = true;
    refit.estimate = found.estimate;
    for (Parameter& p : lower.model.parameters) {
      if (p.name == "k") p.value *= 1.5;
    }
    RefitWork at_lower = work(lower);
    at_lower.threads = 1;
    lower.objective = run_once(at_lower, lower.model).value().objective;
  }

  [[nodiscard]] RefitWork work(const FilterEstimate& without) const {
    return {.without = without, .experiments = found.signals, .registry = *found.systems, .threads = 1};
  }
};

TEST(AModelFittedBelowItsMaximum, IsFittedAgainFromWhereARefitHasEnded) {
  const TwoEstimates two;
  ASSERT_LT(two.lower.objective, two.found.estimate.objective - 20.0);
  const auto higher = higher_without(two.work(two.lower), {{&two.refit, two.refit.drop}});
  ASSERT_TRUE(higher);
  EXPECT_NEAR(higher->objective, two.found.estimate.objective, 0.5);
}

/// Where the refit has led, the effect itself explains something, which is lost at first.
TEST(AModelFittedBelowItsMaximum, IsFittedAgainFromWhereADropIsMoreThanPredicted) {
  TwoEstimates two;
  for (Parameter& p : two.refit.estimate.model.parameters) {
    if (p.name == "k") p.value *= 1.50005;
  }
  two.refit.drop = 50.0;
  EXPECT_FALSE(higher_without(two.work(two.lower), {{&two.refit, 49.0}})) << "as predicted";
  const auto higher = higher_without(two.work(two.lower), {{&two.refit, 35.0}});
  ASSERT_TRUE(higher);
  EXPECT_NEAR(higher->objective, two.found.estimate.objective, 0.5);
  two.refit.drop = 500.0;
  EXPECT_FALSE(higher_without(two.work(two.lower), {{&two.refit, 35.0}})) << "of a large drop that is little";
}

TEST(AModelFittedAtItsMaximum, IsNoHigherFromWhereARefitHasEnded) {
  const TwoEstimates two;
  EXPECT_FALSE(higher_without(two.work(two.found.estimate), {{&two.refit, two.refit.drop}}));
}

TEST(AModelFittedAtItsMaximum, IsLowerWithoutAnEffectThatExplainsSomething) {
  TwoEstimates two;
  for (Parameter& p : two.refit.estimate.model.parameters) {
    if (p.name == "k") p.value *= 1.2;
  }
  EXPECT_FALSE(higher_without(two.work(two.found.estimate), {{&two.refit, two.refit.drop}}));
}

}  // namespace
}  // namespace misfit
