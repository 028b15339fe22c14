#include "misfit/core/duration.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(DurationInWords, IsInTheLargestUnitOfWhichThereAreTwo) {
  EXPECT_EQ(duration_in_words(0.64), "0.64 s");
  EXPECT_EQ(duration_in_words(90.0), "90 s");
  EXPECT_EQ(duration_in_words(600.0), "10 min");
  EXPECT_EQ(duration_in_words(86400.0), "24 h");
  EXPECT_EQ(duration_in_words(8.0 * 86400.0), "8 d");
}

}  // namespace
}  // namespace misfit
