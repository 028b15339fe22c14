// [geometry] of a study: constants of the system, and the rig that a camera looks at.

#include "misfit/model/request.h"

#include <gtest/gtest.h>

#include "misfit/data/study.h"
#include "misfit/model/declared.h"
#include "tests/core/temporary_folder.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

/// A circuit whose constants are called as lengths and a speed of the rig.
StudyModel circuit_with(const std::string& lines) {
  const TemporaryFolder folder;
  folder.write("circuit.toml",
               "[states]\ni = { unit = \"A\" }\n[parameters]\nR = { unit = \"V/A\" }\nV = { unit = \"V\" }\nR1 = { unit = \"m\" }\n"
               "L = { unit = \"V*s/A\", value = 1 }\nslope = { unit = \"V/m\", value = 1 }\n"
               "[equations]\ni = \"(V + slope*R1 - R*i)/L\"\n[outputs]\ni = { unit = \"A\" }\n");
  const Study study = read_study(folder.write("study.toml", "[system]\nfile = \"circuit.toml\"\n[effects]\n" + lines + "\n"));
  const auto known = study_registry(study, testing_models::registry());
  return read_model(study, *known);
}

TEST(Geometry, AConstantThatIsCalledAsALengthOfTheRigIsNone) {
  const StudyModel model = circuit_with("[geometry]\nR = \"4 Ohm\"\nV = -2.0\nR1 = \"-30 cm\"");
  EXPECT_EQ(model.request.constants.at("R"), 4.0);
  EXPECT_EQ(model.request.constants.at("V"), -2.0);
  EXPECT_EQ(model.request.constants.at("R1"), -0.3) << "no camera looks at it";
  EXPECT_EQ(model.rig.R, 0.0);
}

TEST(Geometry, LimitsOfARigHoldWhereACameraLooksAtIt) {
  const std::string camera = "\n[camera]\nh_c = 0.15\nK = 130";
  expect_parts(message_of<InputError>([&] { circuit_with("[geometry]\nR = 4\nV = -2.0\nR1 = \"-30 cm\"" + camera); }),
               {"study.toml:7", "R1", "above 0"});
  EXPECT_EQ(circuit_with("[geometry]\nR = 4\nV = -2.0\nR1 = 0.3" + camera).rig.R1, 0.3);
}

}  // namespace
}  // namespace misfit
