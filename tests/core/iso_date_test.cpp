#include "misfit/core/iso_date.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

double between(const char* from, const char* to) {
  const auto a = read_iso_date(from), b = read_iso_date(to);
  EXPECT_TRUE(a && b) << from << ", " << to;
  return a && b ? seconds_between(*a, *b) : 0.0;
}

TEST(IsoDate, IsReadInTheFormsOfLogs) {
  const auto epoch = read_iso_date("1970-01-01T00:00:00Z");
  ASSERT_TRUE(epoch);
  EXPECT_EQ(epoch->seconds, 0);
  EXPECT_EQ(read_iso_date("2026-11-23 00:31:55")->seconds, 1795393915);  // date -u -d '2026-11-23 00:31:55' +%s
  EXPECT_EQ(between("2026-01-02T03:04:05Z", "2026-01-02 03:04:05.25"), 0.25);
  EXPECT_EQ(between("2026-01-02T03:04:05Z", "2026/01/02 03:04:06,5"), 1.5);
  EXPECT_EQ(between("2026-01-02T03:04:05Z", "2026-01-02T04:04:05+01:00"), 0.0);
  EXPECT_EQ(between("2026-01-02T03:04", "2026-01-02T03:05-0000"), 60.0);
  EXPECT_EQ(between("2024-02-28T23:59:59", "2024-03-01T00:00:00"), 86401.0);
  EXPECT_EQ(between("2024-02-28 23:59:59", "01.03.2024 00:00"), 86401.0) << "with points the day comes first";
}

TEST(IsoDate, OfADayThatIsNoneIsRefused) {
  for (const char* text :
       {"2026-02-30 00:00:00", "2026-13-01 00:00:00", "2026-01-01 24:30:00", "2026-01-01", "12:30:00", "2026-1-1 0:0", "x", "",
        "31.02.2024 00:00", "01.13.2024 00:00", "1.3.2024 0:00", "01.03.2024", "2026-01-01T00:00:00 CET", "2026-01/01 00:00", "1.5"})
    EXPECT_FALSE(read_iso_date(text)) << text;
}

}  // namespace
}  // namespace misfit
