#include "misfit/core/error.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(Source, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ((Source{"a.toml", 3, 7}).text(), "a.toml:3:7");
  EXPECT_EQ((Source{"a.toml", 3, 0}).text(), "a.toml:3");
  EXPECT_EQ((Source{"a.toml", 0, 7}).text(), "a.toml");
  EXPECT_EQ(Source{}.text(), "");
}

TEST(InputError, PutsThePlaceInFront) {
  EXPECT_STREQ(InputError(Source{"a.toml", 3, 7}, "wrong").what(), "a.toml:3:7: wrong");
  EXPECT_STREQ(InputError(Source{}, "wrong").what(), "wrong");
}

TEST(NearestName, FindsATypingError) {
  EXPECT_EQ(nearest_name("strut_wkae", {"coning", "strut_wake", "magnus"}), "strut_wake");
  EXPECT_EQ(nearest_name("Coning", {"coning", "strut_wake"}), "coning");
}

TEST(NearestName, TakesTheClosestOfSeveral) { EXPECT_EQ(nearest_name("R3x", {"R1", "R2", "R3"}), "R3"); }

TEST(NearestName, AcceptsAPartOfTheName) {
  EXPECT_EQ(nearest_name("wake", {"coning", "strut_wake"}), "strut_wake");
  EXPECT_EQ(nearest_name("strut_wake_of_rig", {"coning", "strut_wake"}), "strut_wake");
}

TEST(NearestName, IsSilentWhenNothingIsClose) {
  EXPECT_EQ(nearest_name("gravity", {"coning", "magnus"}), "");
  EXPECT_EQ(nearest_name("gravity", {}), "");
  EXPECT_EQ(nearest_name("", {"coning"}), "");
  EXPECT_EQ(nearest_name("abcd", {"abxyz"}), "");     // distance 3 of 4
  EXPECT_EQ(nearest_name("abcd", {"abxy"}), "abxy");  // distance 2: just half
}

TEST(Suggest, NamesTheNearestAndAll) {
  EXPECT_EQ(suggest("conig", {"coning", "magnus"}), " — did you mean 'coning'? Valid: coning, magnus");
  EXPECT_EQ(suggest("gravity", {"coning", "magnus"}), " — valid: coning, magnus");
  EXPECT_EQ(suggest("gravity", {}), "");
}

}  // namespace
}  // namespace misfit
