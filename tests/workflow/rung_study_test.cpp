// The line that a new rung's study has of an effect that discovery found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include "misfit/workflow/ladder.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

/// The study of a rung with `found` on a flight with gravity, a static moment and a pitch damping.
std::string rung_with(const Candidate& found, const std::string& effects = "") {
  const TemporaryFolder folder;
  folder.write("d.csv", "t[s],P_y[px],P_z[px]\n0,100,200\n0.02,101,201\n0.04,102,202\n0.06,103,203\n0.08,104,204\n");
  folder.write("study.toml", std::string(R"toml([study]
name = "flight"
question = "What is missing?"
methods = ["filter_error"]
seed = 1
[system]
kind = "parachute_spherical"
[geometry]
D = "1.5816 m"
S = "1.9554 m^2"
R = "3.447 m"
R_cp = "3.15 m"
m = "0.206 kg"
m_a = "0.294 kg"
qbar = "736 Pa"
V = "35.1 m/s"
l_b = "5.69 m"
l_s = "5.61 m"
h_c = "0.1524 m"
K = "133.86 px/m"
[[experiment]]
name = "flight"
data = "d.csv"
[effects]
gravity = {}
static_moment = {}
pitch_damping = {}
)toml") + effects);
  Registry registry;
  misfit_models_register(registry);
  const Session session({.study = (folder.path() / "study.toml").string(), .out = (folder.path() / "out").string()}, registry);
  return study_with_effect(session, found.effect, found, folder.path());
}

/// Its number in discovery is C_n/sin(alpha_T), which is no start of C_n.
TEST(RungStudy, ACoefficientThatEntersOverASineIsACurveThere) {
  Candidate found;
  found.effect = "side_moment";
  found.actual_drop = 100.0;
  found.parameters["C_n"] = {0.0115, 0.002, "-"};
  EXPECT_THAT(rung_with(found), testing::HasSubstr("\nside_moment = {}\n"));
}

TEST(RungStudy, KnotsThatDiscoveryFoundAreInTheUnitThatIsShown) {
  Candidate found;
  found.effect = "unknown_force";
  found.roles = {{"of", "alpha_T"}, {"port", "lateral_moment"}};
  found.knots = {0.1, 0.2, 0.25};
  const std::string study = rung_with(found);
  EXPECT_THAT(study, testing::HasSubstr("unknown_force.of = \"alpha_T\"\n"));
  EXPECT_THAT(study, testing::HasSubstr("unknown_force.knots = [5.73, 11.46, 14.32]\n"))
      << "180/pi times as much, to a hundredth of 0.05 rad";
  found.knots = {};
  EXPECT_THAT(rung_with(found), testing::Not(testing::HasSubstr("knots")));
}

/// A coefficient of two effects has the names of both in front.
TEST(RungStudy, KnotsOfASecondCurveOfUnknownFormAreThoseOfItsOwn) {
  Candidate found;
  found.effect = "unknown_force";
  found.roles = {{"of", "alpha_T"}, {"port", "lateral_moment"}};
  found.knots = {0.1, 0.2, 0.25};
  EXPECT_THAT(rung_with(found, "unknown_force = { of = \"eta\", port = \"pitching_moment\" }\n"),
              testing::HasSubstr("\"unknown_force_2.unknown_force\".knots = [5.73, 11.46, 14.32]\n"));
}

}  // namespace
}  // namespace misfit
