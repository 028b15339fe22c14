// add and the ladder, on a short flight.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/apps/oscillator_study.h"
#include "tests/apps/short_flight.h"

namespace {

using namespace program;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line)) lines.push_back(line);
  return lines;
}

/// Lines of `after` that `before` does not have.
std::vector<std::string> new_lines(const std::string& before, const std::string& after) {
  const std::vector<std::string> old = lines_of(before);
  std::vector<std::string> out;
  for (const auto& line : lines_of(after)) {
    if (std::find(old.begin(), old.end(), line) == old.end()) out.push_back(line);
  }
  return out;
}

class Climbing : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    study = new ShortFlight("parachute_planar");
    coning = study->add("coning");
    spherical = study->add("system:parachute_spherical");
  }
  static void TearDownTestSuite() { delete study; }
  static inline ShortFlight* study = nullptr;
  static inline Outcome coning, spherical;
};

TEST_F(Climbing, AnEffectIsOneLineMoreAndThePathsStillLead) {
  ASSERT_EQ(coning.status, 0) << coning.err;
  const std::string text = content(study->out("rungs/01_coning/study.toml"));
  std::vector<std::string> differ = new_lines(content(study->path("study.toml")), text);
  std::erase_if(differ, [](const std::string& line) { return line.find("../../../") != std::string::npos; });
  EXPECT_EQ(differ, std::vector<std::string>{"coning = {}"});
  expect_parts(text, {"# Table 2: +-0.1 kg, read as 3 sigma", "sweep = \"../../../static_sweep.csv\"", "track = \"../../../track.csv\""});
  EXPECT_TRUE(fs::exists(study->out("rungs/01_coning/out/fit/filter_error/fit.json")));
}

TEST_F(Climbing, TheErrorBeforeAndAfterIsPrintedInItsUnit) {
  expect_parts(coning.out, {"Rung 1: coning added to parachute_planar", "before", "after", "RMS of eta, one sample ahead", "deg",
                            "held out", "random force", "N m", "Drop:", "actual", "gain of the held-out log-likelihood", "\nLadder\n"});
  expect_parts(spherical.out, {"Rung 2: system:parachute_spherical added to parachute_planar", "RMS of P_y, 32 samples ahead", "px",
                               "no drop", "effect 'coning' is left out"});
  expect_parts(spherical.err, {"continuing from rung 1"});
}

TEST_F(Climbing, TheLadderHoldsEveryRungWithTheKeysOfTheContract) {
  const json ladder = study->result("ladder.json");
  ASSERT_EQ(ladder.size(), 3U);
  for (const auto& rung : ladder) {
    for (const char* key :
         {"id", "parent", "study", "added", "predicted_drop", "actual_drop", "held_out_gain", "force", "rms", "validation_rms"})
      EXPECT_TRUE(rung.contains(key)) << key;
    EXPECT_TRUE(fs::exists(study->out(rung.at("study").get<std::string>()))) << rung.at("study");
  }
  EXPECT_EQ(ladder[1].at("parent"), 0);
  EXPECT_EQ(ladder[1].at("added"), "coning");
  EXPECT_GT(ladder[1].at("actual_drop").get<double>(), 50.0);  // 517 over the whole flight of `null`
  EXPECT_FALSE(ladder[1].at("held_out_gain").is_null());
  EXPECT_LT(ladder[1].at("k_step").at("eta").at(3).get<double>(), ladder[0].at("k_step").at("eta").at(3).get<double>());
  EXPECT_TRUE(ladder[2].at("actual_drop").is_null());
  EXPECT_EQ(ladder[2].at("rms").at("P_y").at("unit"), "px");
}

TEST_F(Climbing, AnotherSystemLeavesOutWhatDoesNotSuitItAsAComment) {
  const std::string text = content(study->out("rungs/02_parachute_spherical/study.toml"));
  expect_parts(text, {"kind = \"parachute_spherical\"", "# coning = {}  # does not suit parachute_spherical"});
}

TEST_F(Climbing, AnEffectWithoutStrengthIsAddedWithoutAPredictionAndThatIsSaid) {
  expect_parts(coning.out, {"no drop is predicted for coning: it has no coefficient that switches it off", "Rung 1: no drop is predicted"});
  EXPECT_FALSE(fs::exists(study->out("candidates.json"))) << "nothing was searched";
  const json rung = study->result("ladder.json").at(1);
  EXPECT_TRUE(rung.at("predicted_drop").is_null());
  expect_parts(rung.at("note").get<std::string>(), {"it has no coefficient that switches it off"});
}

TEST_F(Climbing, AddWritesTheReportAndItBeginsWithTheVerdictAndTheLadder) {
  expect_parts(spherical.err, {"report: ", "report.html"});
  const std::string page = content(study->out("report.html"));
  expect_parts(page, {"no drop is predicted for coning"});
  expect_parts(spherical.out, {"Verdict\n", "coning was missing",
                               "system:parachute_spherical was added, and no likelihood compares it with the model before"});
  const std::size_t verdict = page.find("<h2>Verdict</h2>"), ladder = page.find("id=\"ladder-gnuplot_canvas\"");
  ASSERT_NE(ladder, std::string::npos);
  EXPECT_LT(verdict, ladder);
  const std::string before = page.substr(verdict, ladder - verdict);
  EXPECT_NE(before.find("<h2>Ladder</h2>"), std::string::npos);
  const std::string drawn = "-gnuplot_canvas\"";
  EXPECT_EQ(before.find(drawn), before.rfind(drawn)) << "one picture before it";
}

TEST_F(Climbing, ARungIsAStudyThatRunsWhereItLies) {
  const Outcome outcome = program::run({"fit", study->out("rungs/01_coning").string(), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("filter_error").at("status"), "converged");
}

TEST(AddAfterAWholeSearch, TakesItsPredictionAndTheReportKeepsWhatWasFound) {
  const ShortFlight study("parachute_spherical", 12.0);
  ASSERT_EQ(study.run("diagnose").status, 0);
  ASSERT_EQ(study.run("discover").status, 0);
  const Outcome outcome = study.add("strut_wake");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::optional<double> predicted;
  for (const auto& candidate : study.result("candidates.json")) {
    if (candidate.at("effect") == "strut_wake") predicted = candidate.at("predicted_drop").get<double>();
  }
  EXPECT_EQ(study.result("ladder.json").at(1).at("predicted_drop").get<double>(), predicted);
  expect_parts(content(study.out("report.html")), {"<h2>Where it fails", "<h2>What could be missing", "own model (rung 0)"});
  fs::remove(study.out("report.html"));
  const Outcome from_elsewhere = program::run({"report", fs::relative(study.path("study.toml")).string()});
  ASSERT_EQ(from_elsewhere.status, 0) << from_elsewhere.err;
  expect_parts(content(study.out("report.html")), {"<h2>Where it fails", "<h2>What could be missing"});
}

struct Refusal {
  const char* name;
  const char* effect;
  std::vector<const char*> expected;
};

class WrongAddition : public testing::TestWithParam<Refusal> {};

TEST_P(WrongAddition, IsRefusedInWordsAndLeavesNoRung) {
  const ShortFlight study("parachute_spherical", 3.0);
  const Outcome outcome = study.add(GetParam().effect);
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_EQ(outcome.out, "");
  for (const char* part : GetParam().expected) expect_parts(outcome.err, {part});
  EXPECT_FALSE(fs::exists(study.out("rungs")));
  EXPECT_FALSE(fs::exists(study.out("ladder.json")));
}

INSTANTIATE_TEST_SUITE_P(EachKind, WrongAddition,
                         testing::Values(Refusal{"UnknownEffect", "strut_wkae", {"'strut_wkae'", "'strut_wake'"}},
                                         Refusal{"AlreadyThere", "pitch_damping", {"'pitch_damping'", "already in the model"}},
                                         Refusal{"PartOfTheSystem", "coning", {"'coning'", "by themselves"}},
                                         Refusal{"UnknownSystem", "system:parachute_spheric", {"'parachute_spherical'"}},
                                         Refusal{"SameSystem", "system:parachute_spherical", {"already 'parachute_spherical'"}}),
                         [](const auto& instance) { return instance.param.name; });

TEST(WrongAdditionAsAWhole, WithoutAnEffect) {
  const Outcome outcome = program::run({"add", "study.toml"});
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"effect"});
}

std::vector<std::string> added(const OscillatorStudy& study) {
  std::vector<std::string> out;
  for (const auto& rung : json::parse(content(study.path("out/ladder.json")))) out.push_back(rung.at("added"));
  return out;
}

TEST(ARemovedRung, IsOffTheLadderWithThoseAboveItAndWhatItComputedIsKept) {
  const OscillatorStudy study;
  const std::string file = study.path("study.toml").string();
  ASSERT_EQ(run({"add", file, "coulomb_friction"}).status, 0);
  ASSERT_EQ(run({"add", file, "cubic_stiffness"}).status, 0);
  const Outcome two = run({"remove", file, "coulomb_friction"});
  ASSERT_EQ(two.status, 0) << two.err;
  expect_parts(two.err, {"kept: ", "removed_01_coulomb_friction", "removed_02_cubic_stiffness"});
  EXPECT_EQ(added(study), std::vector<std::string>{""});
  EXPECT_TRUE(fs::exists(study.path("out/rungs/removed_01_coulomb_friction/out/fit/filter_error/fit.json")));
  EXPECT_EQ(content(study.path("out/report.html")).find("<h2>Ladder</h2>"), std::string::npos) << "one model is no ladder";
  ASSERT_EQ(run({"add", file, "coulomb_friction"}).status, 0);
  EXPECT_EQ(added(study), (std::vector<std::string>{"", "coulomb_friction"}));
  ASSERT_EQ(run({"remove", file, "1"}).status, 0);
  EXPECT_TRUE(fs::exists(study.path("out/rungs/removed_01_coulomb_friction_2/study.toml"))) << "the first one is still there";
}

TEST(ARemovedRung, MustBeOneThatWasAdded) {
  const OscillatorStudy study;
  const std::string file = study.path("study.toml").string();
  const auto refused = [&](const std::string& rung) {
    const Outcome outcome = run({"remove", file, rung});
    EXPECT_EQ(outcome.status, 2) << rung;
    return outcome.err;
  };
  expect_parts(refused("1"), {"nothing has been added to this study"});
  EXPECT_FALSE(fs::exists(study.path("out/ladder.json")));
  ASSERT_EQ(run({"add", file, "coulomb_friction"}).status, 0);
  expect_parts(refused("0"), {"rung 0 is the study's own model"});
  expect_parts(refused("coulomb_fricton"), {"rung coulomb_fricton: ", "did you mean 'coulomb_friction'"});
  EXPECT_THAT(refused("7"),
              testing::AllOf(testing::HasSubstr("rung 7: the ladder has no such rung"), testing::Not(testing::HasSubstr("0"))));
  EXPECT_EQ(added(study), (std::vector<std::string>{"", "coulomb_friction"}));
}

TEST(AnEffectAddedByHand, StaysThoughALaterOneMakesItNeedlessAndThatIsSaid) {
  const OscillatorStudy study;  // dry friction is missing; a spring that hardens imitates a little of it
  const std::string file = study.path("study.toml").string();
  ASSERT_EQ(run({"add", file, "cubic_stiffness"}).status, 0);
  const Outcome outcome = run({"discover", file, "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(added(study), (std::vector<std::string>{"", "cubic_stiffness", "coulomb_friction"}));
  expect_parts(outcome.err, {"cubic_stiffness is no longer significant beside what was added after it", "rung 1"});
}

TEST(AnEffectThatIsAdded, IsWhatDiscoveryFindsWhetherItHasBeenAskedOrNot) {
  const OscillatorStudy study;
  const std::string file = study.path("study.toml").string();
  const auto rung = [&](const std::string& out) { return json::parse(content(study.path(out + "/ladder.json"))).at(1); };
  ASSERT_EQ(run({"add", file, "coulomb_friction", "--out", study.path("by_hand").string()}).status, 0);
  ASSERT_EQ(run({"discover", file, "--auto", "--out", study.path("found").string()}).status, 0);
  const json by_hand = rung("by_hand"), found = rung("found");
  ASSERT_EQ(found.at("added"), "coulomb_friction");
  EXPECT_NEAR(by_hand.at("actual_drop").get<double>(), found.at("actual_drop").get<double>(), 0.1);
  ASSERT_EQ(by_hand.at("parameters").size(), found.at("parameters").size()) << "its width is estimated, too";
  for (const auto& [name, estimate] : found.at("parameters").items()) {
    const double value = estimate.at("value"), sigma = estimate.at("sigma");
    EXPECT_NEAR(by_hand.at("parameters").at(name).at("value").get<double>(), value, 0.1 * sigma) << name;
  }
}

struct CurvePoint {
  double x = 0.0, value = 0.0, sigma = 0.0;
};

/// Where it was visited: the columns are curve, quantity, value, sigma, count.
std::vector<CurvePoint> curve_in(const fs::path& file) {
  std::vector<CurvePoint> out;
  std::istringstream in(content(file));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    std::string curve;
    CurvePoint p;
    double count = 0.0;
    if (row >> curve >> p.x >> p.value >> p.sigma >> count && count >= 5.0) out.push_back(p);
  }
  return out;
}

/// No effect of the library is like it.
double sine_of_the_rate(double w) { return 0.6 * std::sin(5.0 * w); }

TEST(AForceOfUnknownForm, BecomesACurveOfItsQuantityBesideWhichWhatItCanTakeOverIsHeld) {
  const OscillatorStudy study;
  study.record_with(sine_of_the_rate);
  const std::string file = study.path("study.toml").string();
  const Outcome outcome = run({"discover", file, "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  ASSERT_EQ(added(study), (std::vector<std::string>{"", "unknown_force"})) << outcome.out << outcome.err;
  const json rung = json::parse(content(study.path("out/ladder.json"))).at(1);
  EXPECT_GT(rung.at("actual_drop").get<double>(), 100.0);
  EXPECT_GT(rung.at("held_out_gain").get<double>(), 0.0);
  EXPECT_THAT(rung.at("note").get<std::string>(), testing::HasSubstr("c is fixed"));
  const std::string folder = "out/rungs/01_unknown_force/";
  const std::string text = content(study.path(folder + "study.toml"));
  expect_parts(text, {"unknown_force = { of = \"w\", port = \"dw/dt\" }", "c.free = false"});
  EXPECT_THAT(text, testing::AllOf(testing::Not(testing::HasSubstr("k.free")), testing::Not(testing::HasSubstr("g.free"))));

  // The curve and the damping that is held are the damping and the force of the truth.
  const double held = std::stod(text.substr(text.find("c.value = ") + 10));
  int points = 0, within = 0;
  for (const CurvePoint& p : curve_in(study.path(folder + "out/fit/filter_error/curves.csv"))) {
    const double truth = sine_of_the_rate(p.x) - 0.2 * p.x + held * p.x;
    ++points;
    within += std::abs(p.value - truth) < 2.0 * p.sigma ? 1 : 0;
    EXPECT_NEAR(p.value, truth, 0.2) << "at " << p.x << " m/s";
  }
  EXPECT_GT(points, 20);
  EXPECT_GE(within, 0.8 * points);
}

/// Dry friction, and a force that no effect of the library is like.
double friction_and_a_sine_of_the_rate(double w) { return -std::tanh(w / 0.02) + 0.4 * std::sin(12.0 * w); }

TEST(AnEffectBesideWhichSomethingRemains, IsBegunWithAndCalledAPartOfWhatIsMissing) {
  const OscillatorStudy study;
  study.record_with(friction_and_a_sine_of_the_rate);
  const std::string file = study.path("study.toml").string();
  const Outcome outcome = run({"discover", file, "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(added(study), (std::vector<std::string>{"", "coulomb_friction", "unknown_force"})) << outcome.out << outcome.err;
  const json ladder = json::parse(content(study.path("out/ladder.json")));
  EXPECT_EQ(ladder.at(1).at("remained"), "an unknown curve dw/dt(w)");
  EXPECT_FALSE(ladder.at(2).contains("remained"));
  ASSERT_EQ(run({"remove", file, "unknown_force"}).status, 0);
  ASSERT_EQ(run({"discover", file}).status, 0);
  ASSERT_EQ(run({"report", file}).status, 0);
  EXPECT_THAT(json::parse(content(study.path("out/verdict.json"))).at("sentence").get<std::string>(),
              testing::StartsWith("coulomb_friction explains a part of what is missing"));
}

/// The force of the recording: 1.5 m/s^2 of dry friction, and 0.8 m/s^2 sin(5 s/m w), beside which it seems to be forced periodically.
TEST(OfTwoEffectsThatExplainAllBetweenThem, TheOneThatExplainsMoreByItselfIsNamed) {
  const OscillatorStudy study;
  study.write("d.csv", content(paths::source() / "tests/apps/records/friction_and_a_sine.csv"));
  const Outcome outcome = run({"discover", study.path("study.toml").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(content(study.path("out/candidates.json")));
  const auto drop_of = [](const json& candidate) {
    return candidate.at("actual_drop").is_null() ? 0.0 : candidate.at("actual_drop").get<double>();
  };
  ASSERT_TRUE(found.at(0).at("accepted").get<bool>()) << outcome.out;
  EXPECT_EQ(found.at(0).at("effect"), "coulomb_friction");
  EXPECT_THAT(found.at(0).at("why").get<std::string>(), testing::HasSubstr("periodic_forcing explains what remains"));
  EXPECT_FALSE(found.at(0).contains("remaining")) << "nothing remains beside both";
  for (const json& other : found) {  // or is no more than a part of itself: a range of the sensor of which 84 % is found
    if (other.at("effect") == "periodic_forcing") {
      EXPECT_LT(drop_of(other), drop_of(found.at(0)));
    }
    if (drop_of(other) > drop_of(found.at(0))) {
      EXPECT_THAT(other.at("why").get<std::string>(), testing::HasSubstr("only a part of it is found"));
    }
  }
}

TEST(APlaceOfAnEffect, IsTheOneThatIsAskedFor) {
  const OscillatorStudy study;
  study.measure_twice();
  const std::string file = study.path("study.toml").string();
  ASSERT_EQ(run({"discover", file}).status, 0);
  const Outcome wrong = run({"add", file, "bias", "--at", "output=y3"});
  EXPECT_EQ(wrong.status, 2);
  expect_parts(wrong.err, {"does not list bias there, but at --at ", "--at output=y2"});
  EXPECT_EQ(run({"add", file, "bias", "--at", "y2"}).status, 2);
  EXPECT_EQ(run({"add", file, "system:cascaded_tanks", "--at", "output=y2"}).status, 2);
  EXPECT_FALSE(fs::exists(study.path("out/rungs")));
  for (const char* output : {"y", "y2"}) {  // whichever explains more
    const Outcome right = run({"add", file, "bias", "--at", output == std::string("y2") ? "output=y2" : "default"});
    ASSERT_EQ(right.status, 0) << right.err;
  }
  expect_parts(content(study.path("out/rungs/02_bias/study.toml")), {"output = \"y2\""});
  EXPECT_EQ(content(study.path("out/rungs/01_bias/study.toml")).find("output = \"y2\""), std::string::npos);
}

TEST(LadderOfAStudyThatChanged, IsBegunAnew) {
  const ShortFlight study("parachute_planar", 10.0);
  ASSERT_EQ(study.add("system:parachute_spherical").status, 0);
  study.change("R_cp = \"3.15 m\"", "R_cp = \"3.16 m\"");
  const Outcome outcome = study.add("system:parachute_spherical");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.err, {"starting a new one"});
  EXPECT_EQ(study.result("ladder.json").size(), 2U);
}

/// A servo whose drive has a play of 0.05 rad, carried along within a fiftieth of a sample: 25 s at 35 Hz by Euler steps of a
/// two-hundredth.
std::string record_of_servo() {
  constexpr double step = 0.0286, play = 0.05, own_stiffness = 60.0, damping = 9.6;
  constexpr int samples = 875, parts = 200, held = 11;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::string text = "t[s],u[rad],q[rad]\n";
  double q = 0.0, rate = 0.0, behind = 0.0, u = 0.0;
  for (int i = 0; i < samples; ++i) {
    if (i % held == 0) u = 0.35 * normal(random);
    char line[80];
    std::snprintf(line, sizeof line, "%.6f,%.9g,%.9g\n", i * step, u, q + 0.003 * normal(random));
    text += line;
    behind = std::clamp(behind, u - play, u + play);
    for (int k = 0; k < parts; ++k) {
      rate += step / parts * (own_stiffness * (behind - q) - damping * rate);
      q += step / parts * rate;
    }
  }
  return text;
}

TEST(ARungWithAFastTime, IsComparedInStepsThatAreShortEnoughForIt) {
  const TemporaryFolder folder;
  folder.write("d.csv", record_of_servo());
  folder.write("m.toml", R"([states]
q = { unit = "rad", initial = "free" }
w = { unit = "rad/s", rate_of = "q", initial = "free" }
[inputs]
u = { unit = "rad", hold = "zero_order" }
[parameters]
k = { unit = "1/s^2", value = 50.0, bounds = [1.0, 1000.0], free = true }
c = { unit = "1/s", value = 8.0, bounds = [0.1, 100.0], free = true }
[equations]
w = "k*(u - q) - c*w"
[outputs]
q = { unit = "rad", noise = 0.004 }
)");
  folder.write("study.toml", R"([study]
name = "servo"
question = "What does it lack?"
methods = ["filter_error"]
[system]
file = "m.toml"
[[experiment]]
name = "steps"
data = "d.csv"
[effects]
)");
  const std::string at = folder.path().string();
  ASSERT_EQ(run({"fit", at}).status, 0);
  const Outcome added = run({"add", at, "backlash", "--at", "displacement=u"});
  ASSERT_EQ(added.status, 0) << added.err;
  const json ladder = json::parse(content(folder.path() / "out/ladder.json"));
  const auto loglik = [&](const std::string& out) {
    return json::parse(content(folder.path() / out / "fit/filter_error/fit.json")).at("loglik").get<double>();
  };
  const double of_fits = 2.0 * (loglik("out/rungs/01_backlash/out") - loglik("out"));
  EXPECT_GT(of_fits, 100.0);
  EXPECT_NEAR(ladder.at(1).at("actual_drop").get<double>(), of_fits, 0.1 * of_fits);
  expect_parts(added.out, {"backlash_tau is fixed at 0.00057"});
}

}  // namespace
