// Outputs of which one has few measurements: what output error takes off its noise for the parameters, and what it says where nothing is
// left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/fit/first_order.h"

namespace misfit {
namespace {

using namespace testing_first_order;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Of z every `nth` sample.
Signals sparse(std::size_t nth) {
  Signals s = record("e", 1.0, 2, 0.5, 2);
  for (std::size_t i = 0; i < s.samples(); ++i) {
    if (i % nth != nth / 2) s.measured[1].values[i] = std::nan("");
  }
  return s;
}

TEST(NoiseOfAnOutputWithFewMeasurements, LosesItsShareOfTheParametersAndNoMore) {
  const Signals s = sparse(80);
  const Fit fit = fitted(two_outputs, {s}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  const double edf = std::stod(fit.facts.at("effective_parameters"));
  const double few = 5.0, all = few + static_cast<double>(s.samples());
  EXPECT_NEAR(fit.noise.at("z").value, fit.rms.at("z").value / std::sqrt(1.0 - edf / all), 1e-4 * noise);
  EXPECT_THAT(fit.warnings, Not(Contains(HasSubstr("noise of z"))));
}

TEST(NoiseOfAnOutputWithFewMeasurements, WhichCannotBeEstimatedIsSaid) {
  const Fit fit = fitted(two_outputs, {sparse(400)}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("the noise of z could not be estimated")));
}

}  // namespace
}  // namespace misfit
