#include "misfit/show/blocks.h"

#include <gtest/gtest.h>

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

TEST(Blocks, SentencesBeginWithACapitalLetterUnlessWithAName) {
  EXPECT_EQ(as_sentence("the trim is low"), "The trim is low.");
  EXPECT_EQ(as_sentence("strut_wake is missing!"), "strut_wake is missing!");
  EXPECT_EQ(as_sentence(""), "");
}

}  // namespace
}  // namespace misfit
