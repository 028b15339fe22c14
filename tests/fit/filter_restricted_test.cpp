#include <gtest/gtest.h>

#include "misfit/fit/filter/restricted_likelihood.h"
#include "misfit/math/decompositions.h"
#include "tests/fit/cart_filter.h"

namespace misfit {
namespace {

using namespace testing_cart;

/// The cart with an unknown offset of each measurement, and nothing else unknown: linear in both, whatever the noise.
struct Offsets {
  Cart cart{25, 5, {effect("bias", {{"output", "position_reading"}}), effect("bias", {{"output", "speed_reading"}}, "slip")}};
  std::vector<double> logs;

  Offsets() {
    for (Parameter& p : cart.model.model.parameters) p.free = p.name.find("offset") != std::string::npos;
    const SystemSpec& spec = cart.model.model.system->spec();
    logs = pack(cart.noise, spec, cart.noise).value;
  }

  [[nodiscard]] FilterEstimate estimate() const {
    FilterEstimate out;
    out.model = cart.model.model;
    out.forced = cart.model;
    out.noise = out.reference = cart.noise;
    out.noise_fit.logs = logs;
    out.noise_fit.at_bound.assign(logs.size(), false);
    out.data = {cart.data};
    return out;
  }

  /// XᵀV⁻¹X of generalised least squares with the whole covariance of the measurements, V, written down.
  Eigen::MatrixXd information(const std::vector<double>& there) {
    cart.noise = unpack(there, cart.model.model.system->spec());
    cart.model.model.parameters[static_cast<std::size_t>(cart.model.time_parameter)].value = cart.noise.force_time;
    const Dense dense(cart, cart.run());
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(dense.y.size(), 2);
    for (Eigen::Index row = 0; row < X.rows(); ++row) X(row, row % 2) = 1.0;
    return X.transpose() * symmetric_solve(dense.y_covariance, X);
  }
};

TEST(RestrictedLikelihood, IsThatOfTheWholeCovarianceOfTheReadings) {
  Offsets offsets;
  ASSERT_EQ(offsets.cart.model.model.free_parameters().size(), 2U);
  const RestrictedLikelihood found = restricted_likelihood(offsets.estimate(), Eigen::VectorXd::Zero(2), 2);
  const std::vector<double> logs = offsets.logs;
  const Eigen::MatrixXd inverse = misfit::inverse(offsets.information(logs));
  std::vector<Eigen::MatrixXd> share;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    constexpr double h = 1e-4;
    std::vector<double> above = logs, below = logs;
    above[i] += h;
    below[i] -= h;
    share.emplace_back(inverse * (offsets.information(above) - offsets.information(below)) / (2.0 * h));
  }
  ASSERT_EQ(found.slope.size(), static_cast<Eigen::Index>(logs.size()));
  EXPECT_GT(found.slope[0], 0.1) << "more random force, less known of the offsets";
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(found.slope[row], -0.5 * share[i].trace(), 2e-3) << i;
    for (std::size_t j = 0; j < logs.size(); ++j)
      EXPECT_NEAR(found.information_loss(row, static_cast<Eigen::Index>(j)), 0.5 * (share[i] * share[j]).trace(), 5e-3) << i << ' ' << j;
  }
}

/// All of the noise by one factor: −½ log det N rises by one per parameter, and twice as much is lost (n − p in place of n).
TEST(RestrictedLikelihood, OfACommonFactorCountsTheParameters) {
  const Offsets offsets;
  FilterEstimate estimate = offsets.estimate();
  estimate.data[0].covariance.setZero();  // the start known: the noise is all there is
  const RestrictedLikelihood found = restricted_likelihood(estimate, Eigen::VectorXd::Zero(2), 1);
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(found.slope.size());
  for (const Eigen::Index i : {0, 2, 3, 6, 7}) factor[i] = 1.0;
  EXPECT_NEAR(factor.dot(found.slope), 2.0, 0.01);
  EXPECT_NEAR(factor.dot(found.information_loss * factor), 2.0 * 2.0, 0.02);
}

TEST(RestrictedLikelihood, NothingWhereNothingIsEstimatedOrAtABound) {
  const Offsets offsets;
  FilterEstimate estimate = offsets.estimate();
  estimate.noise_fit.at_bound[0] = true;
  const RestrictedLikelihood bound = restricted_likelihood(estimate, Eigen::VectorXd::Zero(2), 1);
  EXPECT_EQ(bound.slope[0], 0.0);
  EXPECT_EQ(bound.information_loss.row(0).norm(), 0.0);
  EXPECT_NE(bound.slope[2], 0.0);
  for (Parameter& p : estimate.model.parameters) p.free = false;
  estimate.forced.model = estimate.model;
  EXPECT_EQ(restricted_likelihood(estimate, Eigen::VectorXd(0), 1).slope.norm(), 0.0);
}

}  // namespace
}  // namespace misfit
