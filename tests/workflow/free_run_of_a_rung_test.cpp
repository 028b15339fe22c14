// What is added is also judged by the free run, where the study asks for output_error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

#include "misfit/workflow/ladder.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* model = R"toml([system]
doc = "first order"
source = "test"
[states]
x = { unit = "m", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 0.8, free = true, bounds = [0.01, 100.0] }
gain = { unit = "m/V", value = 0.9, free = true }
[equations]
x = "(gain*u - x)/tau"
[outputs]
y = { unit = "m", formula = "x", noise = 0.01 }
)toml";

/// 60 s of a first order that a switched input drives, as the sensor reads it: `sensor(t, x)`.
std::string recording(const std::function<double(double, double)>& sensor) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::string rows = "t[s],u[V],y[m]\n";
  double x = 0.0;
  for (int k = 0; k < 1200; ++k) {
    const double t = 0.05 * k, u = k / 60 % 2 == 0 ? 1.0 : -0.5;
    char row[96];
    std::snprintf(row, sizeof row, "%.2f,%g,%.5f\n", t, u, sensor(t, x) + noise(random));
    rows += row;
    x += (u - x) * (1.0 - std::exp(-0.05));
  }
  return rows;
}

/// Of a ladder with one rung: why its free run is worse, or better, than that of the study's own model.
struct Judged {
  std::string worse, better;
};

Judged judged(const std::string& data, const std::string& effect, const std::string& methods) {
  const TemporaryFolder folder;
  folder.write("m.toml", model);
  folder.write("d.csv", data);
  const std::filesystem::path study =
      folder.write("study.toml", "[study]\nname = \"text\"\nquestion = \"What is missing?\"\nmethods = [" + methods +
                                     "]\nseed = 1\n[system]\nfile = \"m.toml\"\n[[experiment]]\nname = \"one\"\ndata = \"d.csv\"\n"
                                     "validation = \"last 25 %\"\n[effects]\n");
  Registry registry;
  misfit_models_register(registry);
  ModelLadder ladder({.study = study.string(), .out = (folder.path() / "out").string()}, registry);
  EXPECT_EQ(ladder.why_free_run_is_worse(), "") << "nothing was added";
  EXPECT_EQ(ladder.why_free_run_is_better(), "");
  ladder.add(effect, std::nullopt);
  return {ladder.why_free_run_is_worse(), ladder.why_free_run_is_better()};
}

double with_offset(double, double x) { return x + 0.3; }
/// Its scale grows until 45 s, where the held-out part begins, and is then what it was at first.
double fading_until_held_out(double t, double x) { return x * (t < 45.0 ? 1.0 + 0.02 * t : 1.0); }

TEST(FreeRunOfARung, IsBetterWithWhatWasMissing) {
  const Judged bias = judged(recording(with_offset), "bias", "\"output_error\"");
  EXPECT_EQ(bias.worse, "");
  EXPECT_THAT(bias.better, AllOf(StartsWith("the errors of the free run fall by 9"), HasSubstr("of what is held out by 9")));
}

TEST(FreeRunOfARung, IsWorseWhereWhatIsHeldOutIsSimulatedWorse) {
  const Judged fading = judged(recording(fading_until_held_out), "sensor_fading", "\"output_error\"");
  EXPECT_THAT(fading.worse, StartsWith("of what is held out, the errors of the free run grow by "));
  EXPECT_EQ(fading.better, "") << "though those of what is fitted fall";
}

TEST(FreeRunOfARung, IsAskedForByTheStudy) {
  const Judged fading = judged(recording(fading_until_held_out), "sensor_fading", "\"filter_error\"");
  EXPECT_EQ(fading.worse, "");
  EXPECT_EQ(fading.better, "");
}

TEST(FreeRunOfARung, SaysNothingWhereTheModelBelowDoesNotFollowTheMotion) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  double push = 0.0;
  const std::string driven = recording([&](double, double x) {
    push += 0.4 * noise(random) - 0.05 * push;
    return x + push;
  });
  const Judged fading = judged(driven, "sensor_fading", "\"output_error\"");
  EXPECT_EQ(fading.worse, "");
  EXPECT_EQ(fading.better, "");
}

}  // namespace
}  // namespace misfit
