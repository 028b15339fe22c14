#include "misfit/jobs/interrupt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

namespace misfit {
namespace {

/// The flag is the process's: as it was at the end of every test.
class InterruptTest : public testing::Test {
 protected:
  ~InterruptTest() override { interrupted() = false; }
};

TEST_F(InterruptTest, StopsWhereWorkAsks) {
  EXPECT_NO_THROW(stop_if_interrupted());
  interrupted() = true;
  try {
    stop_if_interrupted();
    FAIL() << "went on";
  } catch (const Interrupted& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the same command continues from there"));
  }
}

TEST_F(InterruptTest, AMissingResultIsAnInterruptHereOrOnAnotherRank) {
  EXPECT_EQ(finished(std::optional<int>(3)), 3);
  EXPECT_THROW(std::ignore = finished(std::optional<int>()), EndedElsewhere);
  interrupted() = true;
  EXPECT_EQ(finished(std::optional<int>(3)), 3) << "a result that is there counts";
  EXPECT_THROW(std::ignore = finished(std::optional<int>()), Interrupted);
}

}  // namespace
}  // namespace misfit
