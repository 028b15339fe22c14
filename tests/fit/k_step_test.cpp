#include "misfit/fit/filter/k_step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/data/ladder.h"
#include "tests/fit/cart_filter.h"

namespace misfit {
namespace {

using namespace testing_cart;

/// What k_step_errors reads of an estimate; a cubic spring sends what starts far out to infinity.
FilterEstimate estimate_of(const Cart& cart) {
  FilterEstimate estimate;
  estimate.model = cart.model.model;
  estimate.forced = cart.model;
  estimate.noise = cart.noise;
  estimate.data = {cart.data};
  estimate.traces = {cart.run()};
  return estimate;
}

void send_off(FilterEstimate& estimate, std::size_t runs) {
  FilterTrace& trace = estimate.traces[0];
  for (std::size_t run = 0; run < runs; ++run) trace.predicted[3 * run * static_cast<std::size_t>(trace.n)] = 1e150;
}

TEST(KStep, FreeRunsThatAllEndSayNothing) {
  const Cart cart(303, 5, {effect("cubic_stiffness")});
  const KStepErrors errors = k_step_errors(estimate_of(cart));
  EXPECT_EQ(errors.words, "");
  EXPECT_THAT(errors.diverged, testing::Each(0U));
  EXPECT_EQ(errors.runs.front(), 101U);
  EXPECT_EQ(errors.runs.back(), 91U) << "from every third sample that has 32 more behind it";
  for (const auto& [channel, rms] : errors.rms) {
    ASSERT_EQ(rms.size(), std::size(kLadderSteps));
    for (const double value : rms) EXPECT_TRUE(value > 0.0) << channel;
  }
}

TEST(KStep, AFewThatDivergeAreCountedAndLeftOut) {
  const Cart cart(303, 5, {effect("cubic_stiffness")});
  FilterEstimate estimate = estimate_of(cart);
  estimate.forced.model.parameters[static_cast<std::size_t>(estimate.forced.model.find_parameter("cubic_stiffness"))].value = 1.0;
  const KStepErrors before = k_step_errors(estimate);
  send_off(estimate, 2);
  const KStepErrors errors = k_step_errors(estimate);
  EXPECT_THAT(errors.diverged, testing::Each(2U));
  EXPECT_THAT(errors.words, testing::StartsWith("2 of 101 predictions diverge within 1 sample: they are not in its error; 2 of "));
  EXPECT_NEAR(errors.rms.at("speed_reading")[5], before.rms.at("speed_reading")[5], 0.05 * before.rms.at("speed_reading")[5]);
}

TEST(KStep, WhereManyDivergeNoErrorIsGiven) {
  const Cart cart(303, 5, {effect("cubic_stiffness")});
  FilterEstimate estimate = estimate_of(cart);
  estimate.forced.model.parameters[static_cast<std::size_t>(estimate.forced.model.find_parameter("cubic_stiffness"))].value = 1.0;
  send_off(estimate, 10);
  const KStepErrors errors = k_step_errors(estimate);
  EXPECT_THAT(errors.words, testing::HasSubstr("10 of 91 predictions diverge within 32 samples: no error is given there"));
  for (const auto& [channel, rms] : errors.rms) EXPECT_TRUE(std::isnan(rms.back())) << channel;
}

/// The series has the errors whose RMS k_step_errors gives, of every sample instead of every third.
TEST(KStep, PredictionsFarAheadHaveTheErrorsOfTheLongestRuns) {
  const Cart cart(303, 5, {effect("cubic_stiffness")});
  const FilterEstimate estimate = estimate_of(cart);
  const std::vector<std::vector<double>> ahead = predictions_far_ahead(estimate, 0);
  const KStepErrors errors = k_step_errors(estimate);
  const Signals& signals = *estimate.data[0].signals;
  const auto& outputs = estimate.model.system->spec().outputs;
  ASSERT_EQ(ahead.size(), outputs.size());
  for (std::size_t o = 0; o < ahead.size(); ++o) {
    ASSERT_EQ(ahead[o].size(), signals.samples());
    for (std::size_t k = 0; k < ahead[o].size(); ++k) EXPECT_EQ(std::isfinite(ahead[o][k]), k >= std::size_t{kFarAhead}) << k;
    double squares = 0.0, count = 0.0;
    for (std::size_t k = kFarAhead; k < signals.samples(); k += 3) {
      squares += std::pow(signals.measured[o].values[k] - ahead[o][k], 2);
      count += 1.0;
    }
    const double rms = std::sqrt(squares / count);
    EXPECT_NEAR(errors.rms.at(outputs[o].name).back(), rms, 1e-9 * rms) << outputs[o].name;
  }
}

/// Three samples of the position leave the speed unknown to 2 m/s: the next position follows to 0.1, that of 0.64 s later to no more
/// than 1.
TEST(KStep, NoneIsMadeFarAheadOfASpeedThatTheFirstSamplesHardlyShow) {
  Cart cart(303);
  for (std::size_t k = 0; k < 303; ++k) cart.data.use[2 * k + 1] = SampleRole::none;
  cart.noise.force = 0.1;
  cart.data.covariance(1, 1) = 100.0;
  const FilterEstimate unknown = estimate_of(cart);
  const std::vector<double> position = predictions_far_ahead(unknown, 0)[0];
  EXPECT_TRUE(std::isnan(position[std::size_t{kFarAhead}]));
  for (std::size_t k = 20 + std::size_t{kFarAhead}; k < 303; ++k) EXPECT_TRUE(std::isfinite(position[k])) << k;

  cart.data.covariance(1, 1) = 0.03;
  const FilterEstimate known = estimate_of(cart);
  EXPECT_TRUE(std::isfinite(predictions_far_ahead(known, 0)[0][std::size_t{kFarAhead}]));
  const double far = k_step_errors(unknown).rms.at("position_reading").back(),
               of_known = k_step_errors(known).rms.at("position_reading").back();
  EXPECT_LT(far, 1.2 * of_known) << "one such error would make up the whole of it";
}

TEST(GrowthOfErrors, IsThatOfTheLongestPredictionsOverAllChannels) {
  const double nan = std::nan("");
  EXPECT_DOUBLE_EQ(growth_of_errors({{"x", {1.0, 2.0}}}, {{"x", {0.5, 3.0}}}), 1.5);
  EXPECT_DOUBLE_EQ(growth_of_errors({{"x", {1.0, 2.0}}, {"y", {1.0, 1.0}}}, {{"x", {1.0, 2.0}}, {"y", {1.0, 7.0}}}), 5.0);
  EXPECT_DOUBLE_EQ(growth_of_errors({{"x", {1.0, nan}}}, {{"x", {2.0, nan}}}), 2.0) << "of the longest that the model before has";
  EXPECT_TRUE(std::isinf(growth_of_errors({{"x", {1.0, 2.0}}}, {{"x", {1.0, nan}}}))) << "they diverge now";
  EXPECT_DOUBLE_EQ(growth_of_errors({{"x", {1.0, 2.0}}}, {{"y", {9.0, 9.0}}}), 1.0) << "nothing in common";
  EXPECT_THAT(growth_in_words(1.85), testing::HasSubstr("grow by 85 %"));
  EXPECT_THAT(growth_in_words(1e13), testing::HasSubstr("more than ten times"));
}

}  // namespace
}  // namespace misfit
