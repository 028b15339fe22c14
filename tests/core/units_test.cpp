#include "misfit/core/units.h"

#include <gmock/gmock.h>

#include <numbers>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using Dimension = std::array<double, 6>;

TEST(ParseUnit, ReadsProductsQuotientsAndPowers) {
  EXPECT_EQ(parse_unit("kg m^2").dimension, (Dimension{2, 1, 0, 0, 0, 0}));
  EXPECT_EQ(parse_unit("N m").dimension, parse_unit("J").dimension);
  EXPECT_EQ(parse_unit("N*m").dimension, parse_unit("N·m").dimension);
  EXPECT_EQ(parse_unit("px/m").dimension, (Dimension{-1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(parse_unit("1/s").dimension, parse_unit("Hz").dimension);
  EXPECT_EQ(parse_unit("m2").dimension, (Dimension{2, 0, 0, 0, 0, 0}));
  EXPECT_EQ(parse_unit("s^-2").dimension, parse_unit("1/s^2").dimension);
  EXPECT_EQ(parse_unit(" m / s ").dimension, parse_unit("m/s").dimension);
}

TEST(ParseUnit, ReadsNegativePowersRightBehindAUnitAndAHyphenElsewhere) {
  EXPECT_EQ(parse_unit("m s-1").dimension, parse_unit("m/s").dimension);
  EXPECT_EQ(parse_unit("W m-2 K-1").dimension, parse_unit("W/m^2/K").dimension);
  EXPECT_DOUBLE_EQ(parse_unit("min-1").to_si, 1.0 / 60.0);
  EXPECT_DOUBLE_EQ(parse_unit("km h-1").to_si, 1.0 / 3.6);
  EXPECT_EQ(parse_unit("m s−1").dimension, parse_unit("m/s").dimension) << "the sign minus";
  EXPECT_EQ(parse_unit("m³ s⁻¹").dimension, parse_unit("m^3/s").dimension);
  EXPECT_EQ(unit_in_si("l min-1"), "m^3/s");
  EXPECT_EQ(parse_unit("N-m").dimension, parse_unit("N m").dimension);
  EXPECT_THAT(message_of<InputError>([] { (void)parse_unit("m s -1"); }),
              testing::HasSubstr("a negative power stands right behind its unit"));
}

TEST(ParseUnit, DividesByTheOneFactorThatFollows) {
  EXPECT_EQ(parse_unit("kg/m s").dimension, (Dimension{-1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(parse_unit("kg/m/s").dimension, (Dimension{-1, 1, -1, 0, 0, 0}));
}

TEST(ParseUnit, HasTheFactorsOfTheBooks) {
  EXPECT_DOUBLE_EQ(parse_unit("in").to_si, 0.0254);
  EXPECT_DOUBLE_EQ(parse_unit("deg").to_si, std::numbers::pi / 180.0);
  EXPECT_NEAR(parse_unit("psf").to_si, 47.880258980336, 1e-11);  // NIST SP 811
  EXPECT_NEAR(parse_unit("psi").to_si, 6894.757293168, 1e-8);    // NIST SP 811
  EXPECT_NEAR(parse_unit("lbf").to_si, 4.4482216152605, 1e-13);  // NIST SP 811
  EXPECT_DOUBLE_EQ(parse_unit("%").to_si, 0.01);
  EXPECT_DOUBLE_EQ(parse_unit("ppm").to_si, 1e-6);
  EXPECT_TRUE(parse_unit("H").same_dimension(parse_unit("V s/A")));
  EXPECT_DOUBLE_EQ(parse_unit("ft^2").to_si, 0.3048 * 0.3048);
}

TEST(ParseUnit, RelatesElectricalUnits) {
  EXPECT_EQ(parse_unit("V A").dimension, parse_unit("W").dimension);
  EXPECT_EQ(parse_unit("V/A").dimension, parse_unit("Ohm").dimension);
  EXPECT_DOUBLE_EQ(parse_unit("mV").to_si, 1e-3);
}

TEST(ParseUnit, CountsAmountsOfSubstance) {
  EXPECT_DOUBLE_EQ(parse_unit("kmol/m^3").to_si, parse_unit("mol/l").to_si);
  EXPECT_EQ(parse_unit("mmol").dimension, Dimension{});
  EXPECT_EQ(parse_unit("kOhm").to_si, 1000.0 * parse_unit("ohm").to_si);
  EXPECT_NEAR(parse_unit("mg/dL").to_si, 0.01, 1e-15) << "kg/m^3";
  EXPECT_NEAR(parse_unit("mL/min").to_si, 1e-6 / 60.0, 1e-20);
  EXPECT_TRUE(parse_unit("mOhm uF").same_dimension(parse_unit("s")));
  EXPECT_NEAR(parse_unit("mOhm uF").to_si, 1e-9, 1e-22);
}

TEST(ParseUnit, TakesNothingAndADashAsDimensionless) {
  for (const char* text : {"", "-", "%", "1", "rad", "deg"}) EXPECT_EQ(parse_unit(text).dimension, Dimension{}) << text;
}

TEST(ParseUnit, ReadsSignsAsTheirLetters) {
  EXPECT_DOUBLE_EQ(parse_unit("°/s").to_si, parse_unit("deg/s").to_si);
  EXPECT_DOUBLE_EQ(parse_unit("µs").to_si, 1e-6);
  EXPECT_EQ(plain_unit("\xC2\xB0"
                       "C"),
            "degC");
  EXPECT_EQ(plain_unit("m/s²"), "m/s^2");
  EXPECT_EQ(plain_unit("kΩ"), "kOhm");
  EXPECT_EQ(plain_unit("é"), "é");
}

TEST(ParseUnit, HasTheFactorsOfLogs) {
  EXPECT_DOUBLE_EQ(parse_unit("rpm").to_si, 2.0 * std::numbers::pi / 60.0);
  EXPECT_DOUBLE_EQ(parse_unit("km/h").to_si, 1.0 / 3.6);
  EXPECT_DOUBLE_EQ(parse_unit("ns").to_si, 1e-9);
  EXPECT_DOUBLE_EQ(parse_unit("kW").to_si, 1e3);
  EXPECT_DOUBLE_EQ(parse_unit("mA").to_si, 1e-3);
  EXPECT_EQ(parse_unit("kWh").dimension, parse_unit("J").dimension);
  EXPECT_EQ(parse_unit("l/min").dimension, parse_unit("m^3/s").dimension);
}

TEST(Temperature, IsShiftedWhereItStandsAloneAndNotAsADifference) {
  EXPECT_DOUBLE_EQ(convert(20.0, "degC", "K"), 293.15);
  EXPECT_DOUBLE_EQ(convert(212.0, "degF", "degC"), 100.0);
  EXPECT_DOUBLE_EQ(convert(1.0, "degC/s", "K/s"), 1.0);
  EXPECT_DOUBLE_EQ(convert_difference(9.0, "degF", "degC"), 5.0);
  expect_parts(message_of<InputError>([] { (void)parse_quantity("20 degC"); }), {"293.15 K", "difference, 20 K"});
}

TEST(UnitInSi, ReplacesEverySymbol) {
  EXPECT_EQ(unit_in_si("deg/s"), "rad/s");
  EXPECT_EQ(unit_in_si("kPa"), "Pa");
  EXPECT_EQ(unit_in_si("rpm/V"), "rad/s/V");
  EXPECT_EQ(unit_in_si("1/rpm"), "s/rad");
  EXPECT_EQ(unit_in_si("degC"), "K");
  EXPECT_EQ(unit_in_si("km/h"), "m/s");
  EXPECT_EQ(unit_in_si("%"), "-");
  EXPECT_EQ(unit_in_si("m/s/s"), "m/s^2");
}

TEST(ParseUnit, KnowsAnAngle) {
  EXPECT_TRUE(parse_unit("deg").angle);
  EXPECT_TRUE(parse_unit("rad/s").angle);
  EXPECT_FALSE(parse_unit("rad^2").angle);
  EXPECT_FALSE(parse_unit("N m/rad").angle);
  EXPECT_FALSE(parse_unit("-").angle);
}

TEST(ParseUnit, NamesAnUnknownPartAndTheNearest) {
  expect_parts(message_of<InputError>([] { (void)parse_unit("kgs m"); }), {"unknown unit 'kgs' in 'kgs m'", "did you mean 'kg'"});
  expect_parts(message_of<InputError>([] { (void)parse_unit("§"); }), {"unknown unit '§'", "valid: m, mm"});
}

TEST(ParseUnit, SaysWhatToWriteForWhatHasAnotherNameHere) {
  const auto refusal = [](const char* text) { return message_of<InputError>([text] { (void)parse_unit(text); }); };
  expect_parts(refusal("C"), {"unknown unit 'C'", "degC is of temperatures, A s of charges"});
  expect_parts(refusal("mAh"), {"a charge: A h"});
  expect_parts(refusal("V/(A s)"), {"units have no brackets", "V/A/s"});
}

TEST(ParseUnit, RefusesWhatIsNotAUnit) {
  for (const char* text : {"/s", "m/", "m//s", "m**s", "*m", "m^", "m^x", "m^99", "m^99999999999", "^2", "3 m"}) {
    EXPECT_THROW((void)parse_unit(text), InputError) << text;
  }
}

TEST(ParseQuantity, ReadsANumberWithItsUnit) {
  const Quantity size = parse_quantity("24 in");
  EXPECT_DOUBLE_EQ(size.value, 0.6096);
  EXPECT_EQ(size.unit, "in");
  EXPECT_DOUBLE_EQ(parse_quantity(" +1.5e3 Pa ").value, 1500.0);
  EXPECT_DOUBLE_EQ(parse_quantity("-2deg").value, -2.0 * std::numbers::pi / 180.0);
}

TEST(ParseQuantity, LeavesABareNumberAsWritten) {
  EXPECT_EQ(parse_quantity("24").value, 24.0);
  EXPECT_EQ(parse_quantity("24").unit, "");
}

TEST(ParseQuantity, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"", "in", "inf m", "nan", "1e999 m", "+-3", "--3", "1.2.3 m", "1,5 m"}) {
    EXPECT_THROW((void)parse_quantity(text), InputError) << text;
  }
}

TEST(Convert, GoesBetweenUnitsOfOneDimension) {
  EXPECT_NEAR(convert(180.0, "deg", "rad"), std::numbers::pi, 1e-15);
  EXPECT_DOUBLE_EQ(convert(1.0, "ft", "in"), 12.0);
  EXPECT_EQ(convert(0.1, "m", "m"), 0.1);
}

TEST(Convert, RefusesAnotherDimension) {
  expect_parts(message_of<InputError>([] { (void)convert(24.0, "kg", "m"); }), {"'kg'", "'m'"});
}

TEST(DisplayUnit, ShowsAnglesInDegrees) {
  EXPECT_EQ(display_unit("rad"), "deg");
  EXPECT_EQ(display_unit("rad/s"), "deg/s");
  EXPECT_EQ(display_unit("rad/s^2"), "deg/s^2");
  EXPECT_EQ(display_unit("N m"), "N m");
}

TEST(UnitText, WritesFactorsAsTheyAreRead) {
  EXPECT_EQ(unit_text({}), "-");
  EXPECT_EQ(unit_text({{"V", 0.5}, {"s", -1.0}}), "V^0.5/s");
  EXPECT_EQ(unit_text({{"s", -2.0}}), "1/s^2");
  EXPECT_EQ(unit_text({{"m", 1.0 / 3.0 + 1.0 / 3.0 + 1.0 / 3.0}, {"kg", 1e-9}}), "m") << "powers gather rounding";
}

TEST(InRadians, IsTheUnitOfAnAngleThatIsShownInRadians) {
  for (const auto& [si, own] : std::vector<std::pair<std::string, std::string>>{{"rad", "radian"},
                                                                                {"rad/s", "radian/s"},
                                                                                {"rad/s^2", "radian/s^2"},
                                                                                {"radian/s", "radian/s"},
                                                                                {"rad/s^3", "rad/s^3"},
                                                                                {"V", "V"},
                                                                                {"V/rad", "V/rad"}}) {
    EXPECT_EQ(in_radians(si), own);
    EXPECT_DOUBLE_EQ(parse_unit(own).to_si, 1.0) << own;
  }
  for (const std::string own : {"radian", "radian/s", "radian/s^2"}) {
    EXPECT_EQ(display_unit(own), "rad" + own.substr(6));
    EXPECT_EQ(si_unit(display_unit(own)), own) << "a file that was written is read back";
    EXPECT_EQ(si_unit(display_unit("rad" + own.substr(6))), "rad" + own.substr(6));
  }
  EXPECT_EQ(rate_unit("radian"), "radian/s");
  EXPECT_EQ(rate_unit("radian/s"), "radian/s^2");
  EXPECT_EQ(unit_text({{"V", 1.0}, {"radian", -1.0}}), "V/rad");
}

struct Shown {
  std::string unit, inside, si, rate;
};

TEST(ShownIn, IsTheInsideUnitOfWhatIsShownInAnother) {
  for (const auto& [unit, inside, si, rate] :
       std::vector<Shown>{{"kW", "W (shown in kW)", "W", "W/s (shown in kW/s)"},
                          {"rpm", "radian/s (shown in rpm)", "rad/s", "radian/s^2 (shown in rpm/s)"},
                          {"U/min", "radian/s (shown in rpm)", "rad/s", "radian/s^2 (shown in rpm/s)"},
                          {"km/h", "m/s (shown in km/h)", "m/s", "m/s^2 (shown in km/h/s)"},
                          {"mg/l", "kg/m^3 (shown in mg/l)", "kg/m^3", "kg/m^3/s (shown in mg/l/s)"},
                          {"N", "N", "N", "N/s"},
                          {"rad/s", "radian/s", "rad/s", "radian/s^2"}}) {
    EXPECT_EQ(shown_in(unit), inside);
    EXPECT_EQ(plain_si(inside), si);
    EXPECT_EQ(rate_unit(inside), rate);
    EXPECT_EQ(display_unit(inside), plain_unit(unit));
    EXPECT_EQ(display_level_unit(inside), plain_unit(unit));
    EXPECT_EQ(si_unit(stored_unit(inside)), inside) << "a file that was written is read back";
    EXPECT_EQ(si_unit(stored_unit(rate)), rate);
    EXPECT_DOUBLE_EQ(convert(3.0, unit, inside), convert(3.0, unit, si));
    EXPECT_TRUE(parse_unit(rate).same_dimension(parse_unit(display_unit(rate))));
  }
  EXPECT_EQ(display_unit("W (shown in kW)/K"), "W/K") << "of several factors";
  EXPECT_EQ(unit_symbols("W (shown in kW)/K"), unit_symbols("W/K"));
  EXPECT_EQ(si_unit("dB"), "dB");
  EXPECT_EQ(si_unit("%"), "%") << "a share is none of another unit";
}

TEST(ShownIn, ATemperatureIsShownInDegreesAndItsDifferencesInKelvin) {
  const std::string inside = shown_in("°C");
  EXPECT_EQ(inside, "K (shown in degC)");
  EXPECT_EQ(display_level_unit(inside), "degC");
  EXPECT_EQ(display_unit(inside), "K");
  EXPECT_EQ(rate_unit(inside), "K/s");
  EXPECT_EQ(si_unit(stored_unit(inside)), inside);
  EXPECT_DOUBLE_EQ(display_level(293.15, inside), 20.0);
  EXPECT_DOUBLE_EQ(display_value(0.05, inside), 0.05);
  EXPECT_EQ(in_display_unit(0.05, inside), "0.05 K");
  EXPECT_EQ(in_level_unit(293.15, inside), "20 degC");
  EXPECT_THAT(display_levels({273.15, 283.15}, inside), testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 10.0}));
}

TEST(ShownIn, PerCentIsStoredInFull) {
  const std::string inside = shown_in("%");
  EXPECT_EQ(inside, "- (shown in %)");
  EXPECT_EQ(display_unit(inside), "%");
  EXPECT_DOUBLE_EQ(display_value(0.42, inside), 42.0);
  EXPECT_EQ(si_unit(stored_unit(inside)), inside);
  EXPECT_EQ(rate_unit(inside), "1/s (shown in %/s)");
}

}  // namespace
}  // namespace misfit
