#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/inference/curves.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;

/// The inertia goes with m + m_a = 0.5 kg, and C_m, for the same motion, with the inertia.
TEST(ScaleUncertainties, TheCoefficientGoesWithTheInertia) {
  Model model = assemble(parachute(true), registry());
  model.parameters[static_cast<std::size_t>(model.find_parameter("m_a"))].prior_sigma = 0.033;
  const std::vector<double> x(static_cast<std::size_t>(model.states()), 0.2);
  const std::vector<double> u(static_cast<std::size_t>(model.inputs()), 0.0);
  const std::vector<std::string> words = scale_uncertainties(model, x.data(), u.data(), 0.0);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_THAT(words[0], testing::HasSubstr("m_a = 0.294 ± 0.033 kg, which is fixed, makes every C_m uncertain by 6.6 % (1 sigma)"));
}

}  // namespace
}  // namespace misfit
