#include "misfit/data/log/time_base.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;

/// A log in memory.
class MadeUpLog : public LogReader {
 public:
  MadeUpLog() { log_.source = "made_up.ulg"; }
  /// A topic with its time in us.
  MadeUpLog& topic(const std::string& name, const std::vector<double>& us, const std::vector<double>& x, const std::string& unit = "us") {
    const std::size_t clock = log_.channels.size();
    log_.channels.push_back({name + ".time", name, unit, us.size(), clock, {}});
    log_.channels.push_back({name + ".x", name, "rad/s", x.size(), clock, {}});
    values_.push_back(us);
    values_.push_back(x);
    return *this;
  }
  MadeUpLog& of_the_last_topic(const std::string& name, const std::vector<double>& x, const std::string& unit) {
    log_.channels.push_back({name, log_.channels.back().group, unit, x.size(), log_.channels.back().clock, {}});
    values_.push_back(x);
    return *this;
  }
  MadeUpLog& without_time(const std::string& name, const std::vector<double>& x) {
    log_.channels.push_back({name, "", "", x.size(), std::nullopt, {}});
    values_.push_back(x);
    return *this;
  }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    for (const std::size_t c : channels) log_.channels[c].values = values_[c];
  }

 private:
  std::vector<std::vector<double>> values_;
};

struct Result {
  Table table;
  std::vector<std::string> notes;
};

Result brought(MadeUpLog& log, const std::vector<WantedChannel>& wanted, const std::optional<std::string>& time = {},
               Rows rows = Rows::forward) {
  Result out;
  out.table = on_one_time_base(log, wanted, time, out.notes, rows);
  return out;
}

TEST(OneTimeBase, OfOneTopicIsItsTimeInSeconds) {
  MadeUpLog log;
  log.topic("a", {0, 1e5, 2e5}, {1, 2, 3});
  const Result r = brought(log, {{"a.x"}});
  EXPECT_EQ(r.table.columns[0].header(), "t[s]");
  EXPECT_THAT(r.table.columns[0].values, ElementsAre(0.0, 0.1, 0.2));
  EXPECT_EQ(r.table.columns[1].header(), "a.x[rad/s]");
  EXPECT_THAT(r.notes, IsEmpty());
}

TEST(OneTimeBase, AnInputOfAnotherClockIsHeldOrInterpolatedAndTheEndsWithoutItAreLeftOut) {
  MadeUpLog log;
  log.topic("y", {0, 1e5, 2e5, 3e5, 4e5}, {1, 2, 3, 4, 5}).topic("u", {0.5e5, 2.5e5}, {10, 30});
  const Result held = brought(log, {{"y.x"}, {"u.x", Between::held}});
  EXPECT_THAT(held.table.columns[0].values, ElementsAre(0.1, 0.2, 0.3, 0.4));
  EXPECT_THAT(held.table.columns[1].values, ElementsAre(2, 3, 4, 5));
  EXPECT_THAT(held.table.columns[2].values, ElementsAre(10, 10, 30, 30));
  EXPECT_THAT(held.notes, ElementsAre("'u.x' (2 samples) has a clock of its own: the last value is held at the times of 'y.time'",
                                      "1 of 5 samples are left out at the ends, where an input is not known"));
  MadeUpLog again;
  again.topic("y", {0, 1e5, 2e5, 3e5, 4e5}, {1, 2, 3, 4, 5}).topic("u", {0.5e5, 2.5e5}, {10, 30});
  const Result linear = brought(again, {{"y.x"}, {"u.x", Between::linear}});
  EXPECT_THAT(linear.table.columns[1].values, ElementsAre(2, 3));
  EXPECT_THAT(linear.table.columns[2].values, ElementsAre(testing::DoubleEq(15.0), testing::DoubleEq(25.0)));
}

TEST(OneTimeBase, AMeasurementOfASlowerClockStandsOnceAndIsMissingElsewhere) {
  MadeUpLog log;
  log.topic("y", {0, 1e5, 2e5, 3e5}, {1, 2, 3, 4}).topic("slow", {0.9e5, 1.2e5, 9e5}, {7, 8, 9});
  const Result r = brought(log, {{"y.x"}, {"slow.x"}}, "y.time");
  EXPECT_THAT(r.table.columns[2].values, ElementsAre(IsNan(), 7, IsNan(), IsNan()));
  EXPECT_THAT(r.notes, ElementsAre(HasSubstr("1 of its 3 samples stand at the nearest time of 'y.time', moved by at most 0.01 s")));
}

TEST(OneTimeBase, OfSeveralClocksHasTheTimesOfAllAndEveryMeasurementAtItsOwn) {
  MadeUpLog log;
  log.topic("y", {0, 1e5, 2e5, 3e5}, {1, 2, 3, 4}).topic("slow", {0.9e5, 2e5, 2.7e5}, {7, 8, 9}).topic("u", {0, 1.5e5, 2e5}, {10, 20, 30});
  const Result r = brought(log, {{"y.x"}, {"slow.x"}, {"u.x", Between::held}});
  EXPECT_THAT(r.table.columns[0].values, ElementsAre(0.0, 0.09, 0.1, 0.15, 0.2, 0.27, 0.3));
  EXPECT_THAT(r.table.columns[1].values, ElementsAre(1, IsNan(), 2, IsNan(), 3, IsNan(), 4));
  EXPECT_THAT(r.table.columns[2].values, ElementsAre(IsNan(), 7, IsNan(), IsNan(), 8, 9, IsNan()));
  EXPECT_THAT(r.table.columns[3].values, ElementsAre(10, 10, 10, 20, 30, 30, 30));
  EXPECT_THAT(r.notes, Contains("3 clocks: every measurement stands at its own time, in 7 rows"));
}

TEST(OneTimeBase, AFastHeldInputMakesNoRows) {
  MadeUpLog log;
  std::vector<double> t(40), u(40);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 1e4 * static_cast<double>(i), u[i] = static_cast<double>(i);
  log.topic("y", {0, 1e5, 2e5, 3e5}, {1, 2, 3, 4}).topic("slow", {0.9e5, 2.7e5}, {7, 9}).topic("u", t, u);
  EXPECT_EQ(brought(log, {{"y.x"}, {"slow.x"}, {"u.x", Between::held}}).table.rows(), 6U);
}

TEST(OneTimeBase, TimesThatDoNotIncreaseAreLeftOutAndCounted) {
  MadeUpLog log;
  log.topic("a", {0, 1e5, 1e5, 0.5e5, 2e5}, {1, 2, 3, 4, 5});
  const Result r = brought(log, {{"a.x"}});
  EXPECT_THAT(r.table.columns[1].values, ElementsAre(1, 2, 5));
  EXPECT_THAT(r.notes, ElementsAre(testing::AllOf(HasSubstr("2 of 5 samples are left out"), HasSubstr("it runs back at sample 4"))));
}

TEST(OneTimeBase, RowsOfOneClockMayStayAsTheyWereRecorded) {
  MadeUpLog log;
  log.topic("a", {0, 1e5, 2e5, 0, 1e5, 2e5}, {1, 2, 3, 4, 5, 6}).topic("u", {0, 1e5}, {7, 8});
  const Result r = brought(log, {{"a.x"}}, {}, Rows::as_recorded);
  EXPECT_THAT(r.table.columns[0].values, ElementsAre(0.0, 0.1, 0.2, 0.0, 0.1, 0.2));
  EXPECT_THAT(r.table.columns[1].values, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(r.notes, IsEmpty());
  EXPECT_EQ(brought(log, {{"a.x"}, {"u.x", Between::held}}, {}, Rows::as_recorded).table.rows(), 3U) << "of several clocks";
}

/// Both times count its rows: they are not brought from one to the other by their values.
TEST(OneTimeBase, TheSecondTimeOfATopicIsThatOfItsRows) {
  MadeUpLog log;
  log.topic("a", {0, 1e5, 2e5}, {1, 2, 3}).of_the_last_topic("a.logged", {50.0, 50.1, 50.3}, "s");
  const Result r = brought(log, {{"a.x"}}, "a.logged");
  EXPECT_THAT(r.table.columns[0].values, ElementsAre(50.0, 50.1, 50.3));
  EXPECT_THAT(r.table.columns[1].values, ElementsAre(1, 2, 3));
  EXPECT_THAT(r.notes, IsEmpty());
}

TEST(OneTimeBase, WithoutATimeAsksForItByNameAndTakesIt) {
  MadeUpLog log;
  log.without_time("w", {1, 2, 3}).without_time("clock_ms", {0, 10, 20});
  EXPECT_THAT(
      message_of<InputError>([&] { static_cast<void>(brought(log, {{"w"}})); }),
      HasSubstr("has no time of its own: say which one is it, as columns = { t = \"…\" } or --time; of as many samples are: clock_ms"));
  const Result r = brought(log, {{"w"}}, "clock_ms");
  EXPECT_THAT(r.table.columns[0].values, ElementsAre(0.0, 0.01, 0.02));
  EXPECT_EQ(r.table.columns[0].name, "clock_ms");
}

TEST(OneTimeBase, RefusesATimeInAnUnknownUnit) {
  MadeUpLog log;
  log.topic("a", {0, 1, 2}, {1, 2, 3}, "ticks");
  EXPECT_THAT(message_of<InputError>([&] { static_cast<void>(brought(log, {{"a.x"}})); }), HasSubstr("the unit 'ticks' is not known"));
  MadeUpLog volts;
  volts.topic("a", {0, 1, 2}, {1, 2, 3}, "V");
  EXPECT_THAT(message_of<InputError>([&] { static_cast<void>(brought(volts, {{"a.x"}})); }),
              HasSubstr("is in V, which is no unit of time"));
}

TEST(OneTimeBase, TheUnitMayStandAtTheEndOfAName) {
  EXPECT_EQ(known_unit({"a.t_ms", "a", "", 1, {}, {}}), "ms");
  EXPECT_EQ(known_unit({"a.q[1]", "a", "", 1, {}, {}}), "") << "an index";
  EXPECT_EQ(known_unit({"a.q_deg[1]", "a", "", 1, {}, {}}), "deg");
  EXPECT_EQ(known_unit({"a.q", "a", "m/s/s", 1, {}, {}}), "m/s/s");
}

TEST(OneTimeBase, NamesTheNearestChannel) {
  MadeUpLog log;
  log.topic("motor", {0, 1}, {1, 2});
  EXPECT_THAT(message_of<InputError>([&] { static_cast<void>(brought(log, {{"moter.x"}})); }),
              HasSubstr("no channel 'moter.x' — did you mean 'motor.x'"));
}

}  // namespace
}  // namespace misfit
