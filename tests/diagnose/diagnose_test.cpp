#include "misfit/diagnose/diagnose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;

TEST(Diagnose, SaysNowhereWhereNothingIsMissing) {
  const std::vector<Signals> flights = {fly(20.0, 21)};
  const Diagnosis found = diagnose(fitted(request_for(flights), flights));
  for (const auto& map : found.maps) EXPECT_GT(map.p_corrected, 0.01) << map.port << " over " << map.quantity;
  ASSERT_FALSE(found.sentences.empty());
  EXPECT_THAT(found.sentences.front(), testing::StartsWith("no map of the missing force of this model differs significantly from zero"));
}

TEST(Diagnose, MapsShowWhereAPlantedForceActs) {
  const std::vector<Signals> flights = {
      fly(25.0, 22, {effect("strut_wake")}, {{"wake_depth", 0.5}, {"wake_push", 0.25}, {"wake_phi", -1.2}, {"wake_width", 0.4}})};
  const Diagnosis found = diagnose(fitted(request_for(flights), flights));
  ASSERT_FALSE(found.maps.empty());
  EXPECT_EQ(found.maps.front().quantity, "phi");
  EXPECT_LT(found.maps.front().p_corrected, 1e-4);
  EXPECT_THAT(found.sentences.front(), testing::HasSubstr("where phi is between"));
  EXPECT_THAT(found.sentences, testing::Contains(testing::StartsWith("no dependence on time is found: the map over time has p = ")));
}

TEST(Diagnose, AMapOverTimeLiesInWhatIsNotHeldOut) {
  std::vector<Signals> flights = {fly(20.0, 21)};
  constexpr double from = 12.0;
  flights[0].validation_from = flights[0].t.front() + from;
  const Diagnosis found = diagnose(fitted(request_for(flights), flights));
  const auto over_time = std::find_if(found.maps.begin(), found.maps.end(), [](const ForceMap& m) { return m.quantity == "time"; });
  ASSERT_NE(over_time, found.maps.end());
  EXPECT_NEAR(over_time->x.back(), flights[0].validation_from, 0.5);
}

TEST(Diagnose, DoesNotDependOnThreads) {
  const std::vector<Signals> flights = {fly(8.0, 23)};
  const FilterEstimate estimate = fitted(request_for(flights), flights);
  const Diagnosis one = diagnose(estimate, {1}), two = diagnose(estimate, {2});
  ASSERT_EQ(one.maps.size(), two.maps.size());
  for (std::size_t i = 0; i < one.maps.size(); ++i) EXPECT_EQ(one.maps[i].chi2, two.maps[i].chi2);
}

/// Of the moment M over a quantity, each amplitude ± 6 N m.
ForceMap map_over(const std::string& quantity, const std::string& unit, std::vector<double> x, std::vector<double> amplitude) {
  ForceMap map;
  map.port = "M";
  map.port_unit = "N m";
  map.quantity = quantity;
  map.quantity_unit = unit;
  map.x = std::move(x);
  map.amplitude = std::move(amplitude);
  map.sigma.assign(map.x.size(), 6.0);
  return map;
}
const Eigen::MatrixXd independent = 36.0 * Eigen::MatrixXd::Identity(3, 3);

/// Mean of −38 and −44, each ± 6, correlated by 0.8: sqrt((36 + 36 + 2 · 0.8 · 36)/4) = 5.69; independent they would give 4.2.
TEST(WhereItFails, TheSigmaOfARunOfHatsHoldsTheirCorrelation) {
  ForceMap map = map_over("V", "m/s", {1.0, 2.0, 3.0}, {-38.0, -44.0, 2.0});
  Eigen::MatrixXd covariance = independent;
  covariance(0, 1) = covariance(1, 0) = 0.8 * 36.0;
  // The second hat alone is more significant, 44/6 = 7.3, than both together, 41/5.69 = 7.2.
  EXPECT_EQ(where_it_fails(map, covariance), "the model's M is 44.0 ± 6.0 N m too high where V is between 1.5 m/s and 2.5 m/s");
  map.amplitude[0] = -43.0;
  EXPECT_EQ(where_it_fails(map, covariance), "the model's M is 43.5 ± 5.7 N m too high where V is between 0.5 m/s and 2.5 m/s");
}

TEST(WhereItFails, WhatIsBelowThreeSigmasIsSaidOfTheMapAsAWhole) {
  EXPECT_EQ(where_it_fails(map_over("V", "m/s", {1.0, 2.0, 3.0}, {0.0, -12.0, 0.0}), independent),
            "as a whole, the model's M depends otherwise on V than the data say, though no range of it stands out by itself (most: 12.0 ± "
            "6.0 N m too high where V is between 1.5 m/s and 2.5 m/s)");
}

TEST(WhereItFails, TimeEndsWithTheRecordingAndAnHourOfTheDayAtMidnight) {
  EXPECT_EQ(where_it_fails(map_over("time", "s", {0.0, 10.0, 20.0}, {44.0, 44.0, 44.0}), independent),
            "the model's M is 44.0 ± 3.5 N m too low where time is between 0 s and 20 s");
  EXPECT_EQ(where_it_fails(map_over("time of day", "h", {2.0, 12.0, 22.0}, {44.0, 44.0, 44.0}), independent),
            "the model's M is 44.0 ± 3.5 N m too low where time of day is between 0 h and 24 h");
}

TEST(WhereItFails, EndsThatDifferLittleAreToldApart) {
  EXPECT_EQ(where_it_fails(map_over("p", "Pa", {101322.0, 101324.0, 101326.0}, {0.0, 44.0, 0.0}), independent),
            "the model's M is 44.0 ± 6.0 N m too low where p is between 101323 Pa and 101325 Pa");
}

}  // namespace
}  // namespace misfit
