#include "misfit/core/loose_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

LooseTable read(const std::string& content) {
  const TemporaryFolder folder;
  return read_loose_csv(folder.write("x.csv", content));
}

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.csv", content);
  return message_of<InputError>([&] { static_cast<void>(read_loose_csv(file)); });
}

TEST(LooseCsv, FindsCommasSemicolonsTabsAndBlanks) {
  for (const char delimiter : {',', ';', '\t', ' '}) {
    std::string text = "t,u,y\n0,1.5,2\n1,-3e2,4\n";
    std::replace(text.begin(), text.end(), ',', delimiter);
    const LooseTable table = read(text);
    EXPECT_EQ(table.delimiter, delimiter);
    ASSERT_EQ(table.columns.size(), 3U) << delimiter;
    EXPECT_THAT(table.columns[1].values, ElementsAre(1.5, -300.0));
    EXPECT_FALSE(table.decimal_comma);
  }
}

TEST(LooseCsv, ReadsADecimalCommaWhereSemicolonsSeparate) {
  const LooseTable table = read("Zeit [s];Druck (Pa)\r\n0,0;1,25\r\n0,1;-2,5e1\r\n");
  EXPECT_TRUE(table.decimal_comma);
  EXPECT_EQ(table.columns[1].header, "Druck (Pa)");
  EXPECT_THAT(table.columns[0].values, ElementsAre(0.0, 0.1));
  EXPECT_THAT(table.columns[1].values, ElementsAre(1.25, -25.0));
}

TEST(LooseCsv, TheDecimalCommaIsFoundWhereTheLastRowHoldsWholeNumbers) {
  std::string rows = "Zeit;u;T\n";
  for (int k = 0; k < 40; ++k) rows += std::to_string(k) + ";0;20\n";
  const LooseTable table = read(rows + "40;1;20,5\n600;1;21\n");
  EXPECT_TRUE(table.decimal_comma);
  EXPECT_EQ(table.columns[2].text, 0U);
  EXPECT_EQ(table.columns[2].values[40], 20.5);
  const LooseTable dates = read("Zeit;T;note\n01.03.2024 00:10;20,5;v. 1.2, new\n01.03.2024 00:20;21;\n");
  EXPECT_THAT(dates.columns[1].values, ElementsAre(20.5, 21.0)) << "a point of a date or of a text is none of a number";
}

TEST(LooseCsv, BlanksSeparateNumbersWithDecimalCommas) {
  const LooseTable table = read("t y\n0,0 1,5\n0,1 2,5\n");
  EXPECT_EQ(table.delimiter, ' ');
  EXPECT_THAT(table.columns[0].values, ElementsAre(0.0, 0.1));
  EXPECT_THAT(table.columns[1].values, ElementsAre(1.5, 2.5));
  EXPECT_EQ(read("t, u, y\n0, 1, 2\n1, 2, 3\n").delimiter, ',');
  EXPECT_EQ(read("t, u, y\n0, 1, on\n1, 2, off\n").delimiter, ',');
}

TEST(LooseCsv, ManyColumnsTakeNoQuadraticTime) {
  std::string header = "t", row = "0";
  for (int i = 1; i < 100'000; ++i) {
    header += ",c" + std::to_string(i);
    row += ",1";
  }
  EXPECT_EQ(read(header + "\n" + row + "\n" + row + "\n").columns.size(), 100'000U);
  EXPECT_THAT(refusal(header + ",c77\n" + row + ",1\n"), HasSubstr("'c77' twice"));
}

TEST(LooseCsv, TakesTheHeaderFromTheLastComment) {
  const LooseTable table = read("# made by a logger\n# t y\n0 1\n1 2\n");
  EXPECT_EQ(table.comments, 2U);
  EXPECT_EQ(table.columns.back().header, "y");
  EXPECT_EQ(table.rows(), 2U);
}

TEST(LooseCsv, KeepsCountOfWhatIsMissingOrText) {
  const LooseTable table = read("t,y,\"a, note\"\n0,,x\n1,NaN,\"y, z\"\n2,n/a,3\n3,4,\n");
  EXPECT_EQ(table.columns[2].header, "a, note");
  EXPECT_EQ(table.columns[1].text, 0U);
  EXPECT_TRUE(std::isnan(table.columns[1].values[2]));
  EXPECT_EQ(table.columns[2].text, 2U);
  EXPECT_EQ(table.columns[2].text_line, 2);
  EXPECT_EQ(table.columns[2].first_text, "x");
}

TEST(LooseCsv, ReadsDatesAsSecondsSinceTheFirst) {
  const LooseTable table = read("when,y\n2026-01-02T03:04:05.5Z,1\n2026-01-02T03:04:06Z,2\n,3\n2026-01-02T04:04:06+01:00,4\n");
  EXPECT_TRUE(table.columns[0].dates);
  EXPECT_EQ(table.columns[0].text, 0U);
  EXPECT_EQ(table.columns[0].first_date, "2026-01-02T03:04:05.5Z");
  EXPECT_EQ(table.columns[0].values[1], 0.5);
  EXPECT_TRUE(std::isnan(table.columns[0].values[2]));
  EXPECT_EQ(table.columns[0].values[3], 0.5);
  const LooseTable mixed = read("when,y\n2026-01-02T03:04:05Z,1\nyesterday,2\n");
  EXPECT_FALSE(mixed.columns[0].dates);
  EXPECT_EQ(mixed.columns[0].text, 2U);
}

LooseTable read_with_names(const std::string& text, const std::vector<std::string>& names) {
  const TemporaryFolder folder;
  return read_loose_csv(folder.write("x.csv", text), names);
}

TEST(LooseCsv, TakesNamesThatAreGivenWhereTheFileHasNone) {
  const LooseTable table = read_with_names("0,1\n1,2\n", {"t[s]", "y"});
  EXPECT_EQ(table.columns[0].header, "t[s]");
  EXPECT_THAT(table.columns[1].values, ElementsAre(1.0, 2.0));
  EXPECT_THAT(read_with_names("a,b\n0,1\n1,2\n", {"t", "y"}).columns[1].values, ElementsAre(1.0, 2.0));
  EXPECT_THAT(message_of<InputError>([] { static_cast<void>(read_with_names("0,1\n1,2\n", {"t"})); }),
              HasSubstr("1 names are given for 2 columns"));
}

TEST(LooseCsv, SaysWhatIsWrong) {
  EXPECT_THAT(refusal(std::string("t[s],u[V]\n1,2\0\0", 15)), HasSubstr("this is no text"));
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("\n \n# only words\n"), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("y\n1\n2\n"), HasSubstr("one column alone ('y')"));
  EXPECT_THAT(refusal("t,y\n"), HasSubstr("no rows"));
  EXPECT_THAT(refusal("0,1\n1,2\n"), HasSubstr("first line holds numbers"));
  EXPECT_THAT(refusal("t,y,y\n0,1,2\n1,2,3\n"), HasSubstr("'y' twice"));
  EXPECT_THAT(refusal("t,y\n0,1\n1,2,3\n2,3\n"), HasSubstr("x.csv:3"));
}

}  // namespace
}  // namespace misfit
