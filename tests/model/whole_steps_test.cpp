#include "misfit/model/whole_steps.h"

#include <gmock/gmock.h>

#include "tests/model/requests.h"

using namespace misfit;
using namespace testing_models;

namespace {

Model with_rounded(double share, bool free) {
  Model model = assemble(cart({effect("sensor_quantisation", {{"output", "speed_reading"}})}), registry());
  Parameter& rounded = model.parameters[static_cast<std::size_t>(model.find_parameter("rounded"))];
  rounded.value = share;
  rounded.free = free;
  model.parameters[static_cast<std::size_t>(model.find_parameter("step"))].value = 0.25;
  return model;
}

}  // namespace

TEST(WholeStepsOfOutputs, AreThoseOfAnEffectHeldAsAWhole) {
  const Model model = with_rounded(1.0, false);
  EXPECT_TRUE(reads_whole_steps(model, model.effects.back()));
  EXPECT_THAT(steps_of_outputs(model), testing::ElementsAre(0.0, 0.25));
  const Model before = before_whole_steps(model);
  EXPECT_EQ(before.parameters[static_cast<std::size_t>(before.find_parameter("rounded"))].value, 0.0);
}

TEST(WholeStepsOfOutputs, AreNoneWhereAPartIsEstimatedOrThereIsNoSuchEffect) {
  for (const Model& model : {with_rounded(1.0, true), with_rounded(0.5, false), assemble(cart({effect("viscous_friction")}), registry())}) {
    EXPECT_THAT(steps_of_outputs(model), testing::IsEmpty());
    EXPECT_EQ(before_whole_steps(model).values(), model.values());
  }
}

TEST(WholeStepsOfOutputs, AreReadFromTheirLevel) {
  Model model = with_rounded(1.0, false);
  model.parameters[static_cast<std::size_t>(model.find_parameter("level"))].value = 0.1;
  EXPECT_DOUBLE_EQ(as_read(model, 1, 0.73), 0.85);
  EXPECT_DOUBLE_EQ(as_read(model, 1, -0.26), -0.15);
  EXPECT_DOUBLE_EQ(as_read(model, 0, 0.73), 0.73);
  EXPECT_DOUBLE_EQ(as_read(with_rounded(0.5, false), 1, 0.73), 0.73);
}
