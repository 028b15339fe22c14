// A kink as a curve of unknown form: its knots are moved together as long as that explains more.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "tests/apps/program.h"

namespace {

using namespace program;

/// A tank that a pump fills and a pipe drains, h' = 0.05 u - 0.1 h, and a float valve that opens below 0.437 m and lets in 0.4 (0.437 m -
/// h). By Euler steps of 5 ms, which share nothing with sim/.
std::string recording() {
  constexpr double step = 0.5, fine = 0.005;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  std::string rows = "t[s],u[V],h[m]\n";
  double h = 0.5, u = 0.0;
  for (int i = 0; i < 500; ++i) {
    if (i % 20 == 0) u = uniform(random);
    char row[96];
    std::snprintf(row, sizeof row, "%.1f,%.6f,%.7f\n", i * step, u, h + 2e-4 * normal(random));
    rows += row;
    for (int k = 0; k < 100; ++k) h += fine * (0.05 * u - 0.1 * h + 0.4 * std::max(0.437 - h, 0.0));
  }
  return rows;
}

class TankWithAValve {
 public:
  TankWithAValve() {
    folder_.write("tank.csv", recording());
    folder_.write("model.toml", R"toml([system]
doc = "a tank"
[states]
h = { unit = "m", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
g = { unit = "m/s/V", value = 0.1, free = true }
c = { unit = "1/s", value = 0.2, free = true }
[equations]
h = "g*u - c*h"
[outputs]
h = { unit = "m", noise = 2e-4 }
)toml");
    folder_.write("study.toml", R"toml([study]
name = "tank"
question = "What does it lack?"
methods = ["filter_error"]
seed = 1
[system]
file = "model.toml"
[[experiment]]
name = "one"
data = "tank.csv"
validation = "last 25 %"
)toml");
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  TemporaryFolder folder_;
};

TEST(ACurveOfUnknownForm, HasAsManyKnotsAsAKinkNeeds) {
  const TankWithAValve study;
  const Outcome outcome = run({"discover", study.path("study.toml").string(), "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::HasSubstr("unknown_force once more, with twice as many knots"));
  const json rungs = json::parse(content(study.path("out/ladder.json")));
  ASSERT_EQ(rungs.size(), 2U) << outcome.out << outcome.err;
  EXPECT_EQ(rungs[1].at("added"), "unknown_force");
  const json& gain = rungs[1].at("estimates").at("g");
  const double value = gain.at("value"), sigma = gain.at("sigma");
  EXPECT_NEAR(value, 0.05, 3.0 * sigma);
  EXPECT_LT(sigma, 0.001);
}

}  // namespace
