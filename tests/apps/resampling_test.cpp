// Block bootstrap, profiles and random starts of [uncertainty], as a user runs them.

#include <algorithm>

#include "tests/apps/on_ranks.h"
#include "tests/apps/short_flight.h"

namespace {

using namespace program;
using Words = std::vector<std::string>;

/// The first seconds of configs/validation with a small forcing of known frequency: two parameters that a profile can be taken of.
class ForcedMotion : public ShortValidation {
 public:
  explicit ForcedMotion(const std::string& uncertainty) : ShortValidation(700) {
    change("pitch_damping = \\{\\}",
           "pitch_damping = {}\nperiodic_forcing = {}\n\n[parameters]\nfrequency = { free = false, value = \"1.3 Hz\" }");
    change("perturb = .*", uncertainty);
  }
  void methods(const std::string& list) const { change("methods = .*", "methods = " + list); }
  [[nodiscard]] json bootstrap(std::size_t k) const { return result("bootstrap.json").at(k); }
};

TEST(Resampling, OfEveryMethodThatCanBeFittedAgain) {
  const ForcedMotion study("bootstrap = 20\nblock = 40\nprofile = [\"cosine\", \"sine\"]");
  const Outcome outcome = study.uncertainty({});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"sliding_bin is not resampled", "block bootstrap of", "equation_error: 20 runs", "blocks of 40 samples",
                             "output_error: 20 runs", "profile likelihood of", "\n  cosine  ", "\n  sine  "});
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(study.bootstrap(k).at("failed"), 0);
    EXPECT_EQ(study.bootstrap(k).at("block_samples"), 40);
    const json bootstrap = study.bootstrap(k);
    for (const json& number : bootstrap.at("numbers")) {
      if (number.at("name") != "trim") continue;
      EXPECT_NEAR(number.at("value").get<double>(), 12.0 * 0.0174533, 0.005);
      EXPECT_GT(number.at("sigma").get<double>(), 0.0);
      EXPECT_LT(number.at("sigma").get<double>(), 0.005);
    }
  }
  const json profiles = study.result("profile.json");
  ASSERT_EQ(profiles.size(), 2U);
  for (const json& p : profiles) {
    EXPECT_LT(p.at("interval_95")[0].get<double>(), p.at("best").get<double>());
    EXPECT_GT(p.at("interval_95")[1].get<double>(), p.at("best").get<double>());
    EXPECT_TRUE(p.at("interval_found")[0] && p.at("interval_found")[1]);
  }
  for (const char* file : {"bootstrap_C_m.svg", "bootstrap_C_m.csv", "bootstrap_C_m.gp", "profile_output_error_cosine.svg"})
    EXPECT_TRUE(fs::exists(study.out("figures") / file)) << file;
  const json outputs = study.result("run.json").at("stages").at("resampling").at("outputs");
  for (const char* file : {"bootstrap.json", "profile.json", "figures/bootstrap_C_m.csv", "figures/bootstrap_C_m.gp"})
    EXPECT_NE(std::find(outputs.begin(), outputs.end(), file), outputs.end()) << file;
  const auto when = fs::last_write_time(study.out("bootstrap.json"));
  EXPECT_EQ(study.uncertainty({}).out, outcome.out);
  EXPECT_EQ(fs::last_write_time(study.out("bootstrap.json")), when) << "done once";
  const json printed = json::parse(study.uncertainty({"--json"}).out);
  EXPECT_EQ(printed.size(), 2U);
  EXPECT_EQ(printed.at("bootstrap"), study.result("bootstrap.json"));
  EXPECT_EQ(printed.at("profile"), profiles);

  ASSERT_EQ(study.run("report").status, 0);
  expect_parts(content(study.out("report.html")), {"Bootstrap, profile likelihood and random starts", "Block bootstrap: C_m",
                                                   "Profile likelihood: cosine", "sliding_bin is not resampled"});
  EXPECT_EQ(study.uncertainty({}).out, outcome.out);
  EXPECT_EQ(fs::last_write_time(study.out("bootstrap.json")), when) << "the report has drawn the figures again";
}

TEST(Resampling, MoreRunsGoOnFromThoseThatAreThere) {
  const ForcedMotion study("bootstrap = 6\nblock = 40");
  study.methods("[\"equation_error\"]");
  ASSERT_EQ(study.uncertainty({}).status, 0);
  const fs::path stored = study.out("bootstrap_equation_error") / "checkpoint_0.bin";
  const std::string before = content(stored);
  study.change("bootstrap = 6", "bootstrap = 9  # more of them");
  study.change("question = .*", "question = \"And now?\"");
  const Outcome more = study.uncertainty({});
  ASSERT_EQ(more.status, 0) << more.err;
  expect_parts(more.out, {"equation_error: 9 runs"});
  const std::string after = content(stored);
  ASSERT_GT(after.size(), before.size());
  EXPECT_EQ(after.substr(0, before.size()), before) << "the first six were not done again";
}

TEST(Resampling, OfAWrongNameIsRefusedBeforeAnythingIsComputed) {
  const ForcedMotion study("bootstrap = 20\nprofile = [\"sine\", \"cosin\"]");
  const auto refused = [&](std::initializer_list<const char*> expected) {
    const Outcome outcome = study.uncertainty({});
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    expect_parts(outcome.err, expected);
    EXPECT_FALSE(fs::exists(study.out("bootstrap_equation_error")));
  };
  refused({"study.toml:", "'cosin'", "did you mean 'cosine'"});
  study.change("\"cosin\"", "\"frequency\"");
  refused({"study.toml:", "'frequency' is fixed in this study"});
  study.change("\"frequency\"", "\"C_m[2]\"");
  refused({"study.toml:", "'C_m[2]' is a coefficient of a curve"});
  study.methods("[\"equation_error\"]");
  refused({"study.toml:", "equation_error has no likelihood", "output_error and filter_error"});
}

TEST(Resampling, RandomStartsEndWhereTheFitDid) {
  const ForcedMotion study("starts = 6");
  const Outcome outcome = study.uncertainty({});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"random starts of  starts  reach the reported maximum  a lower one  a higher one  not converged",
                             "output_error           6                           6            0             0              0"});
  const json starts = study.result("starts.json").at(0);
  EXPECT_EQ(starts.at("drop").size(), 6U);
  for (const json& number : starts.at("numbers"))
    EXPECT_NEAR(number.at("best").get<double>(), number.at("value").get<double>(), number.at("sigma").get<double>()) << number.at("name");
  EXPECT_TRUE(fs::exists(study.out("figures") / "starts_output_error.svg"));
  ASSERT_EQ(study.run("report").status, 0);
  expect_parts(content(study.out("report.html")), {"random starts of", "Random starts: output_error"});
  study.change("starts = 6", "starts = 0");
  const Outcome none = study.uncertainty({});
  EXPECT_EQ(none.status, 2);
  expect_parts(none.err, {"study.toml:", "starts", "1"});
}

/// The flight of the paper is driven: output_error declines, which takes nothing from the others.
TEST(Resampling, AMethodThatDeclinesIsNamedAndTheOthersGoOn) {
  const ShortFlight flight("parachute_planar", 20.0);
  flight.change("methods = .*", "methods = [\"equation_error\", \"output_error\"]");
  flight.change("perturb = .*", "bootstrap = 5");
  const Outcome outcome = flight.run("uncertainty");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"block bootstrap of", "equation_error: 5 runs", "output_error is not resampled: declined"});
  EXPECT_EQ(flight.result("bootstrap.json").size(), 1U);
  const Outcome alone = flight.run("uncertainty", {"--method", "output_error"});
  EXPECT_EQ(alone.status, 1);
  expect_parts(alone.err, {"no method asked for could be resampled", "output_error is not resampled: declined"});
}

TEST(Resampling, ABlockThatIsCutIsSaid) {
  const ForcedMotion study("bootstrap = 4\nblock = 500");
  study.methods("[\"equation_error\"]");
  const Outcome outcome = study.uncertainty({});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"asks for blocks of 500", "they are cut"});
  expect_parts(study.bootstrap(0).at("notes").at(0).get<std::string>(), {"asks for blocks of 500 samples", "cut to 87"});
}

class ResamplingBits : public testing::Test {
 protected:
  ResamplingBits() { study_.methods("[\"output_error\"]"); }
  [[nodiscard]] Words words(const std::string& out, const char* threads = "1") const {
    return {"uncertainty", study_.path("study.toml").string(), "--out", study_.path(out).string(), "--threads", threads};
  }
  void expect_same(const std::string& a, const std::string& b) const {
    for (const char* file : {"bootstrap.json", "bootstrap.csv", "profile.json", "starts.json"})
      EXPECT_EQ(content(study_.path(a) / file), content(study_.path(b) / file)) << b << "/" << file;
  }
  const ForcedMotion study_{"bootstrap = 20\nprofile = [\"cosine\", \"sine\"]\nstarts = 10"};
};

TEST_F(ResamplingBits, AreThoseOfOneRunHoweverOftenItIsKilled) {
  ASSERT_EQ(program::run(words("whole")).status, 0);
  int among_the_jobs = 0;
  for (const char* stage : {"bootstrap_output_error", "profile_output_error", "starts_output_error"}) {
    const fs::path whole = study_.path("whole") / stage / "checkpoint_0.bin", file = study_.path("killed") / stage / "checkpoint_0.bin";
    const std::uintmax_t head = checkpoint_head(whole);
    std::uintmax_t stored = head;
    for (const char* threads : {"1", "2"}) {
      const std::uintmax_t size = killed_at(words("killed", threads), file, stored);
      EXPECT_GT(size, head) << stage;
      among_the_jobs += size > head && size < size_of(whole) ? 1 : 0;
      stored = std::max(stored, size);
    }
  }
  EXPECT_GE(among_the_jobs, 3) << "too few kills fell among the jobs";
  ASSERT_EQ(program::run(words("killed", "2")).status, 0);
  expect_same("whole", "killed");
}

using ResamplingBitsUnderMpi = UnderMpi<ResamplingBits>;

TEST_F(ResamplingBitsUnderMpi, AreTheSameOnRanks) {
  const Outcome alone = program::run(words("alone"));
  ASSERT_EQ(alone.status, 0) << alone.err;
  for (const int ranks : {2, 3}) {
    const std::string name = "ranks" + std::to_string(ranks);
    const Outcome outcome = on_ranks(ranks, words(name));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, alone.out) << "one rank speaks";
    expect_same("alone", name);
    const std::string last = "checkpoint_" + std::to_string(ranks - 1) + ".bin";
    for (const char* stage : {"bootstrap_output_error", "profile_output_error", "starts_output_error"})
      EXPECT_TRUE(fs::exists(study_.path(name) / stage / last)) << stage << ": the last rank has done its share";
  }
}

}  // namespace
