// A first-order process whose input acts late, run against the exact solution.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/sim/trajectory.h"
#include "tests/model/cases.h"
#include "tests/model/declared_texts.h"
#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double rate = 2.0, gain = 3.0, step = 0.1;

std::string process(const std::string& hold) {
  return R"toml([states]
x = { unit = "V" }
[inputs]
u = { unit = "V", hold = ")toml" +
         hold + R"toml(" }
[parameters]
a = { unit = "1/s", value = 2.0, free = true }
b = { unit = "1/s", value = 3.0, free = true }
[equations]
x = "b*u - a*x"
[outputs]
y = { unit = "V", formula = "x" }
)toml";
}

class Late : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> level(-1.0, 1.0);
    signals_.name = "process";
    signals_.inputs = {{"u", "V", {}, 0.0}};
    for (int i = 0; i < 80; ++i) {
      signals_.t.push_back(step * i);
      signals_.inputs[0].values.push_back(level(random));
    }
    ModelRequest request = request_of("text");
    request.effects = {effect("delay", {{"input", "u"}, {"port", "dx/dt"}})};
    request.parameters["delayed_gain"].value = gain;
    model_ = assemble(request, *known_);
    inputs_ = input_table(signals_, model_);
  }

  [[nodiscard]] double input(double t) const {
    const auto& u = signals_.inputs[0].values;
    if (t <= 0.0) return u.front();
    const double place = t / step, floor = std::floor(place + 1e-12);
    const auto k = static_cast<std::size_t>(floor);
    return held_ ? u[k] : u[k] + (place - floor) * (u[k + 1] - u[k]);
  }

  /// x at the last sample by small midpoint steps of the exact solution with constant input, whose edges are those of the delayed input.
  [[nodiscard]] double exactly(double delay) const {
    constexpr int parts = 2000;  // of a sample
    const double h = step / parts, decay = std::exp(-rate * h);
    double x = 0.0;
    for (int i = 0; i < 79 * parts; ++i) x = decay * x + (1.0 - decay) * gain / rate * input((i + 0.5) * h - delay);
    return x;
  }

  [[nodiscard]] Segment run(double delay, bool sensitivities = false) {
    std::vector<double> values = model_.values();
    values[static_cast<std::size_t>(model_.find_parameter("delay"))] = delay;
    Stepper stepper(model_);
    stepper.evaluator().set_parameters(values.data());
    const double x0 = 0.0;
    Segment out;
    run_segment({stepper, signals_, inputs_}, {0, 80, &x0, sensitivities}, out);
    EXPECT_TRUE(out.finite);
    return out;
  }

  bool held_ = std::string(GetParam()) == "zero_order";
  std::shared_ptr<Registry> known_ = registry_with(process(GetParam()));
  Model model_;
  Signals signals_;
  InputTable inputs_;
};

TEST_P(Late, ActsWhenItShould) {
  // To third order in rate x step = 0.2: of what a sample of input does, 0.3, less than a thousandth.
  for (const double delay : {0.03, 0.15, 0.777, 2.41}) EXPECT_NEAR(run(delay).end[0], exactly(delay), 3e-4) << delay << " s";
}

TEST_P(Late, ByWholeSamplesIsTheInputOfEarlierSamples) {
  for (const std::size_t late : {std::size_t{0}, std::size_t{1}, std::size_t{7}}) {
    const double here = run(step * static_cast<double>(late)).end[0];
    const auto recorded = signals_.inputs[0].values;
    auto& u = signals_.inputs[0].values;
    for (std::size_t i = u.size(); i-- > 0;) u[i] = recorded[i > late ? i - late : 0];
    inputs_ = input_table(signals_, model_);
    EXPECT_NEAR(run(0.0).end[0], here, 1e-12) << late;
    u = recorded;
    inputs_ = input_table(signals_, model_);
  }
}

TEST_P(Late, IsDifferentiatedExactly) {
  const std::vector<int> free = model_.free_parameters();
  for (const double delay : {0.037, 0.777}) {
    const Segment linear = run(delay, true);
    const auto column = std::find(free.begin(), free.end(), model_.find_parameter("delay")) - free.begin();
    constexpr double by = 1e-6;
    const Segment later = run(delay + by), earlier = run(delay - by);
    for (Eigen::Index i = 0; i < linear.y.rows(); ++i)
      EXPECT_NEAR(linear.y_rows(i, column), (later.y(i, 0) - earlier.y(i, 0)) / (2.0 * by), 1e-6) << "sample " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(HeldAndStraight, Late, testing::Values("zero_order", "first_order"));

TEST(LateOnly, InputsHaveAPast) {
  const auto known = registry_with(process("zero_order"));
  ModelRequest request = request_of("text");
  request.effects = {effect("delay", {{"input", "x"}, {"port", "dx/dt"}})};
  try {
    static_cast<void>(assemble(request, *known));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'x' is none of system 'text'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace misfit
