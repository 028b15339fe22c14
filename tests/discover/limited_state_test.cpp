// A state whose own rate is limited: a control surface that follows its command with a time constant, but no faster than its drive turns
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "misfit/discover/discover.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string surface_text = R"toml(
[states]
y = { unit = "m", scale = 1.0 }
[inputs]
cmd = { unit = "m", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 0.13, bounds = [1e-4, 10.0], free = true }
gain = { unit = "-", value = 1.0, free = true }
rest = { unit = "m", value = 0.0, free = true }
[equations]
y = "(rest + gain*cmd - y)/tau"
[outputs]
y = { unit = "m", noise = 0.05 }
)toml";

/// y' = clamp((cmd − y)/0.05 s, ±60 m/s) by Euler steps of 0.1 ms, which share nothing with sim/; sampled every 10 ms.
Signals surface() {
  constexpr double tau = 0.05, limit = 60.0, step = 0.01, fine = 1e-4, noise = 0.05;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> level(-12.0, 12.0);
  Signals s;
  s.name = "surface";
  s.measured = {{"y", "m", {}, 0.0}};
  s.inputs = {{"cmd", "m", {}, 0.0}};
  double y = 0.0, cmd = 0.0;
  for (int k = 0, next = 0; k < 1500; ++k) {
    if (k == next) cmd = level(random), next += 10 + static_cast<int>(random() % 60);
    s.t.push_back(step * k);
    s.inputs[0].values.push_back(cmd);
    s.measured[0].values.push_back(y + noise * normal(random));
    for (int i = 0; i < 100; ++i) y += fine * std::clamp((cmd - y) / tau, -limit, limit);
  }
  return s;
}

TEST(AStateWhoseRateIsLimited, IsNamedWithItsLimitAndTheTimeWithinWhichItFollows) {
  const auto systems = registry_with(surface_text);
  const ModelRequest request = request_of("text");
  const std::vector<Signals> signals = {surface()};
  const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
  const Discovery found = discover({estimate, request, *systems, signals}, {});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "rate_limit") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate limit = first.parameters.at("rate_limit"), follow = first.parameters.at("follow_time");
  EXPECT_NEAR(limit.value, 60.0, 4.0 * limit.sigma);
  EXPECT_LT(limit.sigma, 0.5);
  EXPECT_NEAR(follow.value, 0.05, 0.002);
}

}  // namespace
}  // namespace misfit
