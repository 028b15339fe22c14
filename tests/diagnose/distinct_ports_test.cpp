#include "misfit/diagnose/distinct_ports.h"

#include <gtest/gtest.h>

#include "misfit/core/lists.h"
#include "tests/fit/gimbal.h"

namespace misfit {
namespace {

using namespace testing_gimbal;

/// Name of the port at which what acts on that port is sought.
std::string sought(const FilterEstimate& estimate, const std::string& port) {
  const SystemSpec& system = estimate.model.system->spec();
  return system.dynamic_ports[sought_at(system, ForceSensitivity(estimate))[index_of(system.dynamic_ports, port)]].name;
}

TEST(SoughtAt, IsTheDeclaredMomentOfWhichARateIsAMultiple) {
  const FilterEstimate estimate = estimate_of(*registry_with(gimbal("J")));
  EXPECT_EQ(sought(estimate, "dw/dt"), "cable");
  EXPECT_EQ(sought(estimate, "cable"), "cable");
  EXPECT_EQ(sought(estimate, "dx/dt"), "dx/dt");
  EXPECT_EQ(distinct_ports(estimate.model.system->spec(), ForceSensitivity(estimate)).size(), 2U);
}

TEST(SoughtAt, IsThePortItselfWhereTheInertiaChanges) {
  const FilterEstimate estimate = estimate_of(*registry_with(gimbal("(J*(1 + x^2))")));
  EXPECT_EQ(sought(estimate, "dw/dt"), "dw/dt");
  EXPECT_EQ(distinct_ports(estimate.model.system->spec(), ForceSensitivity(estimate)).size(), 3U);
}

}  // namespace
}  // namespace misfit
