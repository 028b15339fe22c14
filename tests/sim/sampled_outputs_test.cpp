#include "misfit/sim/sampled_outputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/model/requests.h"

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

TEST(SensorClock, IsRefusedAtWhatIsNoTimeOfAnOutput) {
  EXPECT_THROW(static_cast<void>(assemble(cart({effect("sensor_clock", {{"time_of_output", "sample_time_speed"}})}), registry())),
               InputError);
  EXPECT_THROW(static_cast<void>(assemble(cart({effect("sensor_clock", {{"time_of_output", "speed_reading"}})}), registry())), InputError);
}

}  // namespace
}  // namespace misfit
