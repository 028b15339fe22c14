#include "misfit/fit/filter/outliers_at_jumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using Places = std::vector<std::size_t>;

/// A hundred samples of a cell whose current jumps now and then.
struct Recording {
  std::shared_ptr<Registry> registry = testing_models::registry_with(
      "[states]\nv = { unit = \"V\" }\n[inputs]\nI = { unit = \"A\", hold = \"zero_order\" }\n[parameters]\nC = { unit = \"A*s/V\", value "
      "= "
      "40.0 }\n[equations]\nv = \"I/C\"\n[outputs]\nv = { unit = \"V\", noise = 0.1 }\n");
  Model model = assemble(testing_models::request_of("text"), *registry);
  Signals signals;
  std::vector<FilterData> data{1};

  explicit Recording(std::size_t jumps_every = 20) {
    signals.measured = {{"v", "V", std::vector<double>(100, 1.0), 0.0}};
    signals.inputs = {{"I", "A", {}, 0.0}};
    for (std::size_t k = 0; k < 100; ++k) signals.inputs.front().values.push_back(static_cast<double>(k / jumps_every % 2));
    data.front().use.assign(100, SampleRole::counted);
    data.front().signals = &signals;
  }
  Recording(const Recording&) = delete;

  [[nodiscard]] std::string said_of(const Places& gated) const {
    const auto found = outliers_at_jumps(model.system->spec(), data, {gated});
    return found ? in_words(*found, model.system->spec()) : "";
  }
};

TEST(OutliersAtJumps, ThatFollowTheJumpsOfAnInputAreSaidToDoSoAndKept) {
  const Recording recording;
  const Places gated = {20, 40, 61, 80, 90};
  EXPECT_THAT(recording.said_of(gated), testing::StartsWith("4 of 5 measurements more than 5 sigma from their prediction come within two "
                                                            "samples of a jump of I, as 8 % of all do: they are kept"));
  EXPECT_EQ(without_those_at_jumps(recording.data.front(), 0, gated), Places{90});
}

/// A voltage that is measured a sample late is once at each jump wrong by R0 times the jump: with these set aside nothing would be left
/// that says so.
TEST(OutliersAtJumps, AreKeptByTheFilterAndAWildOneIsNot) {
  const auto registry = testing_models::registry_with(R"toml(
[states]
v = { unit = "V", scale = 0.1 }
[inputs]
I = { unit = "A", hold = "zero_order" }
[parameters]
R0 = { unit = "V/A", value = 0.2, free = true, bounds = [0.1, 1.0] }
R1 = { unit = "V/A", value = 0.5, free = true }
tau = { unit = "s", value = 2.0, free = true, bounds = [0.5, 10.0] }
[equations]
v = "(R1*I - v)/tau"
[outputs]
U = { unit = "V", formula = "v + R0*I", noise = 0.01 }
)toml");
  Signals signals;
  signals.name = "late";
  signals.measured = {{"U", "V", {}, 0.0}};
  signals.inputs = {{"I", "A", {}, 0.0}};
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.002);
  double v = 0.0, I = 0.0, U_before = 0.0;
  for (std::size_t k = 0; k < 400; ++k) {
    if (k % 25 == 24) I = static_cast<double>(k / 25 % 3) - 0.7;
    signals.t.push_back(0.1 * static_cast<double>(k));
    signals.measured.front().values.push_back(U_before + noise(random) + (k == 310 ? 0.3 : 0.0));
    signals.inputs.front().values.push_back(I);
    U_before = v + 0.2 * I;
    v = 0.5 * I + (v - 0.5 * I) * std::exp(-0.1 / 2.0);
  }
  const std::vector<Signals> experiments = {signals};
  const FilterEstimate found = estimate_filter(assemble(testing_models::request_of("text"), *registry), {}, experiments);
  EXPECT_THAT(found.notes, testing::Contains(testing::HasSubstr("come within two samples of a jump of I")));
  EXPECT_EQ(found.outliers, 1);
  EXPECT_EQ(found.data.front().use[310], SampleRole::none);
  EXPECT_EQ(std::count(found.data.front().use.begin() + 20, found.data.front().use.end(), SampleRole::none), 1);
}

TEST(OutliersAtJumps, ThatAreElsewhereOrFewAreWildOnes) {
  const Recording recording;
  EXPECT_EQ(recording.said_of({}), "");
  EXPECT_EQ(recording.said_of({20, 40}), "") << "two may be by chance";
  EXPECT_EQ(recording.said_of({20, 40, 60, 70, 71, 72, 73}), "") << "less than half";
  EXPECT_EQ(recording.said_of({9, 19, 29, 39, 49, 55}), "");
  EXPECT_EQ(Recording(4).said_of({20, 40, 60, 80}), "") << "an input that jumps all the time";
}

}  // namespace
}  // namespace misfit
