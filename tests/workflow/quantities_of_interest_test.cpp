#include "misfit/workflow/uncertainty/quantities_of_interest.h"

#include <gtest/gtest.h>

#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

TEST(FitsThatHaveNotConverged, AreCountedAndNamed) {
  Fit good, stuck;
  good.status = FitStatus::converged;
  good.trim = Estimate{0.2, 0.01, "rad"};
  stuck = good;
  stuck.status = FitStatus::not_converged;
  stuck.message = "iteration limit";
  const QuantitiesOfInterest numbers(good, good, "C_m");
  const TemporaryFolder folder;
  MonteCarloOptions options;
  options.jobs = {folder.path() / "jobs", "digest", 40, 1};
  const Sampler sampler({{{"R", "m", 1.0, false}}, {}}, 1);
  std::size_t expected = 0;
  const auto runs = monte_carlo(
      sampler,
      [&](const std::vector<double>& errors) {
        expected += errors[0] > 0.0 ? 1 : 0;
        return ChainResult{numbers.evaluate(errors[0] > 0.0 ? stuck : good), ""};
      },
      options);
  ASSERT_TRUE(runs);
  ASSERT_GT(expected, 5U);
  const std::vector<std::string> notes = unfinished_notes(good, *runs);
  ASSERT_EQ(notes.size(), 1U);
  expect_parts(notes[0], {(std::to_string(expected) + " of 40 runs had not converged").c_str()});
  EXPECT_EQ(unfinished_notes(stuck, *runs)[0], "The nominal fit has not converged (iteration limit).");
}

}  // namespace
}  // namespace misfit
