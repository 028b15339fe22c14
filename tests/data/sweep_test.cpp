#include "misfit/data/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

std::string error_of(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.write("sweep.csv", content);
  return message_of<InputError>([&] { (void)read_sweep(file); });
}

TEST(ReadSweep, ReadsBothCoordinatesOfThreePoints) {
  const Sweep sweep = read_sweep(paths::source() / "tests/data/files/static_sweep.csv");
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

TEST(ReadSweep, APositionBeyondAnyImageIsRefused) {
  const std::string head = "theta[deg],P_1z[px],P_2y[px],P_2z[px],P_3z[px]\n0,1,2,3,4\n";
  expect_parts(error_of(head + "1,1e300,2,3,4\n"), {"sweep.csv:3", "P_1z", "1e+300 px", "100000 px"});
  expect_parts(error_of(head + "1,1,-1e6,3,4\n"), {"sweep.csv:3", "P_2y", "-1000000"});
  EXPECT_NO_THROW((void)read_sweep(TemporaryFolder().write("s.csv", "theta[deg],P_1z[px],P_2z[px],P_3z[px]\n0,100000,,-100000\n")));
}

TEST(ReadSweep, FiveThousandRowsAreTheMost) {
  std::string text = "theta[deg],P_1z[px],P_2z[px],P_3z[px]\n";
  for (int i = 0; i < 5000; ++i) text += "1,2,3,4\n";
  EXPECT_EQ(read_sweep(TemporaryFolder().write("s.csv", text)).theta.size(), 5000U);
  expect_parts(error_of(text + "1,2,3,4\n"), {"sweep.csv", "5001 rows", "at most 5000"});
}

TEST(ReadSweep, KnowsItsFile) {
  const TemporaryFolder folder;
  const auto file = folder.write("s.csv", "theta[deg],P_1z[px],P_2z[px],P_3z[px]\n0,1,2,3\n");
  EXPECT_EQ(read_sweep(file).source, file.string());
}

TEST(ReadSweepPictures, NulInAFileNameIsRefused) {
  const TemporaryFolder folder;
  folder.write("a.png", "x");
  const auto file = folder.write("p.csv", std::string("theta[deg],file\n1,a.png\0x\n", 26));
  expect_parts(message_of<InputError>([&] { (void)read_sweep_pictures(file); }), {"p.csv:2", "'file'", "NUL"});
}

TEST(ReadSweepPictures, ManyRowsTakeNoQuadraticTime) {
  const TemporaryFolder folder;
  folder.write("a.png", "x");
  std::string text = "theta[deg],file\n";
  for (int i = 0; i < 50'000; ++i) text += "1,a.png\n";
  EXPECT_EQ(read_sweep_pictures(folder.write("p.csv", text)).size(), 50'000U);
}

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
