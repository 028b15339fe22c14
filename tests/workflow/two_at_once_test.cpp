// The servo of configs/servo_pendulum: dry friction that alone has to hold at rest what the friction under the load holds is too large for
// the motion, so that it predicts worse farther ahead without the other. Few effects are known here: the search among all takes minutes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/workflow/ladder.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"
#include "tests/workflow/frictions.h"

namespace misfit {
namespace {

using testing::HasSubstr;

class FrictionsOfAServo : public testing::Test {
 protected:
  FrictionsOfAServo() {
    const std::filesystem::path from = paths::source() / "configs/servo_pendulum";
    for (const auto& entry : std::filesystem::directory_iterator(from)) {
      if (entry.is_regular_file()) std::filesystem::copy_file(entry.path(), folder_.path() / entry.path().filename());
    }
    misfit_register_coulomb_friction(registry_);
  }

  [[nodiscard]] Ladder extended() {
    SessionOptions options;
    options.study = (folder_.path() / "study.toml").string();
    options.methods = {"filter_error"};
    ModelLadder ladder(options, registry_);
    extend_ladder(ladder, registry_);
    return ladder.ladder();
  }

  TemporaryFolder folder_;
  Registry registry_;
};

TEST_F(FrictionsOfAServo, AreFoundTogether) {
  misfit_register_load_friction(registry_);
  const std::vector<Rung> rungs = extended().rungs;
  ASSERT_EQ(rungs.size(), 3U);
  EXPECT_EQ(rungs[1].added, "coulomb_friction");
  EXPECT_EQ(rungs[2].added, "load_friction");
  EXPECT_GT(rungs[1].k_step.at("angle").back(), 1.1 * rungs[0].k_step.at("angle").back()) << "alone";
  EXPECT_LE(rungs[2].k_step.at("angle").back(), rungs[0].k_step.at("angle").back());
  EXPECT_LE(rungs[2].validation_k_step->at("angle").back(), rungs[0].validation_k_step->at("angle").back());
  // 0.122 in bam/params/xl330/m3.json of github Rhoban/bam, fitted to more recordings, with another form of rest.
  const Estimate factor = rungs[2].parameters.at("load_factor");
  EXPECT_NEAR(factor.value, 0.122, 3.0 * factor.sigma);
  EXPECT_LT(factor.sigma, 0.03);
}

TEST_F(FrictionsOfAServo, AreNotAddedWhereTheSecondIsNotKnown) {
  const std::vector<Rung> rungs = extended().rungs;
  ASSERT_EQ(rungs.size(), 1U);
  ASSERT_TRUE(rungs[0].why_too_little.has_value());
  EXPECT_THAT(rungs[0].why_too_little->at("coulomb_friction"), HasSubstr("predictions farther ahead get worse"));
}

}  // namespace
}  // namespace misfit
