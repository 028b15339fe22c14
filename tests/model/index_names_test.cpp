// An enum that indexes a list of an effect has the names of the list, in its order: what the static_asserts of EffectOf refuse.
#include "misfit/model/index_names.h"

#include <gtest/gtest.h>

#include "misfit/model/effect.h"

namespace misfit {
namespace {

using index_names::match;

constexpr Role tilt_and_rate[] = {{.name = "tilt", .unit = "rad"}, {.name = "tilt_rate", .unit = "rad/s"}};

struct InOrder {
  enum Quantity { tilt, tilt_rate };
};
struct Swapped {
  enum Quantity { tilt_rate, tilt };
};
struct OneTooFew {
  enum Quantity { tilt };
};
struct OneTooMany {
  enum Quantity { tilt, tilt_rate, phi };
};
struct ThreeTooMany {
  enum Quantity { tilt, tilt_rate, phi, phi_rate, eta };
};
struct WithGap {
  enum Quantity { tilt, tilt_rate = 2 };
};
struct OtherName {
  enum Quantity { tilt, rate };
};

TEST(IndexNames, AnEnumWithTheNamesOfTheListInItsOrderMatches) { EXPECT_TRUE((match<InOrder::Quantity>(tilt_and_rate, "quantity"))); }

TEST(IndexNames, AnEnumInAnotherOrderIsRefused) { EXPECT_FALSE((match<Swapped::Quantity>(tilt_and_rate, "quantity"))); }

TEST(IndexNames, AnEnumWithMoreOrFewerNamesIsRefused) {
  EXPECT_FALSE((match<OneTooFew::Quantity>(tilt_and_rate, "quantity")));
  EXPECT_FALSE((match<OneTooMany::Quantity>(tilt_and_rate, "quantity")));
  EXPECT_FALSE((match<ThreeTooMany::Quantity>(tilt_and_rate, "quantity")));
}

TEST(IndexNames, AnEnumWithAGapOrAnotherNameIsRefused) {
  EXPECT_FALSE((match<WithGap::Quantity>(tilt_and_rate, "quantity")));
  EXPECT_FALSE((match<OtherName::Quantity>(tilt_and_rate, "quantity")));
}

TEST(IndexNames, ANameThatAnotherListHasTakenCarriesTheKindOfItsOwn) {
  struct Pixels {
    enum Port { P_y_port, P_z };
  };
  constexpr const char* ports[] = {"P_y", "P_z"};
  EXPECT_TRUE((match<Pixels::Port>(ports, "port")));
  EXPECT_FALSE((match<Pixels::Port>(ports, "constant")));
}

struct EffectWithSwappedCoefficients {
  enum Port { moment };
  enum Coefficient { size, width };
  static constexpr Role ports[] = {{.name = "moment", .unit = "N m"}};
  static constexpr CoefficientSpec coefficients[] = {{.name = "width"}, {.name = "size"}};
};

TEST(IndexNames, EveryListOfAnEffectIsComparedWithTheEnumThatItHas) {
  EXPECT_TRUE(index_names::quantities_match<EffectWithSwappedCoefficients>()) << "it has no enum Quantity";
  EXPECT_TRUE(index_names::ports_match<EffectWithSwappedCoefficients>());
  EXPECT_FALSE(index_names::coefficients_match<EffectWithSwappedCoefficients>());
}

}  // namespace
}  // namespace misfit
