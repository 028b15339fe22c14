// A study of a flight log whose topics have clocks of their own, from the file to the estimate; and misfit init for logs.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/apps/program.h"
#include "tests/core/ulog_writer.h"

namespace {

using namespace program;
using testing::AllOf;
using testing::HasSubstr;

/// A motor of first order, tau = 0.5 s, 2 (rad/s)/V: the speed at 100 Hz, its voltage when it changes, each second.
std::string motor_log() {
  UlogWriter log;
  const std::string fields = "float x;float temperature_degC;";
  log.topic(0, "motor", fields);
  log.topic(1, "command", fields);
  double w = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double u = (k / 100) % 3;
    if (k % 100 == 0) log.record(1, 0.01 * k, static_cast<float>(u), 25.0F);
    const double noise = 0.01 * std::sin(1e4 * std::sin(12.9898 * k));
    log.record(0, 0.01 * k, static_cast<float>(w + noise), 25.0F);
    w = 2.0 * u + (w - 2.0 * u) * std::exp(-0.01 / 0.5);
  }
  return log.text();
}

constexpr const char* motor_model = R"([system]
doc = "motor"
source = "test"
[states]
w = { unit = "rad/s", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 1.0, free = true, bounds = [0.01, 100.0], doc = "time constant" }
k = { unit = "rad/s/V", value = 1.0, free = true, doc = "gain" }
[equations]
w = "(k*u - w)/tau"
[outputs]
w = { unit = "rad/s", noise = 0.01 }
)";

std::string study(const std::string& columns) {
  return "[study]\nname = \"motor\"\nmethods = [\"output_error\"]\n[system]\nfile = \"model.toml\"\n[[experiment]]\ndata = "
         "\"log.ulg\"\ncolumns = " +
         columns + "\n[effects]\n";
}

TEST(LogStudy, TopicsWithClocksOfTheirOwnAreBroughtTogetherAndFitted) {
  const TemporaryFolder folder;
  folder.write("log.ulg", motor_log());
  folder.write("model.toml", motor_model);
  const auto file = folder.write("study.toml", study("{ w = \"motor.x\", u = \"command.x\" }"));
  const Outcome outcome = run({"fit", file.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out + outcome.err, HasSubstr("the last value is held at the times of 'motor.timestamp'"));
  const json fit = json::parse(content(folder.path() / "out/fit/output_error/fit.json"));
  const auto close = [&](const char* name, double truth) {
    const json& p = fit["parameters"][name];
    EXPECT_NEAR(p["value"].get<double>(), truth, 4.0 * p["sigma"].get<double>()) << name;
    EXPECT_LT(p["sigma"].get<double>(), 0.01 * truth) << name;
  };
  close("tau", 0.5);
  close("k", 2.0);
}

TEST(LogStudy, AChannelThatIsNotThereIsNamedWithTheNearest) {
  const TemporaryFolder folder;
  folder.write("log.ulg", motor_log());
  folder.write("model.toml", motor_model);
  const auto file = folder.write("study.toml", study("{ w = \"motr.x\", u = \"command.x\" }"));
  const Outcome outcome = run({"fit", file.string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no channel 'motr.x' — did you mean 'motor.x'"));
}

TEST(InitOfALog, ListsChannelsWhereItCannotDecideAndTakesThoseThatAreNamed) {
  const TemporaryFolder folder;
  const auto log = folder.write("log.ulg", motor_log());
  const std::string out = (folder.path() / "study").string();
  const Outcome undecided = run({"init", log.string(), "--out", out});
  EXPECT_EQ(undecided.status, 2);
  EXPECT_THAT(undecided.out, AllOf(HasSubstr("motor (2000 samples)"), HasSubstr("command (20 samples)"), HasSubstr("timestamp [us]")));
  EXPECT_THAT(undecided.err, HasSubstr("--topic TOPIC"));
  const Outcome made = run({"init", log.string(), "--output", "motor.x", "--input", "command.x", "--out", out});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, AllOf(HasSubstr("ULog (PX4)"), HasSubstr("named by --output"), HasSubstr("named by --input")));
  EXPECT_EQ(first_line(folder.path() / "study/log.csv"), "t[s],command_x[-],motor_x[-]");
  const Outcome topic = run({"init", log.string(), "--topic", "motor", "--out", (folder.path() / "two").string()});
  ASSERT_EQ(topic.status, 0) << topic.err;
  EXPECT_EQ(first_line(folder.path() / "two/log.csv"), "t[s],x[-]") << "the temperature never changes";
  const Outcome wrong = run({"init", log.string(), "--topic", "moter"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("no topic 'moter' — did you mean 'motor'"));
}

TEST(InitOfALog, ThatIsDamagedSaysWhereWithStatusTwo) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("log.mat", "MATLAB 5.0 MAT-file" + std::string(105, ' ') + std::string("\0\1IM\x0E\0\0\0\xFF\xFF\xFF\x7F", 12));
  const Outcome outcome = run({"init", file.string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("log.mat: byte "), HasSubstr("expected")));
}

}  // namespace
