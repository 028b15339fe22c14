// A motor whose speed sensor shows no sign: no values of its model's parameters follow what it measures, and the searches end where the
// noise of that output is as large as its motion.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

const std::string motor_text = R"toml(
[states]
w = { unit = "rad/s" }
i = { unit = "A" }
[inputs]
U = { unit = "V", hold = "zero_order" }
[parameters]
R = { unit = "V/A", value = 0.85, free = true, bounds = [0.0, 100.0] }
L = { unit = "V s/A", value = 0.041, free = true, bounds = [1e-4, 10.0] }
K = { unit = "V s", value = 0.115, free = true, bounds = [0.0, 10.0] }
J = { unit = "kg m^2", value = 0.00154, free = true, bounds = [1e-6, 1.0] }
b = { unit = "N m s", value = 0.00082, free = true, bounds = [0.0, 1.0] }
[equations]
w = "(K*i - b*w)/J"
i = "(U - R*i - K*w)/L"
[outputs]
w = { unit = "rad/s", noise = 0.5 }
i = { unit = "A", noise = 0.05 }
)toml";

Signals unsigned_motor(unsigned seed) {
  constexpr double step = 0.01, fine = 5e-4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> volts(-12.0, 12.0);
  Signals s;
  s.name = "motor";
  s.measured = {{"w", "rad/s", {}, 0.0}, {"i", "A", {}, 0.0}};
  s.inputs = {{"U", "V", {}, 0.0}};
  double w = 0.0, i = 0.0, U = 0.0;
  for (int n = 0, next = 0; n < 801; ++n) {
    if (n == next) U = volts(random), next += 10 + static_cast<int>(random() % 60);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(U);
    s.measured[0].values.push_back(std::abs(w) + 0.3 * normal(random));
    s.measured[1].values.push_back(i + 0.03 * normal(random));
    for (int k = 0; k < 20; ++k) {
      const double torque = (0.1 * i - 0.0006 * w) / 0.002 - 0.036 * std::abs(w) * w, volt = (U - i - 0.1 * w) / 0.1;
      w += fine * torque;
      i += fine * volt;
    }
  }
  return s;
}

TEST(OutputErrorWhereNothingFits, SaysSo) {
  const auto systems = testing_models::registry_with(motor_text);
  const Model model = assemble(testing_models::request_of("text"), *systems);
  constexpr unsigned first = 37, count = 4;  // of 39 the equations are singular with the noise that the search ended with
  for (unsigned seed = first; seed < first + count; ++seed) {
    const std::vector<Signals> recording = {unsigned_motor(seed)};
    const Fit fit = output_error(equation_error(model, recording), recording).fit;
    EXPECT_FALSE(fit.usable()) << "seed " << seed;
    EXPECT_FALSE(fit.message.empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace misfit
