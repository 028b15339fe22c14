// Two forms of friction that together look like a third.
#include "misfit/discover/pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/discover/discover.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string sledge_text = R"toml(
[states]
w = { unit = "m/s" }
[inputs]
u = { unit = "N", hold = "zero_order" }
[parameters]
c = { unit = "1/s", value = 0.5, bounds = [-10.0, 10.0], free = true }
g = { unit = "1/kg", value = 1.0, free = true }
[equations]
w = "g*u - c*w"
[outputs]
w = { unit = "m/s", noise = 0.01 }
[roles]
rate = "w"
)toml";

/// What rubs beside 0.3 1/s of viscous friction.
struct Rubs {
  double friction = 0.0, drag = 0.0, cubic = 0.0;
};

/// 100 s of a sledge that is pushed at random; Euler steps of 1.25 ms, 50 ms apart.
Signals record_of_sledge(const Rubs& rubs) {
  constexpr int samples = 2000, held = 25, steps = 40;
  constexpr double step = 0.05, h = step / steps, width = 0.03;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "sledge";
  s.inputs = {{"u", "N", {}, 0.0}};
  s.measured = {{"w", "m/s", {}, 0.0}};
  double w = 0.0, u = 0.0;
  for (int i = 0; i < samples; ++i) {
    if (i % held == 0) u = 3.0 * normal(random);
    s.t.push_back(step * i);
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(w + 0.01 * normal(random));
    for (int k = 0; k < steps; ++k)
      w += h * (u - 0.3 * w - rubs.friction * std::tanh(w / width) - rubs.drag * w * std::abs(w) - rubs.cubic * w * w * w);
  }
  return s;
}

Discovery of_sledge(const Rubs& rubs) {
  const auto registry = registry_with(sledge_text);
  const ModelRequest request = request_of("text");
  const std::vector<Signals> signals = {record_of_sledge(rubs)};
  const FilterEstimate estimate = estimate_filter(assemble(request, *registry), {}, signals);
  return discover({estimate, request, *registry, signals});
}

TEST(Pairs, DryFrictionAndDragAreNotTakenForACubic) {
  const Discovery found = of_sledge({.friction = 0.3, .drag = 0.3});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_TRUE(first.accepted) << found.verdict;
  EXPECT_THAT(first.effect, testing::AnyOf("quadratic_drag", "coulomb_friction")) << found.verdict;
  EXPECT_THAT(first.why, testing::HasSubstr("add "));
  for (const Candidate& c : found.candidates) {
    if (c.effect == "cubic_damping") {
      EXPECT_THAT(c.why, testing::HasSubstr("explain more between them")) << first.why;
    }
  }
}

TEST(Pairs, ACubicIsOne) {
  const Discovery found = of_sledge({.cubic = 0.1});
  ASSERT_FALSE(found.candidates.empty());
  EXPECT_EQ(found.candidates.front().effect, "cubic_damping") << found.verdict;
  EXPECT_TRUE(found.candidates.front().accepted);
}

}  // namespace
}  // namespace misfit
