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
  expect("x1", "x1", "");
  expect("a_b", "a_b", "");
  EXPECT_EQ(read_header("Flow [l/min]").not_understood, "l/min");
  EXPECT_EQ(read_header("1st \xC3\xA4ngle").name, "c1st_ngle");
}

}  // namespace
}  // namespace misfit
