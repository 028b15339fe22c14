// A recording under feedback: a controller reads the noisy measurement, so that what it sets at a sample answers to the noise of that very
// sample. A held input acts from there on alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "misfit/discover/discover.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string hover_text = R"toml(
[states]
z = { unit = "m", scale = 1.0 }
v = { unit = "m/s", scale = 1.0, rate_of = "z" }
[inputs]
u = { unit = "-", hold = "zero_order" }
[parameters]
lift = { unit = "m/s^2", value = 19.0, free = true }
drag = { unit = "1/s", value = 0.3, free = true }
gravity = { unit = "m/s^2", value = 9.81 }
[equations]
v = "lift*u - gravity - drag*v"
[outputs]
z = { unit = "m", noise = 0.004 }
)toml";

/// A hovering vehicle without anything hidden, by Euler steps of half a millisecond; proportional and differential feedback of the measured
/// height, whose noise of 4 mm moves the thrust by 2 %.
Signals hover(unsigned seed) {
  constexpr double step = 0.05, fine = 5e-4, noise = 0.004, lift = 19.6, drag = 0.35, gravity = 9.81;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> height(0.3, 1.5);
  Signals s;
  s.name = "hover";
  s.measured = {{"z", "m", {}, 0.0}};
  s.inputs = {{"u", "-", {}, 0.0}};
  double z = 0.5, v = 0.0, wanted = 0.5, before = 0.5;
  for (int k = 0; k < 1200; ++k) {
    if (k % 60 == 0) wanted = height(random);
    const double y = z + noise * normal(random), u = gravity / lift + 0.25 * (wanted - y) - 0.2 * (y - before) / step;
    before = y;
    s.t.push_back(step * k);
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(y);
    for (int i = 0; i < 100; ++i) {
      v += fine * (lift * u - gravity - drag * v);
      z += fine * v;
    }
  }
  return s;
}

TEST(AControllerThatReadsTheNoise, IsNotTakenForSomethingThatIsMissing) {
  const auto systems = registry_with(hover_text);
  const ModelRequest request = request_of("text");
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<Signals> signals = {hover(seed)};
    const FilterEstimate estimate = estimate_filter(assemble(request, *systems), {}, signals);
    const Discovery found = discover({estimate, request, *systems, signals}, {});
    EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << "seed " << seed << ": " << found.verdict;
    const bool said = std::any_of(found.not_tried.begin(), found.not_tried.end(),
                                  [](const NotTried& n) { return n.place.effect == "feedthrough" && n.reason.find("input u moves") == 0; });
    EXPECT_TRUE(said) << "that it was not looked for";
  }
}

}  // namespace
}  // namespace misfit
