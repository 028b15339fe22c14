// The force that a refitted effect adds: its own formula at the smoothed motion.
#include "misfit/discover/added_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// What `added` (with one strength of this name) adds to the cart on which it was recorded.
class OnACart : public testing::Test {
 protected:
  std::vector<AddedForce> added_by(const std::string& added, const std::string& strength, const Values& values) {
    recorded_ = record_of_cart({effect(added)}, values);
    ModelRequest request = cart({effect("viscous_friction"), effect(added)});
    for (const auto& [name, value] : values) request.parameters[name].value = value;
    const std::vector<Signals> signals = {recorded_};
    const FilterEstimate estimate = estimate_filter(assemble(request, registry()), {}, signals);
    const auto& parameters = estimate.model.parameters;
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == strength; });
    strength_ = found->value;
    return added_force_of(estimate, {static_cast<int>(found - parameters.begin())});
  }
  /// At every sample, up to what the noise of the measured velocity makes of it.
  void expect_force(const std::vector<AddedForce>& added, const std::function<double(double, double)>& of_velocity_and_input) {
    ASSERT_EQ(added.size(), 1U);
    ASSERT_EQ(added[0].ports.size(), 1U);
    EXPECT_EQ(added[0].ports[0], "force");
    EXPECT_EQ(added[0].port_units[0], "N");
    ASSERT_GT(added[0].t.size(), 2000U);
    const std::size_t first = recorded_.t.size() - added[0].t.size();
    for (std::size_t k = 0; k < added[0].t.size(); ++k) {
      const double v = recorded_.measured[1].values[first + k], u = recorded_.inputs[0].values[first + k];
      const double low = of_velocity_and_input(v - 0.05, u), high = of_velocity_and_input(v + 0.05, u);
      EXPECT_EQ(added[0].t[k], recorded_.t[first + k]);
      EXPECT_GE(added[0].force[0][k], std::min(low, high) - 1e-9) << added[0].t[k];
      EXPECT_LE(added[0].force[0][k], std::max(low, high) + 1e-9) << added[0].t[k];
    }
  }

  Signals recorded_;
  double strength_ = 0.0;
};

TEST_F(OnACart, OfADragIsItsFormulaAtTheVelocity) {
  const auto added = added_by("quadratic_drag", "drag", {{"drag", 1.0}});
  EXPECT_NEAR(strength_, 1.0, 0.1);
  expect_force(added, [this](double v, double) { return -strength_ * std::abs(v) * v; });
}

TEST_F(OnACart, OfAGainIsItsShareOfTheInput) {
  const auto added = added_by("input_gain", "gain_error", {{"gain_error", 0.3}});
  EXPECT_NEAR(strength_, 0.3, 0.05);
  expect_force(added, [this](double, double u) { return strength_ * u; });
}

TEST_F(OnACart, AnErrorOfASensorAddsNone) { EXPECT_TRUE(added_by("bias", "offset", {{"offset", 0.1}}).empty()); }

}  // namespace
}  // namespace misfit
