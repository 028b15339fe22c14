#include "misfit/data/reference.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

const FoldedAngle canopy{"alpha_T", "alpha", {"C_mq", "C_m_alphadot"}};

TEST(Reference, FoldsSignedAnglesByOddnessAndKeepsBothBranches) {
  const TemporaryFolder folder;
  const auto path = folder.write("static.csv", "alpha[deg],C_m[-],sigma[-]\n-10,-0.011,0.001\n0,0,0.001\n10,0.010,0.001\n14,-0.01,0.001\n");
  const Reference reference = read_reference(path, "C_m", "C_m", canopy);
  EXPECT_EQ(reference.name, "static");
  EXPECT_EQ(reference.of, "alpha_T");
  EXPECT_EQ(reference.of_unit, "rad");
  ASSERT_EQ(reference.x.size(), 4U);
  EXPECT_NEAR(reference.x[1], 10.0 * degree, 1e-15);
  EXPECT_DOUBLE_EQ(reference.value[1], 0.011);
  EXPECT_DOUBLE_EQ(reference.value[2], 0.010);
  ASSERT_EQ(reference.notes.size(), 1U);
  expect_parts(reference.notes[0], {"1 point", "alpha", "odd"});
}

TEST(Reference, ADampingCurveIsEven) {
  const TemporaryFolder folder;
  const auto path = folder.write("damping.csv", "alpha[deg],C_m_alphadot[-]\n-10,0.2\n10,0.3\n");
  const Reference reference = read_reference(path, "C_m_alphadot", "C_m", canopy);
  EXPECT_EQ(reference.value, (std::vector<double>{0.2, 0.3}));
  EXPECT_FALSE(reference.trim.has_value());
}

TEST(Reference, TheStaticTestOfTheCanopyTrimsNearThirteenDegrees) {
  // The four means about the crossing: 0.0128 at 10.5, 0.0046 at 12, −0.0030 at 13.5, −0.0151 at 15 deg: zero at 12.9 by straight
  // interpolation.
  const Reference reference = read_reference(paths::source() / "tests/data/files/static_test.csv", "C_m", "C_m", canopy);
  ASSERT_TRUE(reference.trim.has_value());
  EXPECT_EQ(reference.x.size(), 25U);
  EXPECT_NEAR(reference.trim->value, 12.9 * degree, 0.15 * degree);
  EXPECT_GT(reference.trim->sigma, 0.03 * degree);
  EXPECT_LT(reference.trim->sigma, 0.2 * degree);
}

TEST(Reference, ATruthWithoutSigmasHasATrimWithoutOne) {
  const TemporaryFolder folder;
  std::string text = "alpha_T[deg],C_m[-]\n";
  for (int deg = 0; deg <= 20; ++deg)
    text += fmt::format("{},{:.6f}\n", deg, std::sin(deg * degree) * (std::cos(deg * degree) - std::cos(12.0 * degree)));
  const Reference reference = read_reference(folder.write("truth.csv", text), "C_m", "C_m", canopy);
  ASSERT_TRUE(reference.trim.has_value());
  EXPECT_NEAR(reference.trim->value, 12.0 * degree, 0.01 * degree);
  EXPECT_EQ(reference.trim->sigma, 0.0);
}

TEST(Reference, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto wrong = folder.write("wrong.csv", "alpha[deg],C_n[-]\n1,2\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(wrong, "C_m")); }), {"wrong.csv", "C_m", "C_n"});
  const auto sigma = folder.write("sigma.csv", "alpha[deg],C_m[-],sigma[-]\n1,2,0.1\n2,1,0\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(sigma, "C_m")); }), {"sigma.csv:3", "sigma", "positive"});
  const auto empty = folder.write("empty.csv", "alpha[deg],C_m[-]\n1,\n");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_reference(empty, "C_m")); }), {"empty.csv", "no row"});
}

}  // namespace
}  // namespace misfit
