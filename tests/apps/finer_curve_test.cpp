// A stop as a curve of unknown form: its knots are moved together as long as that explains more, and nothing is put beside it for their
// sake.
#include <gmock/gmock.h>

#include <cstdio>
#include <string>

#include "tests/apps/program.h"
#include "tests/discover/slide.h"

namespace {

using namespace program;

class SlideWithAStop {
 public:
  SlideWithAStop() {
    const auto stop = [](double x) { return -150.0 * std::max(x - 0.063, 0.0); };
    const misfit::Signals s = misfit::testing_models::slide({.samples = 1000, .force = 6.0, .seed = 4}, stop);
    std::string rows = "t[s],F[N],x[m]\n";
    for (std::size_t i = 0; i < s.t.size(); ++i) {
      char row[96];
      std::snprintf(row, sizeof row, "%.3f,%.6f,%.7f\n", s.t[i], s.inputs[0].values[i], s.measured[0].values[i]);
      rows += row;
    }
    folder_.write("slide.csv", rows);
    folder_.write("model.toml", misfit::testing_models::slide_of_unknown_mass_text);
    folder_.write("study.toml", R"toml([study]
name = "slide"
question = "What does it lack?"
methods = ["filter_error"]
seed = 1
[system]
file = "model.toml"
[[experiment]]
name = "one"
data = "slide.csv"
validation = "last 25 %"
)toml");
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  TemporaryFolder folder_;
};

TEST(ACurveOfUnknownForm, HasAsManyKnotsAsAStopNeedsAndNoErrorOfTheSensorBesideIt) {
  const SlideWithAStop study;
  const Outcome outcome = run({"discover", study.path("study.toml").string(), "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::HasSubstr("unknown_force once more, with twice as many knots"));
  const json rungs = json::parse(content(study.path("out/ladder.json")));
  ASSERT_EQ(rungs.size(), 2U) << outcome.out << outcome.err;
  EXPECT_EQ(rungs[1].at("added"), "unknown_force");
  const json& estimates = rungs[1].at("estimates");
  for (const auto& [name, truth] : std::map<std::string, double>{{"gain", 0.5}, {"c", 4.0}}) {
    const double value = estimates.at(name).at("value"), sigma = estimates.at(name).at("sigma");
    EXPECT_NEAR(value, truth, 3.0 * sigma) << name;
    EXPECT_LT(sigma, 0.02 * truth) << name;
  }
}

}  // namespace
