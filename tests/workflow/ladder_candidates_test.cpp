#include "misfit/workflow/ladder_candidates.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

Rung with(const std::map<std::string, Estimate>& parameters) {
  Rung out;
  out.parameters = parameters;
  return out;
}

/// However large its drop is.
TEST(WhyUndetermined, OfOneNumberThatIsSmallerThanItsSigma) {
  EXPECT_EQ(why_undetermined(with({{"clock_offset", {1.0, 4.3, "s"}}})), "its clock_offset is not determined: 1.0 ± 4.3 s");
  EXPECT_EQ(why_undetermined(with({{"clock_offset", {-1.0, 4.3, "s"}}})), "its clock_offset is not determined: -1.0 ± 4.3 s");
  EXPECT_EQ(why_undetermined(with({{"clock_offset", {1.0, 0.3, "s"}}})), "");
  EXPECT_EQ(why_undetermined(with({})), "");
}

/// Two that make up for each other may be known together: the asymmetry of a spring and its fifth power.
TEST(WhyUndetermined, OfSeveralNumbersNothingIsSaid) {
  EXPECT_EQ(why_undetermined(with({{"a", {1.0, 4.3, "s"}}, {"b", {1.0, 4.3, "s"}}})), "");
}

/// Fixed ones have no sigma.
TEST(WhyUndetermined, AFixedNumberBesideItDoesNotCount) {
  Rung rung = with({{"lagged_gain", {1.0, 0.0, "-"}}, {"input_tau", {1.0, 4.3, "s"}}});
  rung.new_parameters = 1;
  EXPECT_EQ(why_undetermined(rung), "its input_tau is not determined: 1.0 ± 4.3 s");
}

}  // namespace
}  // namespace misfit
