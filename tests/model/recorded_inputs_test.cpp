#include "misfit/model/recorded_inputs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

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
  const auto& [times, hold, values] = recorded();
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

TEST(LateInput, WithoutARecordIsWhatItIs) {
  const std::array<double, 2> now = {3.0, 4.0};
  EXPECT_EQ(late_input(now.data(), 1, 5.0, 0.7).value, 4.0);
}

}  // namespace
}  // namespace misfit
