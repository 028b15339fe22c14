#include "misfit/model/memory.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/model/requests.h"

namespace misfit {
namespace {

using testing_models::registry;

TEST(HasLinearMemory, IsTrueOfLagsAndDelays) {
  for (const char* key : {"lag", "input_lag", "sensor_lag", "sensor_delay"}) EXPECT_TRUE(has_linear_memory(registry().effect(key))) << key;
  for (const char* key : {"coulomb_friction", "hysteresis", "rate_limit", "backlash", "turning_ripple"})
    EXPECT_FALSE(has_linear_memory(registry().effect(key))) << key;
}

TEST(OnlyAddsUp, IsTrueOfTheAngleTurnedAlone) {
  std::set<std::string> found;
  for (const std::string& key : registry().effect_keys()) {
    if (only_adds_up(registry().effect(key))) found.insert(key);
  }
  EXPECT_EQ(found, std::set<std::string>{"turning_ripple"});
}

}  // namespace
}  // namespace misfit
