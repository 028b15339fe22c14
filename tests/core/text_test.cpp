#include "misfit/core/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace misfit {
namespace {

TEST(FormatInterval, IsToTheDigitsOfSigma) {
  EXPECT_EQ(format_interval(26.1048, 29.5692, 0.88), "26.10 to 29.57");
  EXPECT_EQ(format_interval(0.077433, 0.10749, 0.0076), "0.0774 to 0.1075");
  EXPECT_EQ(format_interval(1.0, 2.0, 0.0), "1 to 2");
  EXPECT_EQ(format_interval(1.23e7, 1.31e7, 2e5), "1.23e+07 to 1.31e+07");
}

TEST(FormatToStep, HasTheDigitsThatAStepTakes) {
  EXPECT_EQ(format_to_step(101324.9, 1.0), "101325");
  EXPECT_EQ(format_to_step(1.3249, 0.1), "1.3");
  EXPECT_EQ(format_to_step(-0.04, 0.1), "0");
  EXPECT_EQ(format_to_step(1700000012.34, 0.1), "1700000012.3");
  EXPECT_EQ(format_to_step(3.1234e-9, 1e-11), "3.12e-09");
}

TEST(FormatValue, GivesSigmaTwoDigitsAndTheValueTheSamePlace) {
  EXPECT_EQ(format_value(12.0312, 0.21), "12.03 ± 0.21");
  EXPECT_EQ(format_value(-0.6, 0.0456), "-0.600 ± 0.046");
  EXPECT_EQ(format_value(41.2, 6.0), "41.2 ± 6.0");
  EXPECT_EQ(format_value(0.0, 25.0), "0 ± 25");
}

TEST(FormatValue, CountsTheDigitsAfterRounding) {
  EXPECT_EQ(format_value(3.14159, 0.0996), "3.14 ± 0.10");
  EXPECT_EQ(format_value(3.14159, 9.96), "3 ± 10");
}

TEST(FormatValue, RoundsToTensAndHundredsUnderALargeSigma) { EXPECT_EQ(format_value(12345.0, 678.0), "12350 ± 680"); }

TEST(FormatValue, WritesNoMinusBeforeZero) { EXPECT_EQ(format_value(-0.001, 0.25), "0.00 ± 0.25"); }

TEST(FormatValue, FactorsOutAPowerOfTenFarFromOne) {
  EXPECT_EQ(format_value(1.2347e-7, 2.1e-9), "(1.235 ± 0.021)e-7");
  EXPECT_EQ(format_value(2.5e9, 1.0e8), "(2.50 ± 0.10)e9");
}

TEST(FormatValue, WithoutSigmaGivesFiveDigits) {
  EXPECT_EQ(format_value(3.14159265), "3.1416");
  EXPECT_EQ(format_value(3.14159265, std::numeric_limits<double>::infinity()), "3.1416");
  EXPECT_EQ(format_value(3.14159265, std::nan("")), "3.1416");
  EXPECT_EQ(format_value(3.14159265, -1.0), "3.1416");
}

TEST(FormatValue, SaysThatNanIsNotAvailable) { EXPECT_EQ(format_value(std::nan(""), 1.0), "not available"); }

TEST(AlignColumns, PadsUnderlinesAndCountsCodePoints) {
  EXPECT_EQ(align_columns({{"name", "value"}, {"C_m α", "1 ± 2"}, {"q", "3"}}, ""),
            "name   value\n"
            "-----  -----\n"
            "C_m α  1 ± 2\n"
            "q      3\n");
}

TEST(AlignColumns, AcceptsShorterAndLongerRows) {
  EXPECT_EQ(align_columns({{"a"}, {"b", "note"}, {}}, "  "), "  a\n  -\n  b  note\n\n");
  EXPECT_EQ(align_columns({}), "");
}

TEST(WrapText, BreaksAtBlanksWithinTheWidth) {
  EXPECT_EQ(wrap_text("one two three four", 9), "one two\nthree\nfour");
  EXPECT_EQ(wrap_text("one two three", 7, "  "), "  one\n  two\n  three");
}

TEST(WrapText, CountsCodePointsNotBytes) { EXPECT_EQ(wrap_text("αβγ δεζ", 7), "αβγ δεζ"); }

TEST(WrapText, LeavesALongWordWhole) { EXPECT_EQ(wrap_text("a verylongword b", 6), "a\nverylongword\nb"); }

TEST(WrapText, KeepsParagraphs) { EXPECT_EQ(wrap_text("one\n\ntwo three", 5), "one\n\ntwo\nthree"); }

TEST(Counted, AgreesInNumber) {
  EXPECT_EQ(counted(0, "gap", "gaps"), "0 gaps");
  EXPECT_EQ(counted(1, "gap", "gaps"), "1 gap");
  EXPECT_EQ(counted(2, "gap", "gaps"), "2 gaps");
}

TEST(JoinWords, CommasAndAnAnd) {
  EXPECT_EQ(join_words({}), "");
  EXPECT_EQ(join_words({"a"}), "a");
  EXPECT_EQ(join_words({"a", "b"}), "a and b");
  EXPECT_EQ(join_words({"a", "b", "c"}), "a, b and c");
}

}  // namespace
}  // namespace misfit
