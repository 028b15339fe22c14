#include <gtest/gtest.h>

#include <Eigen/Core>

#include "misfit/fit/filter/filter_noise_fit.h"
#include "misfit/fit/filter/noise_interval.h"
#include "misfit/math/decompositions.h"
#include "tests/fit/cart_filter.h"

namespace misfit {
namespace {

using namespace testing_cart;

/// The cart with nothing unknown but its noise, at given noise.
struct Known {
  Cart cart{1500};
  FilterEstimate estimate;

  Known() {
    for (Parameter& p : cart.model.model.parameters) p.free = false;
    estimate.model = cart.model.model;
    estimate.forced = cart.model;
    estimate.noise = estimate.reference = cart.noise;
    estimate.noise_fit.logs = pack(cart.noise, cart.model.model.system->spec(), cart.noise).value;
    estimate.noise_fit.at_bound.assign(estimate.noise_fit.logs.size(), false);
    estimate.data = {cart.data};
    estimate.traces = {cart.run()};
    estimate.joint_covariance = covariance(estimate.noise_fit.logs);
  }

  [[nodiscard]] Eigen::MatrixXd covariance(const std::vector<double>& logs) const {
    return inverse(noise_information({&estimate.forced, &estimate.data, &estimate.traces}, logs, estimate.reference, 1));
  }

  /// The path in many small steps.
  [[nodiscard]] double end(std::size_t j, double z) const {
    constexpr int steps = 40;
    std::vector<double> logs = estimate.noise_fit.logs;
    for (int k = 0; k < steps; ++k) {
      const Eigen::MatrixXd C = covariance(logs);
      const auto column = static_cast<Eigen::Index>(j);
      for (Eigen::Index i = 0; i < C.rows(); ++i)
        logs[static_cast<std::size_t>(i)] += z / steps * C(i, column) / std::sqrt(C(column, column));
    }
    return std::exp(logs[j]);
  }
};

TEST(NoiseIntervals, AreTheEndsOfThePathInManySteps) {
  const Known known;
  const auto found = noise_intervals(known.estimate, {0, 1}, 2);
  for (std::size_t j = 0; j < 2; ++j) {
    ASSERT_TRUE(found[j].has_value());
    const double value = std::exp(known.estimate.noise_fit.logs[j]);
    EXPECT_NEAR(std::log(found[j]->first / value), std::log(known.end(j, -1.96) / value), 0.03) << j;
    EXPECT_NEAR(std::log(found[j]->second / value), std::log(known.end(j, 1.96) / value), 0.03) << j;
  }
  const double sigma = std::sqrt(known.estimate.joint_covariance(1, 1));
  ASSERT_GT(sigma, 0.05) << "or there would be nothing to distinguish";
  const double down = -std::log(found[1]->first / known.cart.noise.force_time),
               up = std::log(found[1]->second / known.cart.noise.force_time);
  EXPECT_GT(up, 1.02 * down) << "a longer correlation time is less well known, even of its own size";
  EXPECT_EQ(found, noise_intervals(known.estimate, {0, 1}, 1));
}

TEST(NoiseIntervals, ScaleWithTheJointCovariance) {
  Known known;
  const auto before = noise_intervals(known.estimate, {0}, 1);
  known.estimate.joint_covariance *= 0.25;
  const auto after = noise_intervals(known.estimate, {0}, 1);
  ASSERT_TRUE(before[0] && after[0]);
  EXPECT_NEAR(std::log(after[0]->second / after[0]->first), 0.5 * std::log(before[0]->second / before[0]->first), 0.02);
}

TEST(NoiseIntervals, AreNotGivenForWhatIsNotKnown) {
  Known known;
  known.estimate.noise_fit.at_bound[1] = true;
  EXPECT_FALSE(noise_intervals(known.estimate, {0, 1}, 1)[1].has_value());
  known.estimate.joint_covariance *= 1e4;
  EXPECT_FALSE(noise_intervals(known.estimate, {0}, 1)[0].has_value());
  known.estimate.joint_covariance.resize(0, 0);
  EXPECT_FALSE(noise_intervals(known.estimate, {0}, 1)[0].has_value());
}

}  // namespace
}  // namespace misfit
