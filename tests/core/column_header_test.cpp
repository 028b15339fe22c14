#include "misfit/core/column_header.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(ColumnHeader, NameAndUnitAreSeparated) {
  const auto expect = [](const char* header, const char* name, const char* unit) {
    const NameAndUnit read = read_header(header);
    EXPECT_EQ(read.name, name) << header;
    EXPECT_EQ(read.unit, unit) << header;
  };
  expect("t_s", "t", "s");
  expect("u_V", "u", "V");
  expect("omega1_radps", "omega1", "rad/s");
  expect("theta[deg]", "theta", "deg");
  expect("Druck (kPa)", "Druck", "kPa");
  expect("v_m_s", "v", "m/s");
  expect("torque_Nm", "torque", "N m");
  expect("Flow [l/min]", "Flow", "l/min");
  expect("timestamp [us]", "timestamp", "us");
  expect("time_ns", "time", "ns");
  expect(
      "Temperatur (\xC2\xB0"
      "C)",
      "Temperatur", "degC");
  expect(
      "Temperatur (\xB0"
      "C)",
      "Temperatur", "degC");  // Latin-1
  expect("angle [\xC2\xB0]", "angle", "deg");
  expect("rate [\xC2\xB0/s]", "rate", "deg/s");
  expect("t [\xC2\xB5s]", "t", "us");
  expect("speed_rpm", "speed", "rpm");
  expect("speed_kmh", "speed", "km/h");
  expect("P [kW]", "P", "kW");
  expect("t [sec]", "t", "s");
  expect("ms", "ms", "ms");
  expect("rpm", "rpm", "rpm");
  expect("seconds", "seconds", "s");
  expect("min", "min", "");  // the least, more often than a time
  expect("x1", "x1", "");
  expect("a_b", "a_b", "");
  EXPECT_EQ(read_header("Flow [gal/min]").not_understood, "gal/min");
  EXPECT_EQ(read_header("1st \xC3\xA4ngle").name, "c1st_aengle");
}

TEST(ColumnHeader, ASubscriptBehindALineIsNoUnit) {
  for (const char* header : {"temp_min", "T_min", "y_max", "T_s", "T_h", "T_m", "T_W", "T1_s", "temp_m"}) {
    EXPECT_EQ(read_header(header).name, header);
    EXPECT_EQ(read_header(header).unit, "") << header;
  }
  for (const char* header : {"t_min", "time_min", "Elapsed Time_min"}) EXPECT_EQ(read_header(header).unit, "min") << header;
  EXPECT_EQ(read_header("T_K").unit, "K");
  EXPECT_EQ(read_header("T_degC").unit, "degC");
  EXPECT_EQ(read_header("aussen °C").unit, "degC");
  EXPECT_EQ(read_header("aussen °C").name, "aussen");
  EXPECT_EQ(read_header("torque_Nm").unit, "N m");
  EXPECT_TRUE(read_header("p_s").of_one_letter);
  EXPECT_FALSE(read_header("p[s]").of_one_letter);
  EXPECT_FALSE(read_header("p_kPa").of_one_letter);
}

}  // namespace
}  // namespace misfit
