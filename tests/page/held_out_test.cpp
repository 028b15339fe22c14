// What the page says of the samples that no estimate has seen.
#include "misfit/page/held_out.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/report/figures_discovery.h"

namespace misfit::page {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

ChannelPrediction channel(const std::vector<bool>& held_out) {
  ChannelPrediction c;
  c.experiment = "e";
  for (std::size_t k = 0; k < held_out.size(); ++k) c.t.push_back(static_cast<double>(k));
  c.held_out = held_out;
  return c;
}

/// Of a hundred seconds, the last half held out, with a sample each second.
struct HalfHeldOut {
  ForceMap map;
  Diagnosis diagnosis;
  std::map<std::string, Times> held_out;

  explicit HalfHeldOut(const std::vector<double>& sigma) {
    map.port = "F";
    map.port_unit = "N";
    map.quantity = "time";
    map.quantity_unit = "s";
    map.x = {0.0, 30.0, 60.0, 90.0};
    map.amplitude = {1.0, 1.0, 1.0, 1.0};
    map.sigma = sigma;
    map.count = {15.0, 30.0, 30.0, 15.0};
    MissingForce missing;
    missing.experiment = "e";
    for (int k = 0; k <= 100; ++k) missing.t.push_back(k);
    diagnosis.missing = {missing};
    held_out["e"] = {{49.5, 100.0}};
  }
  [[nodiscard]] std::vector<double> shares() const { return held_out_shares(map, diagnosis, held_out); }
};

TEST(HeldOutTimes, ReachHalfWayToTheSamplesThatCount) {
  EXPECT_THAT(held_out_times(channel({false, false, true, true, false, true})), ElementsAre(ElementsAre(1.5, 3.5), ElementsAre(4.5, 5.0)));
  EXPECT_TRUE(held_out_times(channel({false, false})).empty());
}

TEST(HeldOutShares, OfAHatAtTheBorderAreBetweenNoneAndAll) {
  const std::vector<double> shares = HalfHeldOut({1.0, 1.0, 1.0, 0.0}).shares();
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_EQ(shares[0], 0.0);
  EXPECT_THAT(shares[1], DoubleNear(0.06, 0.02));
  EXPECT_THAT(shares[2], DoubleNear(0.8, 0.1));
  EXPECT_EQ(shares[3], 1.0);
}

TEST(HeldOutShares, OfAQuantityThatIsNotKnownOverTimeAreNotGuessed) {
  HalfHeldOut half({1.0, 1.0, 1.0, 1.0});
  half.map.quantity = "speed";
  EXPECT_TRUE(half.shares().empty());
}

TEST(PlacesWithoutAnEstimate, SayWhetherTheyAreHeldOutOrHaveTooFewSamples) {
  const HalfHeldOut half({0.0, 1.0, 1.0, 0.0});
  report::Figure figure = report::map_figure(half.map);
  tell_held_out(half.map, half.shares(), figure);
  const auto& series = figure.panels[0].series;
  ASSERT_GE(series.size(), 2U);
  EXPECT_EQ(series[0].legend, "no estimate: held out");
  EXPECT_THAT(series[0].x, ElementsAre(75.0, 105.0, testing::IsNan()));
  EXPECT_EQ(series[1].legend, "no estimate: too few samples");
  EXPECT_THAT(series[1].x, ElementsAre(-15.0, 15.0, testing::IsNan()));
  const auto& counts = figure.panels[1].series;
  ASSERT_EQ(counts.size(), 2U);
  EXPECT_EQ(counts[1].legend, "of these held out");
  EXPECT_EQ(counts[1].y[0], 0.0);
  EXPECT_EQ(counts[1].y[3], 15.0);
}

TEST(PlacesWithoutAnEstimate, StayAsTheyAreWhereNothingIsKnownOfThem) {
  const HalfHeldOut half({0.0, 1.0, 1.0, 0.0});
  report::Figure figure = report::map_figure(half.map);
  const std::size_t before = figure.panels[0].series.size();
  tell_held_out(half.map, {}, figure);
  EXPECT_EQ(figure.panels[0].series.size(), before);
  EXPECT_EQ(figure.panels[1].series.size(), 1U);
}

}  // namespace
}  // namespace misfit::page
