#include "misfit/diagnose/innovations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;

double p_of_cumulative_periodogram(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> t, w;
  for (int i = 0; i < 240; ++i) {
    if (i >= 60 && i < 180) continue;  // held out
    t.push_back(0.1 * i);
    w.push_back(normal(random));
  }
  return whiteness_of(t, w).periodogram_p;
}

TEST(Whiteness, OfWhiteInnovationsAroundAHeldOutPartIsRarelyDoubted) {
  std::mt19937_64 random(5);
  constexpr int trials = 800;
  int doubted = 0;
  for (int k = 0; k < trials; ++k) doubted += p_of_cumulative_periodogram(random) < 0.05 ? 1 : 0;
  EXPECT_LE(doubted, 60) << "40 expected at most, sigma 6; with 0 in the gap some 160";
}

/// P_y and P_z of one experiment, whose innovations are said for each row and channel; NaN: not measured.
struct Record {
  Signals signals;
  FilterEstimate estimate;

  explicit Record(const std::vector<double>& t) {
    signals.name = "flight";
    signals.t = t;
    estimate.model = assemble(spherical(), registry());
    estimate.traces.resize(1);
    estimate.traces[0].ny = 2;
    estimate.traces[0].samples = t.size();
    estimate.data.resize(1);
    estimate.data[0].signals = &signals;
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() = default;
  void add(double e) {
    estimate.traces[0].e.push_back(std::isfinite(e) ? e : 0.0);
    estimate.traces[0].S.push_back(std::isfinite(e) ? 1.0 : 0.0);
    estimate.data[0].use.push_back(std::isfinite(e) ? SampleRole::counted : SampleRole::none);
  }
};

TEST(Whiteness, ALineHasTheFrequencyOfItsChannelsOwnClock) {
  std::vector<double> t;
  constexpr int each = 600;
  for (int k = 0; k < each; ++k) t.insert(t.end(), {0.1 * k, 0.1 * k + 0.03});
  Record record(t);
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double w = normal(random) + (i % 2 == 0 ? 1.5 * std::sin(2.0 * std::numbers::pi * 1.25 * t[i]) : 0.0);
    for (std::size_t o = 0; o < 2; ++o) record.add(i % 2 == o ? w : std::nan(""));
  }
  const std::vector<WhitenessReport> reports = whiteness_of(record.estimate);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_NEAR(reports[0].peak_frequency, 1.25, 0.02);
  EXPECT_LT(reports[0].peak_p, 1e-6);
  EXPECT_GT(reports[0].autocorrelation[8], 0.4) << "a period of 0.8 s";
  EXPECT_GT(reports[1].peak_p, 1e-3);
}

TEST(Whiteness, ALineKeepsItsFrequencyWhereSamplesAreMissing) {
  std::vector<double> t, w;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 800; ++i) {
    const double time = 0.1 * i, value = normal(random) + 1.5 * std::sin(2.0 * std::numbers::pi * 1.3 * time);
    if (i % 5 == 3) continue;
    t.push_back(time);
    w.push_back(value);
  }
  EXPECT_NEAR(whiteness_of(t, w).peak_frequency, 1.3, 0.02);
}

TEST(Nis, WindowsHaveAsManyMeasurementsAsTheirBandSays) {
  std::vector<double> t;
  for (int k = 0; k < 8000; ++k) t.push_back(0.1 * k);
  Record record(t);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < t.size(); ++i) {
    record.add(i % 4 == 0 ? normal(random) : std::nan(""));
    record.add(i % 8 == 0 ? normal(random) : std::nan(""));
  }
  const std::vector<NisSeries> series = nis_of(record.estimate);
  ASSERT_EQ(series.size(), 1U);
  ASSERT_EQ(series[0].nis.size(), 75U) << "3000 measurements in windows of 40";
  EXPECT_NEAR(series[0].upper, 1.0 + 1.96 * std::sqrt(2.0 / 40.0), 1e-12);
  EXPECT_LT(series[0].outside, 0.12) << "5 % expected, sigma 2.5 %";
  EXPECT_LT(series[0].t.front(), 15.0);
}

TEST(Nis, OfTooFewMeasurementsNothingIsSaid) {
  std::vector<double> t;
  for (int k = 0; k < 100; ++k) t.push_back(0.1 * k);
  Record record(t);
  for (std::size_t i = 0; i < t.size(); ++i) {
    record.add(i % 8 == 0 ? 1.0 : std::nan(""));
    record.add(std::nan(""));
  }
  EXPECT_TRUE(nis_of(record.estimate).empty());
}

}  // namespace
}  // namespace misfit
