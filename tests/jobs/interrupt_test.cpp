#include "misfit/jobs/interrupt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "misfit/core/error.h"

namespace misfit {
namespace {

/// The flag is the process's: as it was at the end of every test.
class Interrupted : public testing::Test {
 protected:
  ~Interrupted() override { interrupted() = false; }
};

TEST_F(Interrupted, StopsWhereWorkAsks) {
  EXPECT_NO_THROW(stop_if_interrupted());
  interrupted() = true;
  try {
    stop_if_interrupted();
    FAIL() << "went on";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the same command continues from there"));
  }
}

TEST_F(Interrupted, AMissingResultIsAnInterruptHereOrOnAnotherRank) {
  EXPECT_EQ(finished(std::optional<int>(3)), 3);
  EXPECT_THROW(std::ignore = finished(std::optional<int>()), EndedElsewhere);
  interrupted() = true;
  EXPECT_EQ(finished(std::optional<int>(3)), 3) << "a result that is there counts";
  EXPECT_THROW(std::ignore = finished(std::optional<int>()), RunError);
}

}  // namespace
}  // namespace misfit
