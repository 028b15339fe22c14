#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formula/formulas.h"

namespace misfit {
namespace {

using namespace testing_formulas;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FormulaErrors, NamePlaceAndPart) {
  EXPECT_THAT(error_of("x + yy*n"), AllOf(HasSubstr("file.toml:7:14"), HasSubstr("'yy'"), HasSubstr("did you mean 'y'")));
  EXPECT_THAT(error_of("sqr(x)"), AllOf(HasSubstr("no function 'sqr'"), HasSubstr("did you mean 'sqrt'")));
}

TEST(FormulaErrors, SayWhatIsExpected) {
  EXPECT_THAT(error_of(""), HasSubstr("empty"));
  EXPECT_THAT(error_of("   "), HasSubstr("empty"));
  EXPECT_THAT(error_of("x +"), HasSubstr("a number, a name or '(' is expected, at the end"));
  EXPECT_THAT(error_of("(x + y"), HasSubstr("')' is expected"));
  EXPECT_THAT(error_of("x + y)"), HasSubstr("this ')' closes nothing"));
  EXPECT_THAT(error_of("2x"), HasSubstr("an operator is expected"));
  EXPECT_THAT(error_of("x ** 2"), HasSubstr("a power is written '^'"));
  EXPECT_THAT(error_of("x = y"), HasSubstr("no meaning"));
  EXPECT_THAT(error_of("x · y"), AllOf(HasSubstr("'·'"), HasSubstr("no meaning")));
  EXPECT_THAT(error_of("min(x)"), HasSubstr("min takes 2 or 3 arguments, not 1"));
  EXPECT_THAT(error_of("sin()"), HasSubstr("not 0"));
  EXPECT_THAT(error_of("1e999"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("if(a < n < 1, 1, 2)"), HasSubstr("cannot be chained"));
  EXPECT_THAT(error_of("and x"), HasSubstr("is expected"));
}

TEST(FormulaErrors, NameBothUnitsThatDoNotMatch) {
  EXPECT_THAT(error_of("x + v"), AllOf(HasSubstr("'x' [V]"), HasSubstr("'v' [V/s]"), HasSubstr("measure different things")));
  EXPECT_THAT(error_of("sqrt(x) + x"), AllOf(HasSubstr("[V^0.5]"), HasSubstr("[V]")));
  EXPECT_THAT(error_of("x + 1"), HasSubstr("needs a name under [parameters]"));
  EXPECT_THAT(error_of("sin(x)"), HasSubstr("needs a number or an angle"));
  EXPECT_THAT(error_of("x^n"), HasSubstr("then the exponent must be a number"));
  EXPECT_THAT(error_of("n^x"), HasSubstr("must have no unit"));
  EXPECT_THAT(error_of("max(x, k)"), HasSubstr("measure different things"));
  EXPECT_THAT(error_of("if(x > v, 1, 2)"), HasSubstr("measure different things"));
  EXPECT_THAT(error_of("if(x > 0, x, v)"), HasSubstr("measure different things"));
  EXPECT_THAT(error_of("abs(x, n)"), HasSubstr("measure different things"));
}

TEST(FormulaErrors, SayWhatTheNamesWithinMeasure) {
  EXPECT_THAT(error_of("x + n*v*v"), HasSubstr("'n*v*v' [V^2/s^2] measure different things (n [-], v [V/s])"));
  EXPECT_THAT(error_of("x + v"), testing::EndsWith("measure different things")) << "said already";
}

TEST(FormulaErrors, KeepConditionsAndNumbersApart) {
  EXPECT_THAT(error_of("if(x, 1, 2)"), HasSubstr("a condition as 'x > 0' is expected"));
  EXPECT_THAT(error_of("(x > 0) + 1"), HasSubstr("is no number"));
  EXPECT_THAT(error_of("n and a"), HasSubstr("a condition"));
}

TEST(FormulaUnits, GoThroughRootsAndPowers) {
  EXPECT_EQ(Made("sqrt(x)*k").unit(), "V^0.5/s");
  EXPECT_EQ(Made("x^2/v").unit(), "V s");
  EXPECT_EQ(Made("x*k - v").unit(), "V/s");
  EXPECT_EQ(Made("x^(1/3)").unit(), "V^0.333333");
  EXPECT_EQ(Made("x/y").unit(), "-");
  EXPECT_THAT(error_of("x^(1/3)*x^(2/3) + x"), IsEmpty());
  EXPECT_THAT(error_of("max(x - y, 0) + if(x > 0, 0, y)"), IsEmpty()) << "0 has every unit";
  EXPECT_THAT(error_of("sin(a + n) + sin(k*t)"), IsEmpty()) << "an angle is a number";
}

TEST(FormulaLimits, RefuseWhatIsTooLongOrTooDeep) {
  EXPECT_THAT(error_of(std::string(10000, 'x')), HasSubstr("10000 characters; at most 4096"));
  for (const char* open : {"(", "-", "sqrt(", "2^", "not "}) {
    std::string deep;
    for (int i = 0; i < 600; ++i) deep += open;
    EXPECT_THAT(error_of(deep + "x"), HasSubstr("nested more than 200 levels deep")) << open;
  }
  std::string wide = "n";
  for (int i = 0; i < 1000; ++i) wide += "+n";
  EXPECT_EQ(value(wide), 1001.0 * somewhere[4]);
}

TEST(FormulaLimits, DepthTwoHundredIsPossible) {
  std::string deep(190, '(');
  EXPECT_EQ(value(deep + "n" + std::string(190, ')')), somewhere[4]);
}

}  // namespace
}  // namespace misfit
