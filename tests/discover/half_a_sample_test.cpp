// An input that is held between its samples, where the model has it straight between them: it seems late by half a sampling interval.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/discover/discover.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string wall_text = R"toml(
[states]
T = { unit = "K" }
[inputs]
outside = { unit = "K", hold = "first_order" }
[parameters]
tau = { unit = "s", value = 2000.0, bounds = [1.0, 1e6], free = true }
[equations]
T = "(outside - T)/tau"
[outputs]
T = { unit = "K", noise = 0.02 }
)toml";

constexpr double step = 600.0, tau = 3000.0;

/// A wall behind weather that wanders, held over each interval, `late` intervals later than it is recorded.
Signals record_of_wall(unsigned seed, std::size_t late) {
  constexpr std::size_t samples = 700;
  constexpr double noise = 0.02;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "wall";
  s.inputs = {{"outside", "K", {}, 0.0}};
  s.measured = {{"T", "K", {}, 0.0}};
  double T = 10.0;
  for (std::size_t i = 0; i < samples; ++i) {
    std::vector<double>& outside = s.inputs[0].values;
    outside.push_back(outside.empty() ? 10.0 : 10.0 + 0.97 * (outside.back() - 10.0) + normal(random));
    s.t.push_back(step * static_cast<double>(i));
    s.measured[0].values.push_back(T + noise * normal(random));
    const double acts = outside[i >= late ? i - late : 0];
    T = acts + (T - acts) * std::exp(-step / tau);
  }
  return s;
}

Candidate first_of(std::size_t late) {
  const auto known = registry_with(wall_text);
  const ModelRequest model = request_of("text");
  const std::vector<Signals> signals = {record_of_wall(3, late)};
  const FilterEstimate estimate = estimate_filter(assemble(model, *known), {}, signals);
  return discover({estimate, model, *known, signals}).candidates.at(0);
}

TEST(AHeldInputTakenForAStraightOne, IsSaidBesideTheOffsetThatItLooksLike) {
  const Candidate first = first_of(0);
  ASSERT_EQ(first.effect, "time_offset") << first.why;
  EXPECT_NEAR(first.parameters.at("clock_offset").value, -0.5 * step, 0.1 * step);
  ASSERT_TRUE(first.also);
  EXPECT_EQ(first.holds, (std::map<std::string, std::string>{{"outside", "zero_order"}}));
  EXPECT_THAT(*first.also, testing::AllOf(testing::HasSubstr("half a sampling interval (300 s)"), testing::HasSubstr("zero_order")));
}

TEST(AHeldInputTakenForAStraightOne, IsNotSaidOfALongerDelay) {
  const Candidate first = first_of(2);
  ASSERT_EQ(first.effect, "delay") << first.why;
  EXPECT_NEAR(first.parameters.at("delay").value, 2.5 * step, 0.1 * step);
  EXPECT_FALSE(first.also) << *first.also;
  EXPECT_FALSE(first.holds);
}

}  // namespace
}  // namespace misfit
