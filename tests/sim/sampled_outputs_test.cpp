#include "misfit/sim/sampled_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double mass = 2.0, stiffness = 30.0, step = 0.02, fine = 1e-3;
constexpr int samples = 100, finer = 20;

/// The cart without damping under a force held over each step, in closed form: about its rest it turns by omega t.
struct Motion {
  double x, v;
  [[nodiscard]] Motion after(double t, double force) const {
    const double omega = std::sqrt(stiffness / mass), rest = force / stiffness;
    const double c = std::cos(omega * t), s = std::sin(omega * t);
    return {rest + (x - rest) * c + v / omega * s, v * c - (x - rest) * omega * s};
  }
};

/// Every millisecond, `before` steps before the first sample until as many after the last; inputs there as at the ends.
std::vector<Motion> motion_of(const std::vector<double>& force, Motion at, int before) {
  std::vector<Motion> out;
  std::vector<Motion> earlier{at};
  for (int k = 0; k < before * finer; ++k) earlier.push_back(earlier.back().after(-fine, force.front()));
  out.assign(earlier.rbegin(), earlier.rend());
  for (int k = 0; k < (samples - 1 + before) * finer; ++k) {
    const std::size_t held = std::min<std::size_t>(k / finer, force.size() - 1);
    out.push_back(out.back().after(fine, force[held]));
  }
  return out;
}

class CartWithAClock : public testing::TestWithParam<double> {};

/// Several steps later or earlier, and within one: through inputs that change on the way.
TEST_P(CartWithAClock, ReadsOneOutputAtItsOwnTimeAndTheOtherNot) {
  const double offset = GetParam();
  ModelRequest request = cart({effect("sensor_clock", {{"time_of_output", "sample_time_speed_reading"}})});
  request.parameters["sensor_offset"].value = offset;
  const Model model = assemble(request, registry());
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Signals signals;
  signals.name = "cart";
  signals.inputs.push_back({"drive", "N", {}});
  for (int k = 0; k < samples; ++k) {
    signals.t.push_back(step * k);
    signals.inputs[0].values.push_back(20.0 * normal(random));
  }
  for (const OutputSpec& o : model.system->spec().outputs) signals.measured.push_back({o.name, o.unit, std::vector<double>(samples, 0.0)});
  const Motion start{0.2, -0.4};
  constexpr int before = 10;
  const std::vector<Motion> truth = motion_of(signals.inputs[0].values, start, before);
  const InputTable inputs = input_table(signals, model);
  Stepper stepper(model);
  const std::vector<double> x0 = {start.x, start.v};
  Segment run, linear;
  run_segment({stepper, signals, inputs}, {0, samples, x0.data()}, run);
  run_segment({stepper, signals, inputs}, {0, samples, x0.data(), true}, linear);
  ASSERT_TRUE(run.finite && linear.finite);
  EXPECT_LE((run.y - linear.y).lpNorm<Eigen::Infinity>(), 1e-12);
  const int shifted = static_cast<int>(std::lround(offset / fine));
  for (int k = 0; k < samples; ++k) {
    const std::size_t at = static_cast<std::size_t>(k + before) * static_cast<std::size_t>(finer);
    EXPECT_NEAR(run.y(k, 0), truth[at].x, 1e-5) << k;
    EXPECT_NEAR(run.y(k, 1), truth[at + shifted].v, 1e-4) << k;  // of some 3 m/s
  }
}

INSTANTIATE_TEST_SUITE_P(EarlyAndLate, CartWithAClock, testing::Values(0.03, 0.07, 0.18, -0.02, -0.11, 0.0), [](const auto& p) {
  return (p.param < 0.0 ? "late_" : "early_") + std::to_string(std::lround(std::abs(p.param) * 1e3)) + "_ms";
});

/// A strain gauge that feels the force as well as the position, behind a clock of its own.
std::string gauge(const std::string& hold) {
  return R"toml([states]
x = { unit = "m", scale = 1.0 }
v = { unit = "m/s", rate_of = "x" }
[inputs]
force = { unit = "N", hold = ")toml" +
         hold + R"toml(" }
[parameters]
mass = { unit = "kg", value = 2.0 }
stiffness = { unit = "N/m", value = 30.0 }
gain = { unit = "V/m", value = 3.0 }
share = { unit = "V/N^2", value = 0.02, free = true }
[equations]
x = "v"
v = "(force - stiffness*x)/mass"
[outputs]
strain = { unit = "V", formula = "gain*x + share*force^2", noise = 0.01 }
)toml";
}

class OutputWithFeedthrough : public testing::TestWithParam<std::tuple<const char*, double>> {};

/// Within an interval, several samples off, and beyond both ends of the record.
TEST_P(OutputWithFeedthrough, MovesWithItsTimeAsDifferencesSay) {
  const auto& [hold, offset] = GetParam();
  const auto known = registry_with(gauge(hold));
  ModelRequest request = request_of("text", {effect("sensor_clock", {{"time_of_output", "sample_time"}})});
  request.parameters["sensor_offset"].free = true;
  request.parameters["clock_rate"].free = true;
  Model model = assemble(request, *known);
  const auto place = static_cast<std::size_t>(model.find_parameter("sensor_offset"));
  Signals signals;
  signals.name = "gauge";
  signals.measured = {{"strain", "V", std::vector<double>(samples, 0.0)}};
  signals.inputs = {{"force", "N", {}}};
  for (int k = 0; k < samples; ++k) {
    signals.t.push_back(step * k);
    signals.inputs[0].values.push_back(3.0 * std::sin(1.7 * k) + std::cos(0.3 * k));
  }
  const InputTable inputs = input_table(signals, model);
  const std::vector<double> x0 = {0.2, -0.4};
  const auto run_at = [&](double value, bool sensitivities) {
    model.parameters[place].value = value;
    Stepper stepper(model);
    Segment run;
    run_segment({stepper, signals, inputs}, {0, samples, x0.data(), sensitivities}, run);
    EXPECT_TRUE(run.finite);
    return run;
  };
  constexpr double beside = 1e-5;
  const Segment run = run_at(offset, true), before = run_at(offset - beside, false), after = run_at(offset + beside, false);
  const std::vector<int> free = model.free_parameters();
  const auto column = std::find(free.begin(), free.end(), static_cast<int>(place)) - free.begin();
  for (int k = 0; k < samples; ++k)
    EXPECT_NEAR(run.y_rows(k, column), (after.y(k, 0) - before.y(k, 0)) / (2.0 * beside), 1e-5) << k;  // of some 10 V/s
}

INSTANTIATE_TEST_SUITE_P(StraightAndHeld, OutputWithFeedthrough,
                         testing::Combine(testing::Values("first_order", "zero_order"), testing::Values(0.007, 0.113, -0.013)),
                         [](const auto& p) {
                           const double offset = std::get<1>(p.param);
                           return std::string(std::get<0>(p.param)) + (offset < 0.0 ? "_late_" : "_early_") +
                                  std::to_string(std::lround(std::abs(offset) * 1e3)) + "_ms";
                         });

TEST(SensorClock, IsRefusedAtWhatIsNoTimeOfAnOutput) {
  EXPECT_THROW(static_cast<void>(assemble(cart({effect("sensor_clock", {{"time_of_output", "sample_time_speed"}})}), registry())),
               InputError);
  EXPECT_THROW(static_cast<void>(assemble(cart({effect("sensor_clock", {{"time_of_output", "speed_reading"}})}), registry())), InputError);
}

}  // namespace
}  // namespace misfit
