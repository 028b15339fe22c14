// What hostile input, a full disk behind standard output and little memory do to the program: one sentence and a status, nothing else.

#include <sys/resource.h>

#include <cmath>

#include "misfit/core/table.h"
#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;

/// A declared system of first order with a short recording, in a folder of its own.
class Tank {
 public:
  Tank() {
    write("m.toml",
          "[states]\nx = { unit = \"V\", initial = \"free\" }\n[inputs]\nu = { unit = \"V\" }\n[parameters]\n"
          "a = { unit = \"1/s\", value = 1, free = true, bounds = [0, 10] }\nb = { unit = \"1/s\", value = 1, free = true, bounds = [0, "
          "10] }\n"
          "[equations]\nx = \"-a*x + b*u\"\n[outputs]\ny = { formula = \"x\", unit = \"V\" }\n");
    write("study.toml", study);
    std::string rows = "t[s],u[V],y[V]\n";
    double x = 1.0;
    for (int i = 0; i < 100; ++i) {
      const double u = std::sin(0.3 * i);
      rows += std::to_string(0.1 * i) + "," + std::to_string(u) + "," + std::to_string(x) + "\n";
      x += 0.1 * (-0.8 * x + 1.2 * u);
    }
    write("d.csv", rows);
  }

  static constexpr const char* study =
      "[study]\nmethods = [\"output_error\"]\n[system]\nfile = \"m.toml\"\n[[experiment]]\ndata = \"d.csv\"\n";

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] Outcome run(
      const std::string& verb, const std::vector<std::string>& options = {}, const std::function<void()>& before = [] {}) const {
    std::vector<std::string> arguments{verb, path("study.toml").string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return program::run(arguments, before);
  }

 private:
  TemporaryFolder folder_;
};

/// One message on stderr, of at most 300 characters and a line end.
void expect_one_message(const Outcome& outcome) {
  const auto characters = std::count_if(outcome.err.begin(), outcome.err.end(), [](char c) { return (c & '\xC0') != '\x80'; });
  EXPECT_LE(characters, 301) << outcome.err.substr(0, 600);
  EXPECT_TRUE(outcome.err.starts_with("misfit: ")) << outcome.err.substr(0, 600);
}

bool has_control(const std::string& text) {
  const auto control = [](char c) { return (c >= '\0' && c < ' ' && c != '\n' && c != '\t') || c == '\x7f'; };
  return std::any_of(text.begin(), text.end(), control) || text.find("\xC2\x9B") != std::string::npos;
}

void output_to_a_full_disk() { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); }

struct Printed {
  const char* name;
  std::vector<std::string> options;  ///< verb first
};

void PrintTo(const Printed& printed, std::ostream* out) { *out << printed.name; }

class FullOutput : public testing::TestWithParam<Printed> {};

TEST_P(FullOutput, EndsWithOneAndAWord) {
  const Tank tank;
  std::vector<std::string> options = GetParam().options;
  const std::string verb = options.front();
  options.erase(options.begin());
  const bool alone = verb.starts_with("--") || verb == "init" || verb == "effects";
  if (verb == "init") options = {tank.path("d.csv").string(), "--out", tank.path("made").string()};
  options.insert(options.begin(), verb);
  const Outcome outcome =
      alone ? run(options, output_to_a_full_disk) : tank.run(verb, {options.begin() + 1, options.end()}, output_to_a_full_disk);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  expect_parts(outcome.err, {"misfit: standard output could not be written", "No space left"});
}

INSTANTIATE_TEST_SUITE_P(EachVerb, FullOutput,
                         testing::Values(Printed{"Fit", {"fit", "--quiet"}}, Printed{"FitAsJson", {"fit", "--quiet", "--json"}},
                                         Printed{"Run", {"run", "--quiet"}}, Printed{"RunAsJson", {"run", "--quiet", "--json"}},
                                         Printed{"Compare", {"compare", "--quiet"}}, Printed{"Simulate", {"simulate", "--quiet"}},
                                         Printed{"Report", {"report", "--quiet"}}, Printed{"Open", {"open"}},
                                         Printed{"Effects", {"effects"}}, Printed{"Init", {"init"}}, Printed{"Version", {"--version"}},
                                         Printed{"Help", {"--help"}}),
                         [](const auto& instance) { return instance.param.name; });

TEST(FullOutputOfAFit, LeavesTheResultsInFiles) {
  const Tank tank;
  EXPECT_EQ(tank.run("fit", {}, output_to_a_full_disk).status, 1);
  EXPECT_GT(json::parse(content(tank.path("out/fit/output_error/fit.json"))).size(), 3U);
}

TEST(ClosedOutput, IsSaidAndNeverLandsInAFile) {
  const Tank tank;
  const Outcome outcome = tank.run("fit", {"--json"}, [] { ::close(STDOUT_FILENO); });
  EXPECT_EQ(outcome.status, 1);
  expect_parts(outcome.err, {"standard output could not be written"});
  EXPECT_TRUE(json::accept(content(tank.path("out/fit/output_error/fit.json"))));
  EXPECT_EQ(tank.run("fit", {},
                     [] {
                       ::close(STDIN_FILENO);
                       ::close(STDERR_FILENO);
                     })
                .status,
            0);
}

struct Steering {
  const char* name;
  const char* file;
  const char* what;
  std::string by;
};

void PrintTo(const Steering& steering, std::ostream* out) { *out << steering.name; }

class SteeringText : public testing::TestWithParam<Steering> {};

TEST_P(SteeringText, ReachesNoTerminal) {
  const Tank tank;
  std::string text = content(tank.path(GetParam().file));
  const auto at = text.find(GetParam().what);
  ASSERT_NE(at, std::string::npos);
  tank.write(GetParam().file, text.replace(at, std::string(GetParam().what).size(), GetParam().by));
  for (const char* verb : {"fit", "run", "simulate", "effects"}) {
    for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--json"}}) {
      const Outcome outcome = tank.run(verb, options);
      EXPECT_TRUE(outcome.status >= 0 && outcome.status <= 2) << verb;
      EXPECT_FALSE(has_control(outcome.out)) << verb << outcome.out;
      EXPECT_FALSE(has_control(outcome.err)) << verb << outcome.err;
      const bool as_json = outcome.status == 0 && !options.empty();
      EXPECT_TRUE(!as_json || json::accept(outcome.out)) << verb << outcome.out;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    EachPlace, SteeringText,
    testing::Values(Steering{"StudyName", "study.toml", "[study]\n", "[study]\nname = \"a\\u001b[2J\\u0000\\u0007\\u009b\\u007f\"\n"},
                    Steering{"Question", "study.toml", "[study]\n", "[study]\nquestion = \"a\\u001b[2J\\u0000\\u0007\\u009b\\u007f\"\n"},
                    Steering{"ExperimentName", "study.toml", "[[experiment]]\n", "[[experiment]]\nname = \"a\\u001b[2J\\u009b\"\n"},
                    Steering{"Doc", "m.toml", "value = 1", "doc = \"a\\u001b[2J\\u009b\", value = 1"},
                    Steering{"DocOfTheSystem", "m.toml", "[states]",
                             "[system]\ndoc = \"\\u001b[2J\\u009b\"\nsource = \"\\u0007\"\n[states]"},
                    Steering{"Header", "d.csv", "y[V]", "y[V],z\x1b[2J\xC2\x9B"}, Steering{"MissingColumn", "d.csv", "y[V]", "y\x1b[2J[V]"},
                    Steering{"Unit", "d.csv", "y[V]", "y[\x1b]"}, Steering{"Field", "d.csv", "\n0", "\n\x1b[2J"},
                    Steering{"FileName", "study.toml", "d.csv", "\\u001b[2J\\u009b.csv"}),
    [](const auto& instance) { return instance.param.name; });

struct Typed {
  const char* name;
  std::vector<std::string> options;
  std::vector<const char*> expected;
};

void PrintTo(const Typed& typed, std::ostream* out) { *out << typed.name; }

class HostileCommandLine : public testing::TestWithParam<Typed> {};

TEST_P(HostileCommandLine, IsRefusedInOneMessage) {
  const Tank tank;
  const Outcome outcome = tank.run("fit", GetParam().options);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  expect_one_message(outcome);
  EXPECT_FALSE(has_control(outcome.err)) << outcome.err;
  for (const char* part : GetParam().expected) expect_parts(outcome.err, {part});
  EXPECT_FALSE(fs::exists(tank.path("out")));
}

INSTANTIATE_TEST_SUITE_P(EachWord, HostileCommandLine,
                         testing::Values(Typed{"SeedBeyond64Bits",
                                               {"--seed", "99999999999999999999"},
                                               {"--seed", "99999999999999999999", "9223372036854775807"}},
                                         Typed{"SeedBeyond63Bits", {"--seed", "9223372036854775808"}, {"--seed", "9223372036854775807"}},
                                         Typed{"SeedInHex", {"--seed", "0x10"}, {"--seed", "'0x10'"}},
                                         Typed{"SeedAsFloat", {"--seed", "1e3"}, {"'1e3'"}}, Typed{"SeedEmpty", {"--seed", ""}, {"--seed"}},
                                         Typed{"SeedNegative", {"--seed=-1"}, {"--seed", "'-1'"}},
                                         Typed{"SeedOfManyDigits", {"--seed", std::string(100'000, '9')}, {"--seed", "…"}},
                                         Typed{"ThreadsBeyond64Bits", {"--threads", "99999999999999999999"}, {"--threads", "1024"}},
                                         Typed{"LongMethod", {"--method", std::string(100'000, 'x')}, {"--method"}},
                                         Typed{"LongOption", {"--" + std::string(100'000, 'x')}, {"has no option", "valid: --help"}},
                                         Typed{"OptionThatSteers", {"--\x1b[2J"}, {"--\\x1b[2J"}},
                                         Typed{"ManyArguments", std::vector<std::string>(1000, "x"), {"not expected"}}),
                         [](const auto& instance) { return instance.param.name; });

struct Listed {
  const char* name;
  std::string list;
  std::vector<const char*> expected;
};

void PrintTo(const Listed& listed, std::ostream* out) { *out << listed.name; }

class HostileList : public testing::TestWithParam<Listed> {};

TEST_P(HostileList, IsRefusedInOneMessage) {
  const TemporaryFolder folder;
  const Outcome outcome = run({"batch", folder.write("list.txt", GetParam().list).string()});
  EXPECT_EQ(outcome.status, 2);
  expect_one_message(outcome);
  EXPECT_FALSE(has_control(outcome.err)) << outcome.err;
  for (const char* part : GetParam().expected) expect_parts(outcome.err, {part});
}

INSTANTIATE_TEST_SUITE_P(EachLine, HostileList,
                         testing::Values(Listed{"Nul", std::string("a\0b.toml\n", 9), {"list.txt:1", "'a\\x00b.toml'", "NUL"}},
                                         Listed{"LongLine", "\n" + std::string(1'000'000, 'x') + "\n", {"list.txt:2", "…"}},
                                         Listed{"Escape", "\x1b[2J\n", {"list.txt:1", "'\\x1b[2J'"}}, Listed{"Empty", "", {"list.txt"}},
                                         Listed{"OnlyComments", "# a\n#b\n", {"list.txt", "names no study"}}),
                         [](const auto& instance) { return instance.param.name; });

TEST(LongPath, IsRefusedInOneMessage) {
  for (const char* verb : {"fit", "run", "batch", "init", "effects"}) {
    const Outcome outcome = run({verb, std::string(100'000, 'x')});
    EXPECT_EQ(outcome.status, 2) << verb << outcome.err.substr(0, 300);
    expect_one_message(outcome);
    EXPECT_EQ(outcome.err.find("filesystem error"), std::string::npos) << outcome.err;
  }
}

TEST(Seed, TheLargestIsTaken) {
  const Tank tank;
  EXPECT_EQ(tank.run("fit", {"--seed", "9223372036854775807"}).status, 0);
  expect_parts(content(tank.path("out/resolved.toml")), {"9223372036854775807"});
}

TEST(LongName, OfAnEffectToAddIsShortened) {
  const Tank tank;
  const Outcome outcome = tank.run("add", {std::string(100'000, 'x')});
  EXPECT_EQ(outcome.status, 2);
  expect_one_message(outcome);
  expect_parts(outcome.err, {"unknown effect 'xxx", "…"});
}

TEST(Simulate, NoiseOfNoOutputIsRefused) {
  const Tank tank;
  tank.write("study.toml", std::string(Tank::study) + "[simulate]\nnoise = { yy = 1 }\n");
  const Outcome outcome = tank.run("simulate");
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"study.toml:8", "no output 'yy'", "did you mean 'y'?"});
  EXPECT_FALSE(fs::exists(tank.path("out/simulation.csv")));
}

TEST(Simulate, NoiseBeyondTheFiniteNumbersIsRefused) {
  const Tank tank;
  tank.write("study.toml", std::string(Tank::study) + "[simulate]\nduration = 100\nstep = 0.1\nnoise = { y = 1e308 }\n");
  const Outcome outcome = tank.run("simulate");
  EXPECT_EQ(outcome.status, 1);
  expect_parts(outcome.err, {"output y", "finite"});
}

/// x' = -x + u from 1 without an input: exp(-t), measured to half a step, with what it was beside.
TEST(Simulate, AnOutputInWholeStepsIsRounded) {
  const Tank tank;
  tank.write("study.toml", std::string(Tank::study) +
                               "[effects.sensor_quantisation]\noutput = \"y\"\nstart = { rounded = 1, step = 0.25, level = 0.1 }\n"
                               "fixed = [\"rounded\", \"step\", \"level\"]\n[simulate]\nduration = 2\nstep = 0.1\ninitial = { x = 1.0 }\n");
  const Outcome outcome = tank.run("simulate");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const misfit::Table made = misfit::read_csv(tank.path("out/simulation.csv"));
  const std::vector<double> t = made.values("t", "s"), y = made.values("y", "V"), truth = made.values("y_true", "V");
  ASSERT_EQ(t.size(), 21U);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(truth[k], std::exp(-t[k]), 1e-6);
    EXPECT_NEAR(y[k], 0.1 + 0.25 * std::round((truth[k] - 0.1) / 0.25), 1e-9);
  }
}

/// Where memory ends depends on the moment; how it is said does not.
TEST(LittleMemory, IsSaidInWords) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more address space than the limits leave";
#endif
  const StudyCopy study("mpf_f111");
  fs::copy_file(paths::source() / "tests/apps/data/gaps.mkv", study.path("flight.mkv"), fs::copy_options::overwrite_existing);
  for (const rlim_t megabytes :
       {350, 490, 500, 560}) {  // measured: before decoding, in its thread, in the reader, in the decoder's threads
    const rlimit most{megabytes * 1'000'000, megabytes * 1'000'000};
    const Outcome outcome = run({"track", study.path("study.toml").string(), "--quiet"}, [&most] { ::setrlimit(RLIMIT_AS, &most); });
    fs::remove_all(study.out(""));
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 1) << megabytes << ": " << outcome.status << outcome.err;
    for (const char* internal : {"terminate", "bad_alloc"}) EXPECT_EQ(outcome.err.find(internal), std::string::npos) << outcome.err;
  }
}

}  // namespace
