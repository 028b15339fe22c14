#include "misfit/data/uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/core/files.h"
#include "misfit/data/batch.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Uncertainty example() {
  Uncertainty u;
  u.method = "sliding_bin";
  u.runs = 10;
  u.failed = 2;
  u.seed = 3;
  u.failures = {{"no sample", 2}};
  u.perturbed = {{"R", "m", 3.0, 0.05, "normal, 3 sigma = 0.15 m", ""}};
  SpreadNumber trim;
  trim.name = "trim";
  trim.unit = "rad";
  trim.nominal = 12.0 * degree;
  trim.nominal_sigma = 0.1 * degree;
  trim.mean = 12.5 * degree;
  trim.sigma = 0.5 * degree;
  trim.count = 8;
  trim.shares = {{"R", 0.9, 0.01, -0.4 * degree}, {"calibration", 0.05, 0.01, nan}};
  trim.rest = 0.05;
  u.numbers = {trim};
  u.curves = {
      {"C_m", "alpha_T", "rad", "-", {degree, 2.0 * degree}, {0.1, 0.2}, {0.11, nan}, {0.01, nan}, {8.0, 0.0}, false, "driven", true}};
  u.notes = {"a note"};
  return u;
}

TEST(UncertaintyFile, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  const Uncertainty before = example();
  EXPECT_EQ(write_uncertainty(folder.path(), before), (std::vector<std::string>{"uncertainty.json", "uncertainty.csv"}));
  const Uncertainty after = read_uncertainty(folder.path());
  EXPECT_EQ(after.method, before.method);
  EXPECT_EQ(after.failures, before.failures);
  EXPECT_EQ(after.notes, before.notes);
  EXPECT_EQ(after.perturbed[0].distribution, before.perturbed[0].distribution);
  const SpreadNumber& trim = *after.find("trim");
  EXPECT_EQ(trim.unit, "rad");
  EXPECT_NEAR(trim.mean, 12.5 * degree, 1e-12);
  EXPECT_NEAR(trim.nominal_sigma, 0.1 * degree, 1e-12);
  EXPECT_NEAR(trim.shares[0].effect, -0.4 * degree, 1e-12);
  EXPECT_TRUE(std::isnan(trim.shares[1].effect));
  EXPECT_EQ(after.curves[0].x, before.curves[0].x);
  EXPECT_FALSE(after.curves[0].informative);
  EXPECT_EQ(after.curves[0].why, "driven");
  EXPECT_TRUE(after.curves[0].trimmed);
  EXPECT_EQ(after.find("slope of C_m"), nullptr);
}

TEST(UncertaintyFile, TheTableIsInDegreesWithItsBandAndGaps) {
  const TemporaryFolder folder;
  (void)write_uncertainty(folder.path(), example());
  EXPECT_EQ(read_file(folder.path() / "uncertainty.csv"),
            "curve,alpha_T[deg],mean[-],sigma[-],low[-],high[-],nominal[-],runs\nC_m,1,0.11,0.01,0.08,0.14,0.1,8\nC_m,2,,,,,0.2,0\n");
}

TEST(BatchFile, RowsComeBackAndTextsAreQuoted) {
  const TemporaryFolder folder;
  BatchRow row;
  row.study = "a";
  row.method = "m";
  row.status = "converged";
  row.message = "said \"no, never\"";
  row.values["trim"] = {10.0 * degree, 0.0, "rad"};
  row.rms["y"] = {2.0, 0.0, "V"};
  const std::vector<BatchRow> back = batch_rows_from(batch_rows_text({row}));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].message, row.message);
  EXPECT_EQ(back[0].values.at("trim").value, row.values.at("trim").value);
  write_batch(folder.path(), {{row}, {}});
  EXPECT_EQ(read_file(folder.path() / "batch.csv"),
            "study,method,status,trim[deg],trim_sigma[deg],rms of y[V],message\na,m,converged,10,,2,\"said \"\"no, never\"\"\"\n");
  EXPECT_THROW((void)batch_rows_from("{"), RunError);
}

}  // namespace
}  // namespace misfit
