#include "apps/print.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

TEST(ResultsAsJson, OfSeveralFilesAreOneObjectAndOfOneThatFile) {
  const TemporaryFolder folder;
  const auto left = folder.write("left.json", "{\"ok\": 3}\n"), right = folder.write("right.json", "[1.25]\n");
  testing::internal::CaptureStdout();
  print_files({{"flight, left", left}, {"right", right}});
  EXPECT_EQ(nlohmann::json::parse(testing::internal::GetCapturedStdout()),
            nlohmann::json::parse(R"({"flight, left": {"ok": 3}, "right": [1.25]})"));
  testing::internal::CaptureStdout();
  print_files({{"left", left}});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "{\"ok\": 3}\n");
}

}  // namespace
}  // namespace misfit
