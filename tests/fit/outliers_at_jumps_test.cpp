#include "misfit/fit/filter/outliers_at_jumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

/// A hundred samples of a cell whose current jumps at every twentieth, and which of them are rejected.
std::string said_of(const std::vector<std::size_t>& rejected, std::size_t jumps_every = 20) {
  const auto registry = testing_models::registry_with(
      "[states]\nv = { unit = \"V\" }\n[inputs]\nI = { unit = \"A\", hold = \"zero_order\" }\n[parameters]\nC = { unit = \"A*s/V\", value "
      "= 40.0 "
      "}\n[equations]\nv = \"I/C\"\n[outputs]\nv = { unit = \"V\", noise = 0.1 }\n");
  Signals signals;
  signals.measured = {{"v", "V", {}, 0.0}};
  signals.inputs = {{"I", "A", {}, 0.0}};
  FilterEstimate estimate;
  estimate.model = assemble(testing_models::request_of("text"), *registry);
  estimate.data.resize(1);
  for (std::size_t k = 0; k < 100; ++k) {
    signals.t.push_back(0.1 * static_cast<double>(k));
    signals.measured.front().values.push_back(1.0);
    signals.inputs.front().values.push_back(static_cast<double>(k / jumps_every % 2));
    estimate.data.front().use.push_back(SampleRole::counted);
  }
  for (const std::size_t k : rejected) estimate.data.front().use[k] = SampleRole::none;
  estimate.data.front().signals = &signals;
  estimate.outliers = static_cast<int>(rejected.size());
  return outliers_at_jumps(estimate);
}

TEST(OutliersAtJumps, ThatFollowTheJumpsOfAnInputAreSaidToDoSo) {
  EXPECT_THAT(said_of({20, 40, 61, 80, 90}), testing::StartsWith(": 4 of them within two samples of a jump of I, as 8 % of all are"));
}

TEST(OutliersAtJumps, ThatAreElsewhereOrFewAreWildOnes) {
  EXPECT_EQ(said_of({}), "");
  EXPECT_EQ(said_of({20, 40}), "") << "two may be by chance";
  EXPECT_EQ(said_of({20, 40, 60, 70, 71, 72, 73}), "") << "less than half";
  EXPECT_EQ(said_of({9, 19, 29, 39, 49, 55}), "");
  EXPECT_EQ(said_of({20, 40, 60, 80}, 4), "") << "an input that jumps all the time";
}

}  // namespace
}  // namespace misfit
