// What is held out at the end changes nothing of a fit: a search leaves it out of its runs, but for the last.
#include <gtest/gtest.h>

#include <cmath>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/fit/first_order.h"

namespace misfit {
namespace {

using namespace testing_first_order;

FilterEstimate estimate(const Model& model, const std::vector<Signals>& experiments, bool whole_runs) {
  FilterOptions options;
  options.whole_runs = whole_runs;
  return estimate_filter(model, {}, experiments, options);
}

TEST(WholeRuns, ChangeNothingOfAnEstimate) {
  const auto known = registry_with(one_output);
  const Model model = assemble(request_of("text"), *known);
  Signals cut = record("cut", 1.0, 5), test = record("test", 0.7, 6);
  cut.validation_from = cut.t[cut.t.size() / 2];
  test.validation_from = -1.0;
  const std::vector<Signals> experiments = {cut, record("fit", 1.0, 7), test};
  const FilterEstimate whole = estimate(model, experiments, true), shorter = estimate(model, experiments, false);
  ASSERT_TRUE(whole.converged) << whole.message;
  EXPECT_EQ(whole.model.theta(), shorter.model.theta());
  EXPECT_EQ(whole.objective, shorter.objective);
  EXPECT_EQ(whole.covariance, shorter.covariance);
  EXPECT_EQ(whole.validation_loglik, shorter.validation_loglik);
  EXPECT_TRUE(std::isfinite(shorter.validation_loglik));
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    EXPECT_EQ(shorter.traces[e].end, experiments[e].samples()) << "the last run";
    EXPECT_EQ(shorter.traces[e].validated, whole.traces[e].validated);
  }
}

TEST(EndOfFit, IsBehindTheLastSampleThatEntersIt) {
  const auto known = registry_with(one_output);
  const FilterModel forced = with_random_force(assemble(request_of("text"), *known));
  Signals s = record("cut", 1.0, 5);
  EXPECT_EQ(end_of_fit(filter_data(forced, s)), s.samples());
  s.validation_from = s.t[30];
  EXPECT_EQ(end_of_fit(filter_data(forced, s)), 30U);
  s.measured[0].values[29] = std::nan("");
  EXPECT_EQ(end_of_fit(filter_data(forced, s)), 29U);
  s.validation_from = -1.0;
  EXPECT_EQ(end_of_fit(filter_data(forced, s)), 0U);
}

/// Of a recording that is held out as a whole, with a curve of many knots in the model.
TEST(FilterJacobian, OfNothingThatCountsAddsNothing) {
  constexpr int many = 60;
  FilterJacobian none;
  none.J.resize(0, many);
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(many, many);
  none.add_information(information);
  EXPECT_EQ(information, Eigen::MatrixXd::Identity(many, many));
}

/// x' = b sqrt(k − u) − a x cannot be run where u is 2 and k is smaller: beyond what is fitted, where u is 1 at most and k is about 1.5.
TEST(WholeRuns, AreMadeWhereTheModelDivergesInWhatIsHeldOut) {
  const std::string text = R"toml(
[states]
x = { unit = "V", scale = 1.0 }
[inputs]
u = { unit = "-", hold = "zero_order" }
[parameters]
a = { unit = "1/s", value = 1.0 }
b = { unit = "V/s", value = 1.0 }
k = { unit = "-", value = 4.0, bounds = [1.1, 100.0], free = true }
[equations]
x = "b*sqrt(k - u) - a*x"
[outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml";
  const auto known = registry_with(text);
  const Model model = assemble(request_of("text"), *known);
  Signals s = record("one", 1.0, 8);
  s.validation_from = 0.75 * s.t.back();
  double x = 1.0;
  for (std::size_t i = 0; i < s.samples(); ++i) {
    double& u = s.inputs[0].values[i];
    s.measured[0].values[i] = x + 0.01 * std::sin(7.3 * static_cast<double>(i * i));
    if (i + 1 < s.samples()) x += (s.t[i + 1] - s.t[i]) * (std::sqrt(1.5 - u) - x);
    if (s.held_out(i)) u *= 2.0;
  }
  const FilterEstimate fitted = estimate(model, {s}, false);
  EXPECT_TRUE(fitted.whole_runs);
  EXPECT_GE(fitted.model.theta()[0], 2.0);
  EXPECT_TRUE(std::isfinite(fitted.validation_loglik));
  s.validation_from = s.t.back() + 1.0;
  for (double& u : s.inputs[0].values) u = std::min(u, 1.0);
  const FilterEstimate all = estimate(model, {s}, false);
  EXPECT_FALSE(all.whole_runs);
}

}  // namespace
}  // namespace misfit
