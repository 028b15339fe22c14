#include "misfit/core/toml_text.h"

#include <gtest/gtest.h>

#include "misfit/core/config.h"
#include "misfit/core/utf8.h"

namespace misfit {
namespace {

/// Texts that have broken a line, a string or a parser somewhere.
std::vector<std::string> hostile_texts() {
  return {"",
          " ",
          "plain",
          "a b",
          "a.b",
          "-",
          "1e5",
          "true",
          "quote \" inside",
          "it's",
          "'''",
          "\"\"\"",
          "back\\slash",
          "ends in \\",
          "\\u0041",
          "line\nbreak",
          "\r\n",
          "\n[effects]\nx = {}\n",
          "\" ]\n[system]\nkind = \"other\" #",
          "tab\there",
          std::string("nul\0inside", 10),
          "\x01\x02\x1b[31m\x07",
          "delete \x7f",
          "next line \xC2\x85 and \xE2\x80\xA8",
          "\xE8\xAF\x95\xE9\xAA\x8C",
          "\xF0\x9F\x98\x80",
          "# no comment",
          "{ a = 1 }",
          "$(touch x) `y` %s%n",
          std::string(5000, 'n')};
}

class HostileText : public testing::TestWithParam<std::string> {};

TEST_P(HostileText, AsAStringReadsBackToItselfOnOneLine) {
  const std::string text = toml_string(GetParam());
  EXPECT_EQ(text.find_first_of("\n\r"), std::string::npos) << text;
  const auto section = config::Section::parse("a = " + text + "\nb = 1\n", "text");
  EXPECT_EQ(section.text("a"), GetParam());
  EXPECT_EQ(section.keys().size(), 2U);
}

TEST_P(HostileText, AsAKeyReadsBackToItself) {
  const auto section = config::Section::parse("first = 1\n" + toml_key(GetParam()) + " = { x = 1 }\n", "text");
  EXPECT_EQ(section.keys(), (std::vector<std::string>{"first", GetParam()}));
}

TEST_P(HostileText, AsACommentAddsNothing) {
  const auto section = config::Section::parse("a = 1  # " + toml_comment(GetParam()) + "\nb = 2\n", "text");
  EXPECT_EQ(section.keys(), (std::vector<std::string>{"a", "b"}));
}

INSTANTIATE_TEST_SUITE_P(EachKind, HostileText, testing::ValuesIn(hostile_texts()), [](const auto& i) { return std::to_string(i.index); });

class NoUtf8 : public testing::TestWithParam<std::string> {};

TEST_P(NoUtf8, IsStillTomlThatParses) {
  EXPECT_FALSE(is_utf8(GetParam()));
  EXPECT_TRUE(is_utf8(valid_utf8(GetParam())));
  const auto section =
      config::Section::parse(toml_key(GetParam()) + " = " + toml_string(GetParam()) + " # " + toml_comment(GetParam()) + "\n", "text");
  ASSERT_EQ(section.keys(), std::vector<std::string>{valid_utf8(GetParam())});
  EXPECT_EQ(section.text(section.keys().front()), valid_utf8(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(EachKind, NoUtf8,
                         testing::Values("\xff", "a\xe4se", "cut \xE8\xAF", "\xC0\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80",
                                         "\xF0\x80\x80\x80", "\x80", "\xF4\x90\x80\x80"),
                         [](const auto& i) { return std::to_string(i.index); });

TEST(TomlKey, StaysBareWhereItMay) {
  EXPECT_EQ(toml_key("C_m"), "C_m");
  EXPECT_EQ(toml_key("a-1"), "a-1");
  EXPECT_EQ(toml_key("gravity.g"), "\"gravity.g\"");
}

}  // namespace
}  // namespace misfit
