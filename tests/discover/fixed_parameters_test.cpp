// Numbers of the system that are fixed at a wrong value, and those that are known.
#include "misfit/discover/fixed_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// What is said of a cart whose stiffness is 29 N/m in the study and 30 in truth.
std::vector<std::string> said(const std::map<std::string, double>& sigmas) {
  ModelRequest request = cart({effect("viscous_friction")});
  request.constants["stiffness"] = 29.0;
  request.constant_sigmas = sigmas;
  const std::vector<Signals> signals = {record_of_cart({}, {})};
  const FilterEstimate estimate = estimate_filter(assemble(request, registry()), {}, signals);
  return fixed_parameters_in_words({estimate, signals, registry(), 1}, ScoreTest(estimate), {});
}

TEST(FixedParameters, OneThatTheDataWantOtherwiseIsSaid) {
  EXPECT_THAT(
      said({}),
      testing::Contains(testing::HasSubstr("unless it is known that well, estimate it (parameters.stiffness.free = true in the study)")));
}

/// Its score knows nothing of that: freed it stays where it is.
TEST(FixedParameters, OneThatIsKnownTooWellToMoveIsNotSaid) {
  EXPECT_THAT(said({{"stiffness", 1e-4}, {"mass", 1e-5}}), testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
