#include "misfit/core/file_name.h"

#include <gtest/gtest.h>

#include <set>

#include "misfit/core/unique_name.h"

namespace misfit {
namespace {

TEST(FileName, OfAPlainNameIsTheName) {
  for (const char* name : {"flight", "multisine_test", "run-7", "Test_01"}) EXPECT_EQ(file_name_for(name), name);
}

TEST(FileName, OfDifferentNamesIsDifferent) {
  const std::vector<std::string> names{"a b",
                                       "a_b",
                                       "a-b",
                                       "a.b",
                                       "a/b",
                                       "a\\b",
                                       "a\nb",
                                       "试验一",
                                       "试验二",
                                       "é",
                                       "è",
                                       "",
                                       " ",
                                       ".",
                                       "..",
                                       "_",
                                       "x",
                                       std::string(300, 'n'),
                                       std::string(301, 'n'),
                                       "A",
                                       "a"};
  std::set<std::string> files;
  for (const auto& name : names) files.insert(file_name_for(name));
  EXPECT_EQ(files.size(), names.size());
}

class AnyName : public testing::TestWithParam<std::string> {};

TEST_P(AnyName, MakesAFileNameThatStaysInItsFolder) {
  const std::string file = file_name_for(GetParam());
  EXPECT_FALSE(file.empty());
  EXPECT_LE(file.size(), 80U);
  EXPECT_NE(file.front(), '.');
  EXPECT_EQ(file.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-."), std::string::npos) << file;
  EXPECT_EQ(file, file_name_for(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(EachKind, AnyName,
                         testing::Values("../../x", "..", ".", "", "/etc/passwd", ".hidden", "a\nb", "'; touch x", "试验一", "\xff\xfe",
                                         std::string(5000, 'n'), std::string(79, 'a') + "é"),
                         [](const auto& i) { return std::to_string(i.index); });

TEST(FileSuffix, IsNothingForTheFirstAndTheNameOfEachOther) {
  EXPECT_EQ(file_suffix(0, "day one"), "");
  EXPECT_EQ(file_suffix(1, "second"), "_second");
  EXPECT_EQ(file_suffix(2, "a/b"), "_" + file_name_for("a/b"));
}

TEST(UniqueName, TakesTheFirstThatIsFree) {
  std::set<std::string> taken{"a", "a_2"};
  EXPECT_EQ(unique_name("b", taken), "b");
  EXPECT_EQ(unique_name("a", taken), "a_3");
  EXPECT_EQ(unique_name("a", taken, "."), "a.2");
  EXPECT_TRUE(taken.contains("a_3"));
}

}  // namespace
}  // namespace misfit
