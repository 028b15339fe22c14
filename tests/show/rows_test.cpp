#include "misfit/show/rows.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(Rows, ANumberWithoutUnitDoesNotEnter) {
  expect_parts(message_of<InputError>([] { const Row row("trim", 1.0, 0.1, ""); }), {"trim", "no unit"});
  EXPECT_THROW(Row("trim", 1.0, 0.1, "furlong"), InputError);
}

TEST(Rows, AnglesAreShownInDegreesWithTheirSigma) {
  EXPECT_EQ(Row("trim", 12.0 * degree, 0.21 * degree, "rad").shown(), "12.00 ± 0.21 deg");
  EXPECT_EQ(Row("lost", std::numeric_limits<double>::quiet_NaN(), 0.0, "m").shown(), "not available m");
}

TEST(Rows, APureNumberHasNoUnit) { EXPECT_EQ(Row("C_m", 0.5, 0.0, "-").shown(), "0.5"); }

TEST(Rows, AnIntervalOfItsOwnStandsBesideSigma) {
  EXPECT_EQ(Row("slope", Estimate{0.2, 0.01, "rad", std::pair(0.15, 0.3)}).shown(), "11.46 ± 0.57 deg (95 %: 8.59 to 17.19 deg)");
}

TEST(Rows, SubjectsStandSideBySideWithDashesForGaps) {
  const TableBlock table =
      subjects_table("result", {{"a", {{"trim", 0.2, 0.0, "m"}}}, {"b", {{"trim", 0.3, 0.0, "m"}, {"rms", 4.0, 0.0, "px"}}}, {"c", {}}});
  EXPECT_EQ(table.rows, (std::vector<std::vector<std::string>>{{"trim", "0.2 m", "0.3 m", "–"}, {"rms", "–", "4 px", "–"}}));
}

}  // namespace
}  // namespace misfit
