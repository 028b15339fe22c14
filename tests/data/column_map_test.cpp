#include "misfit/data/column_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/table.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double degree = std::numbers::pi / 180.0;

struct Read {
  std::vector<double> values;
  std::vector<std::string> notes;
};

/// Signal `angle` from a column of that header and unit, one value of 90.
Read angle_from(const std::string& header, const std::string& column_unit, const std::string& unit = "rad") {
  Table table;
  table.add(header, column_unit, {90.0});
  Read out;
  out.values = ColumnMap{{{"angle", header}}}.values(table, "angle", unit, out.notes);
  return out;
}

TEST(MappedColumn, IsReadInTheUnitThatItsNameEndsWith) {
  const Read read = angle_from("theta_deg", "");
  EXPECT_DOUBLE_EQ(read.values.front(), 90.0 * degree);
  EXPECT_THAT(read.notes, ElementsAre("column 'theta_deg' is read in deg, as its name says"));
  EXPECT_DOUBLE_EQ(angle_from("theta (deg)", "").values.front(), 90.0 * degree);
  EXPECT_DOUBLE_EQ(angle_from("t_ms", "", "s").values.front(), 0.09);
}

TEST(AColumnCalledAsTheSignalButForItsUnit, IsNamedWithTheLineThatTakesIt) {
  Table table;
  table.add("ram_mm", "", {90.0});
  std::vector<std::string> notes;
  const std::string said = message_of<InputError>([&] { static_cast<void>(ColumnMap{}.values(table, "ram", "m", notes)); });
  EXPECT_THAT(said, testing::HasSubstr("no column 'ram'; if 'ram_mm' is meant: columns = { ram = \"ram_mm\" } in [[experiment]]"));
  table.add("ram_V", "", {1.0});
  EXPECT_THAT(message_of<InputError>([&] { static_cast<void>(ColumnMap{}.values(table, "ram", "m", notes)); }),
              testing::HasSubstr("Valid: ram_mm, ram_V"))
      << "two could be meant";
}

TEST(MappedColumn, TheUnitOfItsHeaderComesFirst) {
  const Read read = angle_from("theta_deg", "rad");
  EXPECT_DOUBLE_EQ(read.values.front(), 90.0);
  EXPECT_THAT(read.notes, IsEmpty());
}

TEST(MappedColumn, WithoutAUnitOfTheSignalIsTakenAsItIsAndSaid) {
  for (const char* header : {"theta", "theta_V"}) {
    const Read read = angle_from(header, "");
    EXPECT_DOUBLE_EQ(read.values.front(), 90.0);
    ASSERT_EQ(read.notes.size(), 1U);
    EXPECT_EQ(read.notes.front(), "column '" + std::string(header) + "' has no unit for angle: its values are taken as rad");
  }
}

TEST(AColumnOfTheSignalsName, WithoutAUnitIsTakenInSIAndSaidWhereOthersHaveOne) {
  Table table;
  table.add("t", "s", {0.0});
  table.add("T_in", "", {20.0});
  std::vector<std::string> notes;
  EXPECT_EQ(ColumnMap{}.values(table, "T_in", "K", notes).front(), 20.0);
  EXPECT_THAT(notes, ElementsAre("column 'T_in' has no unit, though others have: its values are taken as K"));
  notes.clear();
  static_cast<void>(ColumnMap{}.values(table, "T_in", "-", notes));
  table.columns.front().unit.clear();
  static_cast<void>(ColumnMap{}.values(table, "T_in", "K", notes));
  EXPECT_THAT(notes, IsEmpty()) << "a pure number; a file without units";
}

TEST(MappedColumn, NothingIsSaidWhereNothingIsConverted) {
  EXPECT_THAT(angle_from("theta_rad", "").notes, IsEmpty());
  EXPECT_THAT(angle_from("ratio", "", "-").notes, IsEmpty());
}

TEST(MappedColumn, OfAnotherDimensionIsRefused) { EXPECT_THROW(angle_from("theta", "V"), InputError); }

TEST(UnmappedColumn, KeepsTheMeaningOfItsName) {
  Table table;
  table.add("x_mm", "", {5.0});
  std::vector<std::string> notes;
  EXPECT_DOUBLE_EQ(ColumnMap{}.values(table, "x_mm", "m", notes).front(), 5.0);
  EXPECT_THAT(notes, IsEmpty());
}

}  // namespace
}  // namespace misfit
