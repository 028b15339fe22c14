#include "misfit/serve/job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "tests/core/temporary_folder.h"

namespace misfit::serve {
namespace {

/// What is known of a program that says this on stderr, when it has ended.
JobReport report_of(const std::string& said) {
  const TemporaryFolder folder;
  folder.write("said", said);
  folder.write("program", "#!/bin/sh\ncat '" + (folder.path() / "said").string() + "' >&2\n");
  std::filesystem::permissions(folder.path() / "program", std::filesystem::perms::owner_all);
  Jobs jobs((folder.path() / "program").string(), [](const JobReport&) {});
  EXPECT_TRUE(jobs.start({}, "a command"));
  for (int k = 0; k < 500 && jobs.report().state == JobState::running; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return jobs.report();
}

std::string line_of(const std::string& work, int iteration) {
  return R"({"progress":")" + work + R"(","what":"cost","iteration":)" + std::to_string(iteration) + R"(,"value":)" +
         std::to_string(100 - iteration % 100) + "}\n";
}

TEST(AJob, FollowsSearchesThatAreAtWorkAtOnce) {
  std::string said;
  for (int k = 0; k < 10; ++k) said += line_of("one", k) + line_of("two", k);
  const JobReport report = report_of(said);
  ASSERT_EQ(report.state, JobState::done);
  ASSERT_EQ(report.costs.size(), 2U);
  for (const CostTrace& trace : report.costs) EXPECT_EQ(trace.points.size(), 10U) << trace.work;
}

TEST(AJob, KeepsTheWholeWayOfALongSearchAndOfManySearchesTheLast) {
  std::string said;
  for (int k = 0; k < 9000; ++k) said += line_of("long", k);
  const JobReport report = report_of(said);
  ASSERT_EQ(report.costs.size(), 1U);
  const auto& points = report.costs[0].points;
  EXPECT_LE(points.size(), 2000U);
  EXPECT_GT(points.size(), 1000U);
  EXPECT_EQ(points.front().first, 0);
  EXPECT_EQ(points.back().first, 8999);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end()));

  said.clear();
  for (int k = 0; k < 20; ++k) said += line_of(std::to_string(k), 1);
  const JobReport many = report_of(said);
  ASSERT_FALSE(many.costs.empty());
  EXPECT_LE(many.costs.size(), 4U);
  EXPECT_EQ(many.costs.back().work, "19");
}

}  // namespace
}  // namespace misfit::serve
