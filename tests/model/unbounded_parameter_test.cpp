// A declared parameter without bounds has none.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string resistor_text = R"toml(
[states]
x = { unit = "V" }
[parameters]
R = { unit = "Ohm", value = 5e9, free = true }
C = { unit = "A s/V", value = 1e-10 }
[equations]
x = "-x/(R*C)"
[outputs]
y = { unit = "V", formula = "x" }
)toml";

TEST(UnboundedParameter, TakesAnyValue) {
  const auto known = registry_with(resistor_text);
  ModelRequest request = request_of("text");
  Model model = assemble(request, *known);
  const auto R = static_cast<std::size_t>(model.find_parameter("R"));
  EXPECT_EQ(model.parameters[R].value, 5e9);
  EXPECT_TRUE(std::isinf(model.parameters[R].lower) && std::isinf(model.parameters[R].upper));
  EXPECT_EQ(model.parameters[R].scale, 5e9) << "the typical size is that of the value";
  request.parameters["R"].value = -3e12;
  model = assemble(request, *known);
  EXPECT_EQ(model.parameters[R].value, -3e12);
  EXPECT_EQ(model.parameters[R].scale, 3e12);
}

TEST(UnboundedParameter, KeepsTheBoundsThatTheStudyGives) {
  const auto known = registry_with(resistor_text);
  ModelRequest request = request_of("text");
  request.parameters["R"].lower = 1e9;
  request.parameters["R"].upper = 1e10;
  const Model model = assemble(request, *known);
  EXPECT_EQ(model.parameters[static_cast<std::size_t>(model.find_parameter("R"))].upper, 1e10);
}

}  // namespace
}  // namespace misfit
