// discover --auto: goes on while something is accepted, and stops where the camera has to be seen to first.

#include <cmath>

#include "tests/apps/short_flight.h"

namespace {

using namespace program;

TEST(DiscoverAuto, ARolledCameraBelievedStraightIsNotAddedButCalibrated) {
  const StudyCopy study("camera_roll");
  study.write("study.toml", content(study.path("straight.toml")));
  const std::string track = content(study.path("track.csv"));
  constexpr std::size_t bytes = 25000;  // some ten seconds
  study.write("track.csv", track.substr(0, track.find('\n', bytes) + 1));
  const Outcome outcome = study.run("discover", {"--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"It is the camera, not the physics", "[\"camera_roll\"", "\nLadder\n"});
  EXPECT_EQ(study.result("ladder.json").size(), 1U) << outcome.out;
  for (const auto& candidate : study.result("candidates.json")) EXPECT_FALSE(candidate.at("accepted")) << candidate.at("effect");
  EXPECT_FALSE(study.result("discovery.json").at("sweep_asks").empty());
  EXPECT_TRUE(fs::exists(study.out("report.html")));
}

TEST(DiscoverAuto, AddsWhatIsAcceptedAndLooksAgain) {
  const ShortFlight study("parachute_spherical", 25.0);
  const Outcome outcome = study.run("discover", {"--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::printf("discover --auto on 25 s: %.1f s\n", outcome.seconds);
  const json ladder = study.result("ladder.json");
  ASSERT_GE(ladder.size(), 2U) << outcome.out;
  EXPECT_EQ(ladder[1].at("added"), "strut_wake");
  EXPECT_GT(ladder[1].at("actual_drop").get<double>(), 20.0);
  EXPECT_LT(ladder[1].at("force").at("moment_y").at("value").get<double>(), ladder[0].at("force").at("moment_y").at("value").get<double>());
  const fs::path last = study.out(ladder.back().at("study").get<std::string>()).parent_path() / "out";
  for (const auto& candidate : json::parse(content(last / "candidates.json")))
    EXPECT_FALSE(candidate.at("accepted")) << candidate.at("effect");
  expect_parts(content(study.out("report.html")), {"What could be missing", "What could be missing: rung"});
}

/// The planar model lacks a degree of freedom, which no effect describes: whatever follows some of it is not to be taken for it.
TEST(Discover, APlanarModelOfAConingFlightLacksWhatNoEffectIs) {
  const ShortFlight study("parachute_planar", 28.0);
  const Outcome outcome = study.run("discover");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t box = outcome.out.find("\nVerdict\n");
  ASSERT_NE(box, std::string::npos) << outcome.out;
  EXPECT_GT(box, outcome.out.find("predicted drop")) << "the table first, the answer last";
  expect_parts(outcome.out.substr(box), {"Something is missing that depends on", "random force", "report.html"});
  const std::string verdict = study.result("discovery.json").at("verdict");
  expect_parts(verdict, {"Something is missing that depends on", "a force on pitching_moment", "no effect of the library explains it"});
  for (const auto& candidate : study.result("candidates.json")) EXPECT_FALSE(candidate.at("accepted")) << candidate.at("effect");
}

TEST(TwoStudiesInOneFolder, DoNotShareARunFolderInSilence) {
  const ShortFlight study("parachute_spherical", 4.0);
  study.write("second.toml", content(study.path("study.toml")));
  ASSERT_EQ(study.run("calibrate").status, 0);
  const Outcome refused = program::run({"calibrate", study.path("second.toml").string()});
  EXPECT_EQ(refused.status, 2);
  expect_parts(refused.err, {"holds the results of another study", "study.toml", "--out out-second"});
  EXPECT_EQ(program::run({"calibrate", study.path("second.toml").string(), "--out", study.path("out-second").string()}).status, 0);
}

}  // namespace
