#include "misfit/show/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace misfit {
namespace {

TEST(Blocks, TextHasHeadingsTablesAndWarningsInTheirOrder) {
  Blocks blocks;
  blocks.heading("Candidate effects");
  blocks.paragraph("Missing: drag.", Tone::lead);
  blocks.figures("candidates");
  blocks.table({{{"effect"}, {"drop", Align::right}}, {{"drag", "9.5"}, {"coning", "120.0"}}});
  blocks.subheading("Remarks");
  blocks.list({{"one", "two"}});
  blocks.warnings({"few samples"});
  EXPECT_EQ(as_text(blocks),
            "Candidate effects\n"
            "Missing: drag.\n"
            "\n"
            "  effect   drop\n"
            "  ------  -----\n"
            "  drag      9.5\n"
            "  coning  120.0\n"
            "\n"
            "Remarks\n"
            "  one\n"
            "  two\n"
            "  ! few samples\n");
}

TEST(Blocks, WhatIsEmptyIsLeftOut) {
  Blocks blocks;
  blocks.paragraph("");
  blocks.list({});
  blocks.table({{{"effect"}}, {}});
  EXPECT_TRUE(blocks.all().empty());
}

TEST(Blocks, ATerminalGetsAnExcerptAndTheFileWithTheRest) {
  Blocks blocks;
  blocks.list({{"a", "b", "c"}, Tone::plain, {2, "all.json"}});
  blocks.list({{"d", "e"}, Tone::plain, {0, "more.json"}});
  EXPECT_EQ(as_text(blocks), "  a\n  b\n  … and 1 more in all.json\n  2 in more.json\n");
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0, here = 0;
  for (const char c : text) longest = std::max(longest, here = c == '\n' ? 0 : here + 1);
  return longest;
}

TEST(Blocks, ANarrowTerminalGetsNarrowLinesAndWholeTables) {
  Blocks blocks;
  blocks.paragraph("The residuals of the method are not white, since forces that it does not have drive the motion.", Tone::lead);
  blocks.table({{{"method"}, {"why it stopped"}, {"time [s]", Align::right}},
                {{"output_error", "the parameters no longer move by more than the tolerance", "12.5"}}});
  EXPECT_LE(longest_line(as_text(blocks, {60, 60, false})), 60U);
  EXPECT_GT(longest_line(as_text(blocks)), 60U);
  std::string words = as_text(blocks, {60, 60, false});
  for (const char* word : {"parameters", "longer", "tolerance", "12.5"}) EXPECT_NE(words.find(word), std::string::npos) << words;
}

TEST(Blocks, ColourIsOnlyWhereItIsAskedForAndTextsCannotBringTheirOwn) {
  Blocks blocks;
  blocks.heading("Verdict");
  blocks.paragraph("Missing: \033[2Jdrag.", Tone::lead);
  blocks.paragraph("misfit add study drag", Tone::command);
  EXPECT_EQ(as_text(blocks, {110, 110, true}),
            "\033[1mVerdict\033[0m\n\033[1;32mMissing: \\x1b[2Jdrag.\033[0m\n  \033[1mmisfit add study drag\033[0m\n");
  EXPECT_EQ(as_text(blocks).find("\033[1"), std::string::npos);
}

TEST(Blocks, AStageIsNamedOnceAndItsWordsStandBesideIt) {
  EXPECT_EQ(stage_line("fit", "one two three four five", {32, 32, false}),
            "  fit             one two three\n                  four five\n");
  EXPECT_EQ(stage_line("a_method_with_a_long_name", "done"), "  a_method_with_a_long_name done\n");
}

TEST(Blocks, SentencesBeginWithACapitalLetterUnlessWithAName) {
  EXPECT_EQ(as_sentence("the trim is low"), "The trim is low.");
  EXPECT_EQ(as_sentence("strut_wake is missing!"), "strut_wake is missing!");
  EXPECT_EQ(as_sentence(""), "");
}

}  // namespace
}  // namespace misfit
