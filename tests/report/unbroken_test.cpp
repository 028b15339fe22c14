#include "misfit/report/unbroken.h"

#include <gtest/gtest.h>

#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

TEST(Unbroken, NoLineEndsBetweenAValueItsSigmaAndTheirUnit) {
  EXPECT_EQ(unbroken("friction = 100.03 ± 0.17 rad/s^2 and more"), "friction = 100.03\u00a0±\u00a00.17\u00a0rad/s^2 and more");
  EXPECT_EQ(unbroken("(1.2 ± 0.1)e7 N m, then"), "(1.2\u00a0±\u00a00.1)e7\u00a0N\u00a0m, then");
  EXPECT_EQ(unbroken("falls from 1.89 rad/s to 0.303 rad/s (84 %)."), "falls from 1.89\u00a0rad/s to 0.303\u00a0rad/s (84\u00a0%).");
  EXPECT_EQ(unbroken("139 px to 140 px (+0.6 %)"), "139\u00a0px to 140\u00a0px (+0.6\u00a0%)");
  EXPECT_EQ(unbroken("noise 0.2 1/s"), "noise 0.2\u00a01/s");
}

TEST(Unbroken, WordsBehindANumberAreNotItsUnit) {
  for (const char* text : {"32 samples ahead", "one of 3 in all", "rung 1, of 2", "experiment m s", ""}) EXPECT_EQ(unbroken(text), text);
  EXPECT_EQ(unbroken("4 N, m of it"), "4\u00a0N, m of it");  // the comma ends the unit
}

TEST(Unbroken, MinusSignsAreOfOneKindAndHyphensStay) {
  EXPECT_EQ(unbroken("between -53 rad/s and -7 rad/s (-84 %)"), "between −53\u00a0rad/s and −7\u00a0rad/s (−84\u00a0%)");
  EXPECT_EQ(unbroken("(p = 2.9e-60, drop = 3)"), "(p\u00a0=\u00a02.9e−60, drop = 3)");
  EXPECT_EQ(unbroken("-0.5 ± 0.1 deg"), "−0.5\u00a0±\u00a00.1\u00a0deg");
  for (const char* text : {"2026-11-27", "grey-box", "--to json", "3-5", "run_1-2", "parameters.k=-3"}) EXPECT_EQ(unbroken(text), text);
}

TEST(Unbroken, BytesThatAreNoTextStayAsTheyAre) {
  EXPECT_EQ(unbroken("\xff -\xff 1 \xff"), "\xff -\xff 1 \xff");
  EXPECT_EQ(unbroken("  two  blanks "), "  two  blanks ");
}

TEST(Unbroken, TypesetTextsAreAndCommandsAreNot) {
  EXPECT_EQ(html_text("-2 m/s^2"), "−2\u00a0m/s<sup>2</sup>");
  EXPECT_EQ(escape_html("misfit set STUDY k=-3 -2 m"), "misfit set STUDY k=-3 -2 m");
}

}  // namespace
}  // namespace misfit::report
