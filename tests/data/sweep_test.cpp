#include "misfit/data/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

std::string error_of(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("sweep.csv", content);
  return message_of<InputError>([&] { (void)read_sweep(file); });
}

TEST(ReadSweep, ReadsBothCoordinatesOfThreePoints) {
  const Sweep sweep = read_sweep(std::filesystem::path(MISFIT_SOURCE_DIR) / "tests/data/files/static_sweep.csv");
  ASSERT_EQ(sweep.theta.size(), 25U);
  EXPECT_NEAR(sweep.theta.front(), -18.0 * std::numbers::pi / 180.0, 1e-15);
  EXPECT_EQ(sweep.P_y[0][0], 0.130);
  EXPECT_EQ(sweep.P_z[0][0], -330.724);
  EXPECT_EQ(sweep.P_z[2][1], 169.060);
}

TEST(ReadSweep, OneCoordinateAloneLeavesTheOtherEmpty) {
  const TemporaryFolder folder;
  const Sweep sweep = read_sweep(folder.write("s.csv", "theta[deg],P_1z[px],P_2z[px],P_2y[px],P_3z[px]\n0,1,,2,3\n"));
  EXPECT_TRUE(sweep.P_y[0].empty());
  EXPECT_EQ(sweep.P_y[1], (std::vector<double>{2.0}));
  EXPECT_TRUE(sweep.P_y[2].empty());
  EXPECT_TRUE(std::isnan(sweep.P_z[1][0]));
}

TEST(ReadSweep, AMissingColumnIsNamed) { expect_parts(error_of("theta[deg],P_1z[px],P_2z[px]\n0,1,2\n"), {"sweep.csv", "'P_3z'"}); }

TEST(ReadSweep, TextNamesLineAndColumn) {
  expect_parts(error_of("theta[deg],P_1z[px],P_2z[px],P_3z[px]\n0,1,2,3\n1,hidden,2,3\n"), {"sweep.csv:3", "'P_1z[px]'", "'hidden'"});
}

TEST(ReadSweep, AMissingAngleNamesTheLine) {
  expect_parts(error_of("theta[deg],P_1z[px],P_2z[px],P_3z[px]\n,1,2,3\n"), {"sweep.csv:2", "theta"});
}

TEST(ReadSweep, DegreesUnderAHeaderWithoutUnitAreNoticed) {
  expect_parts(error_of("theta,P_1z,P_2z,P_3z\n-18,1,2,3\n"), {"sweep.csv:2", "theta = -18 rad", "theta[deg]"});
}

TEST(ReadSweep, AWrongUnitIsRefused) { expect_parts(error_of("theta[deg],P_1z[m],P_2z[px],P_3z[px]\n0,1,2,3\n"), {"'P_1z[m]'", "'px'"}); }

TEST(ReadSweep, EmptyFilesAreRefused) {
  expect_parts(error_of(""), {"no header"});
  expect_parts(error_of("theta[deg],P_1z[px],P_2z[px],P_3z[px]\n"), {"no rows"});
}

}  // namespace
}  // namespace misfit
