#include "misfit/model/recorded_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace misfit {
namespace {

/// Two inputs at uneven times: u1 held, u2 straight between its samples, both with the same values.
const RecordedInputs& recorded() {
  static const RecordedInputs out{{0.0, 1.0, 2.5, 3.0, 5.0, 6.0},
                                  {Hold::zero_order, Hold::first_order},
                                  {1.0, 1.0, 3.0, 3.0, -2.0, -2.0, 4.0, 4.0, 0.5, 0.5, 2.0, 2.0}};
  return out;
}

/// By definition, for numerical integration.
double value(int input, double t) {
  const auto& [times, hold, values, slopes] = recorded();
  if (t < times.front()) return values.front();
  std::size_t k = 0;
  while (k + 1 < times.size() && times[k + 1] <= t) ++k;
  const double here = recorded().value(k, input);
  if (input == 0 || k + 1 == times.size()) return here;
  return here + (recorded().value(k + 1, input) - here) * (t - times[k]) / (times[k + 1] - times[k]);
}

LateInput late(int input, double from, double to, double t, double delay) {
  const std::array<double, 2> now{};
  return late_input({now.data(), &recorded(), from, to}, input, t, delay);
}

struct Place {
  int input;
  double from, to, delay;
};
constexpr std::array places = {Place{0, 3.0, 5.0, 0.7},  Place{1, 3.0, 5.0, 0.7},  Place{0, 5.0, 6.0, 4.4}, Place{1, 1.0, 2.5, 1.9},
                               Place{0, 0.0, 1.0, 0.45}, Place{1, 0.0, 1.0, 8.0},  Place{0, 5.0, 6.0, 0.2}, Place{1, 5.0, 6.0, 0.013},
                               Place{0, 1.0, 2.5, 0.9},  Place{1, 2.5, 3.0, 2.95}, Place{0, 6.0, 9.0, 0.5}, Place{1, 6.0, 9.0, 0.5}};

TEST(LateInput, OverAnIntervalHasTheMeanAndTheFirstMomentOfWhatItWas) {
  for (const auto& [input, from, to, delay] : places) {
    constexpr int parts = 200000;
    const double h = (to - from) / parts, middle = 0.5 * (from + to);
    double mean = 0.0, moment = 0.0, of_line = 0.0;
    for (int i = 0; i < parts; ++i) {
      const double t = from + (i + 0.5) * h, then = value(input, t - delay), line = late(input, from, to, t, delay).value;
      mean += then / parts;
      moment += (t - middle) * then * h;
      of_line += (t - middle) * line * h;
    }
    EXPECT_NEAR(late(input, from, to, middle, delay).value, mean, 1e-4) << input << " from " << from << ", " << delay;
    EXPECT_NEAR(of_line, moment, 1e-4) << input << " from " << from << ", " << delay;
  }
}

TEST(LateInput, IsDifferentiatedByTheDelay) {
  for (const auto& [input, from, to, delay] : places) {
    for (const double t : {from, 0.3 * from + 0.7 * to, to}) {
      constexpr double step = 1e-5;
      const double difference =
          (late(input, from, to, t, delay + step).value - late(input, from, to, t, delay - step).value) / (2.0 * step);
      EXPECT_NEAR(late(input, from, to, t, delay).by_delay, difference, 1e-7) << input << " at " << t << ", " << delay;
    }
  }
}

TEST(LateInput, ByWholeIntervalsOfEvenSamplesIsTheEarlierSample) {
  const RecordedInputs even{{0.0, 0.5, 1.0, 1.5}, {Hold::zero_order}, {1.0, -2.0, 5.0, 0.0}};
  for (const double t : {1.0, 1.2, 1.5}) {
    EXPECT_NEAR(late_input({nullptr, &even, 1.0, 1.5}, 0, t, 1.0).value, 1.0, 1e-12);
    EXPECT_NEAR(late_input({nullptr, &even, 1.0, 1.5}, 0, t, 0.5).value, -2.0, 1e-12);
    EXPECT_NEAR(late_input({nullptr, &even, 1.0, 1.5}, 0, t, 0.0).value, 5.0, 1e-12);
    EXPECT_NEAR(late_input({nullptr, &even, 1.5, 1.0}, 0, t, 0.0).value, 5.0, 1e-12) << "an interval that is run backwards";
  }
}

TEST(LateInput, AtASampleIsBetweenSamplesLinearly) {
  const LateInput held = late(0, 3.0, 3.0, 3.0, 0.25), straight = late(1, 3.0, 3.0, 3.0, 0.25);
  EXPECT_NEAR(held.value, 1.0, 1e-12) << "half way from -2 to 4";
  EXPECT_NEAR(straight.value, 1.0, 1e-12);
  EXPECT_NEAR(straight.by_delay, -12.0, 1e-12);
  EXPECT_EQ(late(1, 1.0, 1.0, 1.0, 3.0).value, 1.0) << "before the record";
  EXPECT_EQ(late(1, 1.0, 1.0, 1.0, 3.0).by_delay, 0.0);
}

/// Samples of `u` at `times`, band limited.
template <class Function>
RecordedInputs band_limited(std::vector<double> times, const Function& u) {
  RecordedInputs out{std::move(times), {Hold::band_limited}, {}};
  for (const double t : out.t) out.values.push_back(u(t));
  set_slopes(out);
  return out;
}

std::vector<double> even_times(int samples, double step) {
  std::vector<double> out;
  for (int i = 0; i < samples; ++i) out.push_back(step * i);
  return out;
}

/// Within the interval after sample k.
RunningInput within(const RecordedInputs& record, std::size_t k, double share) {
  InputsAt begin(&record.values[k]), end(&record.values[k + 1]);
  begin.slopes = &record.slopes[k];
  end.slopes = &record.slopes[k + 1];
  return input_within(Hold::band_limited, begin, end, 0, share, record.t[k + 1] - record.t[k]);
}

TEST(BandLimitedInput, FollowsASineOfNinePointsAPeriodAHundredTimesCloserThanAStraightLine) {
  constexpr double step = 0.01, rate = 0.7 / step;  // 0.7 rad per sample, as the Silverbox oscillates
  const RecordedInputs record = band_limited(even_times(101, step), [](double t) { return std::sin(rate * t); });
  double worst = 0.0, worst_of_rate = 0.0, worst_of_line = 0.0;
  for (std::size_t k = 40; k < 60; ++k) {
    for (const double share : {0.25, 0.5, 0.75}) {
      const double t = record.t[k] + share * step;
      const RunningInput u = within(record, k, share);
      worst = std::max(worst, std::abs(u.value - std::sin(rate * t)));
      worst_of_rate = std::max(worst_of_rate, std::abs(u.rate / rate - std::cos(rate * t)));
      worst_of_line =
          std::max(worst_of_line, std::abs(record.values[k] + share * (record.values[k + 1] - record.values[k]) - std::sin(rate * t)));
    }
  }
  EXPECT_GT(worst_of_line, 0.05) << "of a straight line 0.7^2/8";
  EXPECT_LT(worst, 1e-3) << "of the Hermite cubic 0.7^4/384, and what its slopes are off by";
  EXPECT_LT(worst_of_rate, 1e-2);
}

TEST(BandLimitedInput, IsACubicSplineThroughUnevenSamplesWithoutCurvatureAtItsEnds) {
  const RecordedInputs record = band_limited({0.0, 1.0, 2.5, 3.0, 5.0, 6.0}, [](double t) { return std::sin(2.0 * t); });
  constexpr double beside = 1e-5;
  const auto curvature = [&](std::size_t k, double share) {
    const double h = record.t[k + 1] - record.t[k];
    return (within(record, k, share + beside).rate - within(record, k, share - beside).rate) / (2.0 * beside * h);
  };
  for (std::size_t k = 0; k + 1 < record.t.size(); ++k) {
    EXPECT_NEAR(within(record, k, 0.0).value, record.values[k], 1e-14);
    EXPECT_NEAR(within(record, k, 1.0).value, record.values[k + 1], 1e-14);
    if (k > 0) {
      EXPECT_NEAR(curvature(k - 1, 1.0), curvature(k, 0.0), 1e-6) << k;
    }
  }
  EXPECT_NEAR(curvature(0, 0.0), 0.0, 1e-6);
  EXPECT_NEAR(curvature(4, 1.0), 0.0, 1e-6);
}

TEST(BandLimitedInput, AsItWasEarlierHasTheMeanAndTheFirstMomentOfTheSpline) {
  const RecordedInputs record = band_limited(even_times(40, 0.5), [](double t) { return std::cos(1.3 * t); });
  constexpr double from = 10.0, to = 10.5, delay = 0.7, middle = 0.5 * (from + to);
  constexpr int parts = 20000;
  double mean = 0.0, moment = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double t = from + (i + 0.5) * (to - from) / parts - delay;
    const auto k = static_cast<std::size_t>(t / 0.5);
    const double u = within(record, k, (t - record.t[k]) / 0.5).value / parts;
    mean += u;
    moment += (t + delay - middle) * u * (to - from);
  }
  const InputsAt run{nullptr, &record, from, to};
  const double slope = (late_input(run, 0, to, delay).value - late_input(run, 0, from, delay).value) / (to - from);
  EXPECT_NEAR(late_input(run, 0, middle, delay).value, mean, 1e-8);
  EXPECT_NEAR(slope * std::pow(to - from, 3) / 12.0, moment, 1e-8);
}

TEST(BandLimitedInput, BetweenInstantsOfUnknownSlopeIsAStraightLine) {
  const std::array<double, 1> begin = {1.0}, end = {3.0};
  EXPECT_DOUBLE_EQ(input_within(Hold::band_limited, begin.data(), end.data(), 0, 0.25, 2.0).value, 1.5);
  EXPECT_DOUBLE_EQ(input_within(Hold::band_limited, begin.data(), end.data(), 0, 0.25, 2.0).rate, 1.0);
  EXPECT_DOUBLE_EQ(input_within(Hold::zero_order, begin.data(), end.data(), 0, 0.25, 2.0).value, 1.0);
}

TEST(LateInput, WithoutARecordIsWhatItIs) {
  const std::array<double, 2> now = {3.0, 4.0};
  EXPECT_EQ(late_input(now.data(), 1, 5.0, 0.7).value, 4.0);
}

}  // namespace
}  // namespace misfit
