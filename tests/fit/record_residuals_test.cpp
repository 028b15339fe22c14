#include "misfit/inference/record_residuals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/fit/decay.h"

namespace misfit {
namespace {

using namespace testing_decay;

const ChannelPrediction of_y{"test", "y", "V", {}, {}, {}, {}, {}};

TEST(RecordResiduals, AreGivenInTheUnitAndInPerCentOfTheMotion) {
  RecordResiduals residuals;
  for (const double y : {1.0, 3.0, 1.0, 3.0}) residuals.add(y, y - 0.25, false);  // standard deviation 1 about 2
  residuals.add(std::nan(""), 0.0, false);
  residuals.add(5.0, 4.0, true);
  Fit fit;
  ChannelPrediction y = of_y;
  residuals.describe(y, fit);
  EXPECT_EQ(y.rms, 0.25);
  EXPECT_EQ(y.nrmse, 0.25);
  EXPECT_EQ(fit.facts.at("residuals of y in 'test'"), "RMS 0.25 V, 25 % of the motion; held out: RMS 1 V");
}

TEST(RecordResiduals, OfNothingThatCountsNothingIsSaid) {
  Fit fit;
  ChannelPrediction y = of_y;
  RecordResiduals().describe(y, fit);
  EXPECT_TRUE(fit.facts.empty());
  EXPECT_FALSE(y.rms || y.nrmse);
}

TEST(RecordResiduals, OfEveryExperimentAreAmongTheFactsOfAFit) {
  const auto known = registry_with(decay_text);
  const Model model = assemble(request_of("text"), *known);
  std::vector<Signals> experiments{decay(50, 1), decay(50, 2)};
  experiments[1].name = "again";
  const Fit fit = output_error(trajectory_start(model, experiments).from, experiments).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_EQ(fit.facts.count("residuals of y in 'decay'"), 1U);
  EXPECT_EQ(fit.facts.count("residuals of y in 'again'"), 1U);
}

}  // namespace
}  // namespace misfit
