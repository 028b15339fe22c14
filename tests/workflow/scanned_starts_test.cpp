// A study with an effect whose frequency it says nothing of: the likelihood has a maximum per frequency, and one near the effect's default
// is not the one that is there.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing::Contains;
using testing::HasSubstr;
using testing::Key;
using testing::Not;

constexpr double frequency = 0.37, amplitude = 0.6, stiffness = 4.0;

/// An oscillator that something shakes, by Euler steps of a fortieth of a sample.
std::string recording() {
  std::string text = "t[s],y[m]\n";
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.005);
  constexpr int samples = 600, steps = 40;
  constexpr double dt = 0.05, h = dt / steps;
  double y = 0.5, w = 0.0;
  for (int i = 0; i < samples; ++i) {
    char row[60];
    std::snprintf(row, sizeof row, "%.3f,%.5f\n", i * dt, y + noise(random));
    text += row;
    for (int k = 0; k < steps; ++k) {
      const double t = i * dt + k * h;
      w += h * (-stiffness * y - 0.3 * w + amplitude * std::sin(2.0 * std::numbers::pi * frequency * t));
      y += h * w;
    }
  }
  return text;
}

class AShakenOscillator : public testing::Test {
 protected:
  Fit fit(const std::string& method, const std::string& effect) { return study_.fit(method, effect); }

  testing_text_study::TextStudy study_{R"toml([system]
doc = "an oscillator"
[states]
y = { unit = "m", initial = "free" }
w = { unit = "m/s", rate_of = "y", initial = "free" }
[parameters]
k = { unit = "1/s^2", value = 3.0, bounds = [0.01, 100.0], free = true }
c = { unit = "1/s", value = 0.5, bounds = [0.0, 10.0], free = true }
[equations]
w = "-k*y - c*w"
[outputs]
y = { unit = "m", noise = 0.005 }
)toml",
                                       recording()};
};

void expect_found(const Fit& fit) {
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  const Estimate& found = fit.parameters.at("frequency");
  EXPECT_NEAR(found.value, frequency, 4.0 * found.sigma);
  EXPECT_LT(found.sigma, 0.001);
  const Estimate &cosine = fit.parameters.at("cosine"), &sine = fit.parameters.at("sine");
  EXPECT_NEAR(std::hypot(cosine.value, sine.value), amplitude, 0.02);
  EXPECT_NEAR(fit.parameters.at("k").value, stiffness, 4.0 * fit.parameters.at("k").sigma);
  EXPECT_THAT(fit.facts, Contains(Key("start of periodic_forcing")));
  EXPECT_THAT(fit.facts.at("start of periodic_forcing"), HasSubstr("frequency = 0.3"));
}

TEST_F(AShakenOscillator, FrequencyIsFoundByFilterErrorThoughNoStartIsGiven) {
  expect_found(fit("filter_error", R"(periodic_forcing = { port = "dw/dt" })"));
}

TEST_F(AShakenOscillator, FrequencyIsFoundByOutputErrorThoughNoStartIsGiven) {
  expect_found(fit("output_error", R"(periodic_forcing = { port = "dw/dt" })"));
}

TEST_F(AShakenOscillator, AStartThatTheStudyGivesIsKept) {
  const Fit found = fit("filter_error", R"(periodic_forcing = { port = "dw/dt", start = { frequency = 0.371 } })");
  EXPECT_THAT(found.facts, Not(Contains(Key("start of periodic_forcing"))));
  EXPECT_NEAR(found.parameters.at("frequency").value, frequency, 4.0 * found.parameters.at("frequency").sigma);
}

}  // namespace
