// A chain of 20 masses as text: 40 states, 16 inputs, 24 outputs, 21 parameters.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;

constexpr int masses = 20, inputs = 16, speeds = 4;
constexpr double damping = 0.8;

double stiffness(int i) { return 40.0 + 3.0 * ((7 * i) % 11); }

/// Unit masses between springs, the first one to the wall; all dampers to the ground alike.
std::string chain() {
  std::string states, forces, parameters = "c = { unit = \"1/s\", value = 0.5, free = true }\n", equations, outputs;
  for (int i = 0; i < masses; ++i) {
    states += fmt::format("x{0} = {{ unit = \"m\", initial = \"free\" }}\nv{0} = {{ unit = \"m/s\", initial = \"free\" }}\n", i);
    if (i < inputs) forces += fmt::format("u{} = {{ unit = \"m/s^2\", hold = \"zero_order\" }}\n", i);
    parameters += fmt::format("k{} = {{ unit = \"1/s^2\", value = 50.0, free = true }}\n", i);
    const std::string before = i > 0 ? fmt::format("(x{} - x{})", i, i - 1) : "x0";
    std::string sum = fmt::format("-k{}*{} - c*v{}", i, before, i);
    if (i + 1 < masses) sum += fmt::format(" + k{}*(x{} - x{})", i + 1, i + 1, i);
    if (i < inputs) sum += fmt::format(" + u{}", i);
    equations += fmt::format("x{0} = \"v{0}\"\nv{0} = \"{1}\"\n", i, sum);
    outputs += fmt::format("x{} = {{ unit = \"m\", noise = 0.01 }}\n", i);
    if (i < speeds) outputs += fmt::format("v{} = {{ unit = \"m/s\", noise = 0.05 }}\n", i);
  }
  return "[system]\ndoc = \"a chain\"\n[states]\n" + states + "[inputs]\n" + forces + "[parameters]\n" + parameters + "[equations]\n" +
         equations + "[outputs]\n" + outputs;
}

/// By leapfrog steps of a fortieth of a sample.
std::string recording() {
  constexpr int samples = 130, parts = 40;
  constexpr double dt = 0.02, h = dt / parts;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::array<double, masses + 1> x{};  // x[i + 1] is that of mass i, x[0] the wall
  std::array<double, masses> v{};
  std::string text = "t[s]";
  for (int i = 0; i < inputs; ++i) text += fmt::format(",u{}[m/s^2]", i);
  for (int i = 0; i < masses; ++i) text += fmt::format(",x{}[m]", i);
  for (int i = 0; i < speeds; ++i) text += fmt::format(",v{}[m/s]", i);
  text += "\n";
  std::array<double, inputs> u{};
  for (int k = 0; k < samples; ++k) {
    for (double& force : u) {
      if (k % 10 == 0) force = 5.0 * normal(random);
    }
    text += fmt::format("{:.2f}", dt * k);
    for (const double force : u) text += fmt::format(",{}", force);
    for (int i = 0; i < masses; ++i) text += fmt::format(",{:.6f}", x[static_cast<std::size_t>(i) + 1] + 0.002 * normal(random));
    for (int i = 0; i < speeds; ++i) text += fmt::format(",{:.6f}", v[static_cast<std::size_t>(i)] + 0.02 * normal(random));
    text += "\n";
    for (int part = 0; part < parts; ++part) {
      for (std::size_t i = 0; i < masses; ++i) x[i + 1] += 0.5 * h * v[i];
      for (std::size_t i = 0; i < masses; ++i) {
        double force = -stiffness(static_cast<int>(i)) * (x[i + 1] - x[i]) + (i < inputs ? u[i] : 0.0);
        if (i + 1 < masses) force += stiffness(static_cast<int>(i) + 1) * (x[i + 2] - x[i + 1]);
        v[i] = (v[i] * (1.0 - 0.5 * h * damping) + h * force) / (1.0 + 0.5 * h * damping);
      }
      for (std::size_t i = 0; i < masses; ++i) x[i + 1] += 0.5 * h * v[i];
    }
  }
  return text;
}

TEST(AChainOfTwentyMasses, IsIdentifiedWithItsFortyStates) {
  testing_text_study::TextStudy study(chain(), recording());
  const Fit fit = study.fit("output_error", "");
  ASSERT_TRUE(fit.parameters.contains("k0")) << fit.message;
  double squares = 0.0;
  for (int i = 0; i < masses; ++i) {
    const Estimate& k = fit.parameters.at("k" + std::to_string(i));
    const double deviation = (k.value - stiffness(i)) / k.sigma;
    EXPECT_LT(std::abs(deviation), 4.0) << "k" << i << " = " << k.value << " ± " << k.sigma << ", put in " << stiffness(i);
    EXPECT_LT(k.sigma, 0.05 * stiffness(i)) << i;
    squares += deviation * deviation;
  }
  EXPECT_LT(squares / masses, 2.2) << "chi^2 of 20 beyond 2.2 has a probability of 0.2 %";
  EXPECT_NEAR(fit.parameters.at("c").value, damping, 4.0 * fit.parameters.at("c").sigma);
}

}  // namespace
