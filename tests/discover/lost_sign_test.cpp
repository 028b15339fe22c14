// A sensor that loses the sign: its score vanishes, and the model that was fitted to sizes is far off.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/discover/found.h"
#include "tests/fit/rectified.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing_rectified::motor;

const std::string motor_text = R"toml(
[states]
w = { unit = "rad/s", scale = 50.0 }
[inputs]
U = { unit = "V", hold = "zero_order" }
[parameters]
gain = { unit = "rad/s/V", value = 1.0, free = true }
tau = { unit = "s", value = 1.0, free = true, bounds = [0.001, 100.0] }
rest = { unit = "rad/s", value = 0.0, free = true }
[equations]
w = "(rest + gain*U - w)/tau"
[outputs]
w = { unit = "rad/s", noise = 0.5 }
)toml";

double value_of(const FilterEstimate& estimate, const std::string& name) {
  for (const Parameter& p : estimate.model.parameters) {
    if (p.name == name) return p.value;
  }
  ADD_FAILURE() << name;
  return 0.0;
}

class ASensorThatLosesTheSign : public testing::TestWithParam<double> {};

TEST_P(ASensorThatLosesTheSign, IsFoundWhicheverWayTheMotionBegins) {
  const Found recording(motor(true, GetParam(), 21), motor_text);
  const Discovery found = recording.discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "sensor_absolute") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  ASSERT_TRUE(first.actual_drop);
  EXPECT_GT(*first.actual_drop, 500.0);
}

INSTANTIATE_TEST_SUITE_P(From, ASensorThatLosesTheSign, testing::Values(40.0, -40.0));

TEST(AModelWithASensorThatLosesTheSign, IsFittedFromEitherSignOfItsStart) {
  for (const double w0 : {40.0, -40.0}) {
    ModelRequest request = request_of("text");
    request.effects.emplace_back();
    request.effects.back().name = request.effects.back().kind = "sensor_absolute";
    request.effects.back().roles = {{"output", "w"}};
    const auto systems = registry_with(motor_text);
    Model start = assemble(request, *systems);
    set(start, "gain", 5.0);
    set(start, "tau", 0.4);
    set(start, "folded", 1.0);
    for (Parameter& p : start.parameters) {
      if (p.name == "folded") p.free = false;
      if (p.name == "fold_width") p.value = 0.5;
    }
    const std::vector<Signals> signals = {motor(true, w0, 22)};
    const FilterEstimate estimate = estimate_filter(start, {}, signals);
    EXPECT_NEAR(value_of(estimate, "gain"), testing_rectified::gain, 0.1) << w0;
    EXPECT_NEAR(value_of(estimate, "tau"), testing_rectified::tau, 0.01) << w0;
    EXPECT_GT(estimate.data.front().start[0] * w0, 0.0) << "the sign of the start";
  }
}

}  // namespace
}  // namespace misfit
