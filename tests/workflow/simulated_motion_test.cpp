// Statistics of motions that a fitted model makes, against the measured one.
#include <gtest/gtest.h>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/swing.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing_text_study::TextStudy;

SimulatedMotion of_swing(unsigned seed, double reach) {
  TextStudy study(testing_swing::system(), testing_swing::recording(seed, reach));
  Identification identification = study.identification("filter_error", "");
  return compare_stage(identification.session(), identification.fit()).motion.value();
}

/// The input repeats the motion, so that the bands are narrow, and the error of an initial state as measured lies outside of them.
TEST(MotionsOfARightModel, AreNotSaidToDiffer) {
  int significant = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const SimulatedMotion motion = of_swing(seed, 100.0);
    EXPECT_EQ(motion.failed, 0U);
    significant += motion.p_value <= 0.01 ? 1 : 0;
  }
  EXPECT_EQ(significant, 0) << "at 1 %, of 8; from initial states as measured 5 of 6 were";
}

TEST(MotionsOfAModelWithoutTheEndOfItsSensor, AreSaidToDiffer) {
  constexpr double reach = 0.3;  // [m], of a motion of 1 m
  int significant = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) significant += of_swing(seed, reach).p_value <= 0.01 ? 1 : 0;
  EXPECT_GE(significant, 3) << "of 4";
}

}  // namespace
