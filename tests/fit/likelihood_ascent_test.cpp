// Steps where derivatives do not lead, as at a kink of the objective; a noise that is none.
#include "misfit/fit/filter/likelihood_ascent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "misfit/fit/trajectory_start.h"
#include "tests/fit/decay.h"

namespace misfit {
namespace {

TEST(AxisStep, RisesTowardsAMaximumAndNotFromIt) {
  const auto known = testing_decay::registry_with(testing_decay::decay_text);
  const Model model = assemble(testing_decay::request_of("text"), *known);
  const std::vector<Signals> experiments{testing_decay::decay(200, 5)};
  LikelihoodAscent ascent(trajectory_start(model, experiments).from.model, {}, experiments, {});
  ASSERT_TRUE(ascent.linearise());
  ascent.iterate(25, 1e-6);
  const Eigen::VectorXd maximum = ascent.joint(), slope = Eigen::VectorXd::Zero(maximum.size() - 1);
  Eigen::VectorXd variances = Eigen::VectorXd::Constant(maximum.size(), 1e-12);  // the noise stays
  variances[0] = ascent.out.covariance(0, 0);
  const Eigen::MatrixXd covariance = variances.asDiagonal();
  EXPECT_FALSE(ascent.axis_step(covariance, slope));
  EXPECT_EQ(ascent.joint(), maximum);
  const double highest = ascent.objective;
  ASSERT_TRUE(ascent.move_to(maximum.head(1).array() + 2.0 * std::sqrt(variances[0]), ascent.out.noise_fit.logs));
  const double before = ascent.objective;
  const std::optional<double> gained = ascent.axis_step(covariance, slope);
  ASSERT_TRUE(gained);
  EXPECT_NEAR(ascent.objective - before, *gained, 1e-9);
  EXPECT_NEAR(*gained, 1.5, 0.2);  // from two sigmas to one: (4 - 1)/2 of a parabola
  EXPECT_LT(ascent.objective, highest);
}

TEST(TryNoise, ANoiseWithoutADensityIsNotTaken) {
  const auto known = testing_decay::registry_with(testing_decay::decay_text);
  const Model model = assemble(testing_decay::request_of("text"), *known);
  const std::vector<Signals> experiments{testing_decay::decay(200, 5)};
  LikelihoodAscent ascent(trajectory_start(model, experiments).from.model, {}, experiments, {});
  ASSERT_TRUE(ascent.linearise());
  const double before = ascent.objective, white = ascent.out.noise.channels.front().white;
  NoiseFit failed;
  failed.minus_log_density = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ascent.try_noise(failed));
  ASSERT_EQ(ascent.out.noise.channels.size(), 1U);
  EXPECT_EQ(ascent.out.noise.channels.front().white, white);
  EXPECT_EQ(ascent.objective, before);
  EXPECT_EQ(ascent.joint().size(), static_cast<Eigen::Index>(1 + ascent.out.noise_fit.logs.size())) << "steps over both blocks may follow";
  EXPECT_EQ(ascent.out.noise_fit.at_bound.size(), ascent.out.noise_fit.logs.size()) << "and ask which are at a bound";
}

/// Its bounds and information are those of a noise that the search is not at.
TEST(TryNoise, OfANoiseThatIsNotTakenNothingStays) {
  const auto known = testing_decay::registry_with(testing_decay::decay_text);
  const Model model = assemble(testing_decay::request_of("text"), *known);
  const std::vector<Signals> experiments{testing_decay::decay(200, 5)};
  LikelihoodAscent ascent(trajectory_start(model, experiments).from.model, {}, experiments, {});
  ASSERT_TRUE(ascent.linearise());
  NoiseFit worse = fit_noise(ascent.runs(), ascent.out.noise, {ascent.out.reference, 1});
  worse.noise.channels.front().white *= 10.0;
  worse.at_bound.flip();
  ASSERT_FALSE(ascent.try_noise(worse));
  EXPECT_NE(ascent.out.noise_fit.at_bound, worse.at_bound) << "and none was taken before";
  EXPECT_EQ(ascent.out.noise_fit.at_bound.size(), ascent.out.noise_fit.logs.size());

  ascent.iterate(5, 1e-3);
  const NoiseFit before = ascent.out.noise_fit;
  worse.information *= 2.0;
  ASSERT_FALSE(ascent.try_noise(worse));
  EXPECT_EQ(ascent.out.noise_fit.at_bound, before.at_bound);
  EXPECT_EQ(ascent.out.noise_fit.information, before.information);
  EXPECT_EQ(ascent.out.noise_fit.noise.channels.front().white, before.noise.channels.front().white);
}

}  // namespace
}  // namespace misfit
