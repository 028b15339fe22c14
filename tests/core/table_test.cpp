#include "misfit/core/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::string error_of(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("data.csv", content);
  return message_of<InputError>([&] { (void)read_csv(file); });
}

TEST(ReadCsv, ReadsNamesUnitsAndValues) {
  const TemporaryFolder folder;
  const Table table = read_csv(folder.write("x.csv", "t[s],alpha[deg],ok\n0,1.5,1\n0.1,-2e-1,0\n"));
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[1].name, "alpha");
  EXPECT_EQ(table.columns[1].unit, "deg");
  EXPECT_EQ(table.columns[2].header(), "ok");
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{1.5, -0.2}));
  EXPECT_EQ(table.line, (std::vector<int>{2, 3}));
}

TEST(ReadCsv, AcceptsCommentsBlankLinesBomCrlfBlanksAndQuotes) {
  const TemporaryFolder folder;
  const Table table = read_csv(
      folder.write("x.csv", "\xEF\xBB\xBF# a comment, with commas\r\n\r\n \"t, or time[s]\" , y\r\n\r\n 1 ,\t\"2\"\r\n# end\r\n3,+4"));
  EXPECT_EQ(table.columns[0].name, "t, or time");
  EXPECT_EQ(table.columns[0].unit, "s");
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{2.0, 4.0}));
  EXPECT_EQ(table.line, (std::vector<int>{5, 7}));
}

TEST(ReadCsv, TakesEmptyAndNanAsMissing) {
  const TemporaryFolder folder;
  const Table table = read_csv(folder.write("x.csv", "t,y\n1,\n2,nan\n3,NaN\n4,\"\"\n5,7\n"));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(table.columns[1].values[i])) << i;
  EXPECT_EQ(table.columns[1].values[4], 7.0);
}

TEST(ReadCsv, TakesANumberTooSmallToHoldAsZero) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_csv(folder.write("x.csv", "y\n1e-400\n")).columns[0].values[0], 0.0);
}

TEST(ReadCsv, MissingFileNamesTheNearest) {
  const TemporaryFolder folder;
  folder.write("track.csv", "t\n1\n");
  expect_parts(message_of<InputError>([&] { (void)read_csv(folder.path() / "tracks.csv"); }), {"tracks.csv: no such file", "'track.csv'"});
}

TEST(ReadCsv, EmptyFileHasNoHeader) {
  expect_parts(error_of(""), {"data.csv", "no header"});
  expect_parts(error_of("# nothing\n\n"), {"no header"});
}

TEST(ReadCsv, HeaderAloneHasNoRows) { expect_parts(error_of("t[s],y[m]\n"), {"data.csv", "no rows"}); }

TEST(ReadCsv, NumbersInTheFirstLineAreNoHeader) { expect_parts(error_of("0,1\n1,2\n"), {"data.csv:1", "no header line"}); }

TEST(ReadCsv, TextInANumberColumnNamesLineColumnAndText) {
  expect_parts(error_of("t[s],y[m]\n0,1\n1,abc\n"), {"data.csv:3", "'y[m]'", "'abc'"});
  expect_parts(error_of("t[s],y[m]\n0,1.5x\n"), {"data.csv:2", "'1.5x'"});
  expect_parts(error_of("t[s],y[m]\n0,1 2\n"), {"'1 2'"});
}

TEST(ReadCsv, InfinityAndOverflowAreNotNumbers) {
  expect_parts(error_of("t,y\n0,inf\n"), {"data.csv:2", "'inf'"});
  expect_parts(error_of("t,y\n0,1e999\n"), {"data.csv:2", "'1e999'"});
}

TEST(ReadCsv, TextIsAcceptedWhereItIsToBeIgnored) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.csv", "t,note,y\n1,start,2\n");
  const Table table = read_csv(file, {"note"});
  EXPECT_TRUE(std::isnan(table.at("note").values[0]));
  EXPECT_EQ(table.at("y").values[0], 2.0);
  EXPECT_THROW((void)read_csv(file, {"y"}), InputError);
}

TEST(ReadCsv, AHeaderUsedTwiceIsNamed) { expect_parts(error_of("t,y[m],y[m]\n0,1,2\n"), {"data.csv:1", "'y[m]' twice"}); }

TEST(ReadCsv, AColumnGivenTwiceInTwoUnitsIsRefused) {
  expect_parts(error_of("t[s],y[V],y[mV]\n0,1,2\n"), {"data.csv:1", "'y' twice", "'y[V]'", "'y[mV]'"});
  expect_parts(error_of("t[s],y[V],y\n0,1,2\n"), {"data.csv:1", "'y' twice", "'y[V]'"});
  expect_parts(error_of("t[s],y,y []\n0,1,2\n"), {"data.csv:1", "'y' twice"});
}

std::string header_of(int columns) {
  std::string header = "t";
  for (int i = 1; i < columns; ++i) header += ",c" + std::to_string(i);
  return header + "\n";
}

TEST(ReadCsv, TwentyThousandColumnsAreReadAndMoreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_csv(folder.write("x.csv", header_of(20'000) + std::string(19'999, ',') + "\n")).columns.size(), 20'000U);
  expect_parts(error_of(header_of(100'000)), {"data.csv:1", "100000 columns", "at most 20000"});
  expect_parts(error_of(std::string(1'000'000, ',') + "\n"), {"data.csv:1", "1000001 columns"});
}

TEST(ReadCsv, AFieldOfTenMegabytesIsShownInPart) {
  for (const char* quote : {"", "\""}) {
    const std::string message = error_of("t,y\n0," + std::string(quote) + std::string(8'000'000, 'x') + quote + "\n");
    expect_parts(message, {"data.csv:2", "column 'y'", "'xxx", "…'", "not a finite number"});
    EXPECT_LT(message.size(), 300U);
  }
}

TEST(ReadCsv, ControlCharactersOfAFieldAreShownAsEscapes) {
  expect_parts(error_of("t,y\x1b[2J\n0,1\a\n"), {"column 'y\\x1b[2J'", "'1\\x07'"});
}

TEST(Table, AMissingColumnAmongManyIsAShortMessage) {
  const TemporaryFolder folder;
  const Table table = read_csv(folder.write("x.csv", header_of(5000) + std::string(4999, ',') + "\n"));
  const std::string message = message_of<InputError>([&] { (void)table.at("c4321x"); });
  expect_parts(message, {"'c4321x'", "did you mean 'c4321'?", " more"});
  EXPECT_LT(message.size(), 300U);
}

TEST(ReadCsv, AColumnWithoutNameIsRefused) { expect_parts(error_of("t,,y\n0,1,2\n"), {"data.csv:1", "column 2 has no name"}); }

TEST(ReadCsv, ARaggedRowNamesLineAndCounts) {
  expect_parts(error_of("t,y\n0,1\n1\n"), {"data.csv:3", "1 fields where the header has 2"});
  expect_parts(error_of("t,y\n0,1,2\n"), {"data.csv:2", "3 fields where the header has 2"});
}

TEST(ReadCsv, OtherSeparatorsAreExplained) { expect_parts(error_of("t;y\n0;1\n"), {"data.csv:1", "separated by commas"}); }

TEST(ReadCsv, AnOpenQuotationMarkNamesItsLine) { expect_parts(error_of("t,y\n0,\"1\n1,2\n"), {"data.csv:2", "quotation mark"}); }

TEST(Table, FindsByNameOrHeader) {
  Table table;
  table.add("y", "m", {1.0});
  EXPECT_EQ(table.find("y"), table.find("y[m]"));
  EXPECT_NE(table.find("y"), nullptr);
  EXPECT_EQ(table.find("z"), nullptr);
}

TEST(Table, AColumnThatIsMissingNamesFileNearestAndAll) {
  Table table;
  table.source = "data.csv";
  table.add("P_y", "px", {1.0});
  table.add("P_z", "px", {1.0});
  expect_parts(message_of<InputError>([&] { (void)table.at("P_x"); }), {"data.csv", "'P_x'", "P_y[px], P_z[px]"});
}

TEST(Table, ConvertsUnitsAndTakesABareColumnAsItIs) {
  Table table;
  table.add("a", "deg", {180.0, missing});
  table.add("b", "", {2.0, 3.0});
  EXPECT_DOUBLE_EQ(table.values("a", "rad")[0], std::numbers::pi);
  EXPECT_TRUE(std::isnan(table.values("a", "rad")[1]));
  EXPECT_EQ(table.values("b", "rad"), (std::vector<double>{2.0, 3.0}));
}

TEST(Table, AWrongUnitNamesFileAndColumn) {
  Table table;
  table.source = "data.csv";
  table.add("a", "kg", {1.0});
  table.add("b", "furlong", {1.0});
  expect_parts(message_of<InputError>([&] { (void)table.values("a", "m"); }), {"data.csv", "'a[kg]'", "'m'"});
  expect_parts(message_of<InputError>([&] { (void)table.values("b", "m"); }), {"data.csv", "'b[furlong]'", "unknown unit"});
}

TEST(WriteCsv, IsReadBackWithMissingValues) {
  const TemporaryFolder folder;
  Table table;
  table.add("t", "s", {0.0, 1.0 / 3.0, 1e-300});
  table.add("y", "", {missing, -0.1, 123456789.0});
  write_csv(folder.path() / "x.csv", table, 17);
  EXPECT_EQ(read_file(folder.path() / "x.csv").substr(0, 10), "t[s],y\n0,\n");
  const Table back = read_csv(folder.path() / "x.csv");
  EXPECT_EQ(back.columns[0].values, table.columns[0].values);
  EXPECT_TRUE(std::isnan(back.columns[1].values[0]));
  EXPECT_EQ(back.columns[1].values[2], 123456789.0);
}

TEST(WriteCsv, KeepsARowOfASingleMissingValue) {
  const TemporaryFolder folder;
  Table table;
  table.add("#y", "m", {1.0, missing, 2.0});  // would be a comment without quotation marks
  write_csv(folder.path() / "x.csv", table);
  const Table back = read_csv(folder.path() / "x.csv");
  ASSERT_EQ(back.rows(), 3U);
  EXPECT_TRUE(std::isnan(back.columns[0].values[1]));
}

TEST(WriteCsv, WritesTheDigitsAskedForAndNoMore) {
  const TemporaryFolder folder;
  Table table;
  table.add("y", "", {1.0 / 3.0, 0.5, 1e10});
  write_csv(folder.path() / "x.csv", table, 4);
  EXPECT_EQ(read_file(folder.path() / "x.csv"), "y\n0.3333\n0.5\n1e+10\n");
}

TEST(WriteCsv, RefusesColumnsOfUnequalLength) {
  const TemporaryFolder folder;
  Table table;
  table.add("a", "", {1.0, 2.0});
  table.add("b", "", {1.0});
  EXPECT_THROW(write_csv(folder.path() / "x.csv", table), std::invalid_argument);
}

TEST(ReadCsv, AMillionRowsAreReadBackExactly) {
  const TemporaryFolder folder;
  const std::size_t rows = 1'000'000;
  Table table;
  std::vector<double> t(rows), y(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    t[i] = static_cast<double>(i) * 1e-3;
    y[i] = std::sin(static_cast<double>(i));
  }
  table.add("t", "s", t);
  table.add("y", "m", y);
  write_csv(folder.path() / "x.csv", table, 17);
  const Table back = read_csv(folder.path() / "x.csv");
  EXPECT_EQ(back.columns[0].values, t);
  EXPECT_EQ(back.columns[1].values, y);
}

}  // namespace
}  // namespace misfit
