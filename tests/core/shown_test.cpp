#include "misfit/core/shown.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "misfit/core/edit_distance.h"
#include "misfit/core/error.h"

namespace misfit {
namespace {

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & '\xC0') != '\x80'; }));
}

struct Raw {
  const char* name;
  std::string text, plain, json;
};

void PrintTo(const Raw& raw, std::ostream* out) { *out << raw.name; }

class RawText : public testing::TestWithParam<Raw> {};

TEST_P(RawText, GoesToATerminalAsEscapes) {
  EXPECT_EQ(printable(GetParam().text), GetParam().plain);
  EXPECT_EQ(printable(GetParam().text, Escapes::json), GetParam().json);
}

INSTANTIATE_TEST_SUITE_P(
    EachKind, RawText,
    testing::Values(Raw{"Plain", "a b", "a b", "a b"}, Raw{"Empty", "", "", ""}, Raw{"NewlineAndTab", "a\n\tb", "a\n\tb", "a\n\tb"},
                    Raw{"Escape", "\x1b[2J", "\\x1b[2J", "\\u001b[2J"}, Raw{"Nul", std::string("a\0b", 3), "a\\x00b", "a\\u0000b"},
                    Raw{"Bell", "\a", "\\x07", "\\u0007"}, Raw{"CarriageReturn", "a\rb", "a\\x0db", "a\\u000db"},
                    Raw{"Delete", "\x7f", "\\x7f", "\\u007f"}, Raw{"C1", "\xC2\x9B[2J", "\\x9b[2J", "\\u009b[2J"},
                    Raw{"NoBreakSpaceIsNoControl", "\xC2\xA0", "\xC2\xA0", "\xC2\xA0"},
                    Raw{"LettersOfOtherScripts", "ä 试 😀", "ä 试 😀", "ä 试 😀"}, Raw{"Latin1", "\xE4 x", "\\xe4 x", "\\u00e4 x"},
                    Raw{"CutCharacter", "\xE8\xAF", "\\xe8\\xaf", "\\u00e8\\u00af"}, Raw{"ContinuationAlone", "\x9B", "\\x9b", "\\u009b"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Shown, LeavesAShortTextAsItIs) { EXPECT_EQ(shown("flight.mkv"), "flight.mkv"); }

TEST(Shown, PutsEverythingOnOneLine) { EXPECT_EQ(shown("a\nb\tc\x1b"), "a\\nb\\tc\\x1b"); }

TEST(Shown, ShortensALongTextToAsManyCharacters) {
  EXPECT_EQ(shown("abcdefgh", 5), "abcd…");
  EXPECT_EQ(shown("abcde", 5), "abcde");
  EXPECT_EQ(shown("äöüäöü", 4), "äöü…");
  EXPECT_EQ(characters(shown(std::string(8'000'000, 'x'))), longest_quote);
  EXPECT_LE(characters(shown(std::string(1000, '\x1b'))), longest_quote);
}

TEST(Shortened, KeepsPlaceAndEndOfAMessage) {
  const std::string message = "study.toml:3:1: '" + std::string(8'000'000, 'x') + "' — valid: a, b";
  const std::string cut = shortened(message);
  EXPECT_LE(characters(cut), longest_message);
  EXPECT_TRUE(cut.starts_with("study.toml:3:1: 'xxx"));
  EXPECT_TRUE(cut.ends_with("xxx' — valid: a, b"));
  EXPECT_NE(cut.find(" … "), std::string::npos);
}

TEST(Shortened, CutsNoCharacterInTwo) {
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::string message(shift, 'a');
    for (int i = 0; i < 400; ++i) message += "试";
    const std::string cut = shortened(message);
    EXPECT_LE(characters(cut), longest_message);
    EXPECT_EQ(printable(cut), cut) << shift;
  }
}

TEST(Shortened, LeavesAMessageThatFits) {
  const std::string message(longest_message, 'x');
  EXPECT_EQ(shortened(message), message);
}

std::vector<std::string> many_names(int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back("parameter_" + std::to_string(i));
  return names;
}

TEST(SomeNames, NamesAFewInTheirOrder) { EXPECT_EQ(some_names("x", {"b", "a", "c"}), "b, a, c"); }

TEST(SomeNames, OfManyTheNearestFirstAndHowManyMore) {
  const std::string list = some_names("parameter_77x", many_names(100));
  EXPECT_TRUE(list.starts_with("parameter_77, "));
  EXPECT_LT(list.size(), 140U);
  EXPECT_EQ(list.substr(list.size() - 5), " more");
  const auto listed = static_cast<std::size_t>(std::count(list.begin(), list.end(), ','));
  EXPECT_NE(list.find("… and " + std::to_string(100 - listed) + " more"), std::string::npos) << list;
}

TEST(SomeNames, WithoutANearOneInTheirOrder) { EXPECT_TRUE(some_names("q", many_names(100)).starts_with("parameter_0, parameter_1, ")); }

TEST(Suggest, AHundredThousandNamesAreAShortMessage) {
  EXPECT_LT(suggest("parameter_77x", many_names(100'000)).size(), 200U);
  EXPECT_LT(suggest(std::string(8'000'000, 'x'), many_names(1000)).size(), 200U);
}

TEST(NearestName, IsNoneForATextThatIsNoName) { EXPECT_EQ(nearest_name(std::string(8'000'000, 'x'), {"x", "xx"}), ""); }

TEST(EditDistance, CountsChangesWithoutRegardToCapitals) {
  EXPECT_EQ(edit_distance("kitten", "SITTING"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("fti", "fit"), 1U) << "neighbours that changed places";
  EXPECT_EQ(edit_distance("abcd", "badc"), 2U);
  EXPECT_EQ(edit_distance("abc", "abc"), 0U);
  EXPECT_EQ(edit_distance(std::string(1'000'000, 'a'), "a"), 1'000'000U);
}

TEST(UnfinishedBytes, AreThoseOfTheLastCharacterAlone) {
  EXPECT_EQ(unfinished_bytes(""), 0U);
  EXPECT_EQ(unfinished_bytes("abc"), 0U);
  EXPECT_EQ(unfinished_bytes("试"), 0U);
  EXPECT_EQ(unfinished_bytes(std::string("试").substr(0, 2)), 2U);
  EXPECT_EQ(unfinished_bytes(std::string("😀").substr(0, 3)), 3U);
  EXPECT_EQ(unfinished_bytes("a\xC3"), 1U);
  EXPECT_EQ(unfinished_bytes("\x80\x80\x80\x80"), 0U);  // never ends: passed on as it is
}

}  // namespace
}  // namespace misfit
