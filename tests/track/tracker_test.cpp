#include "misfit/track/tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "misfit/track/survey.h"
#include "tests/track/pictures.h"

namespace misfit {
namespace {

using namespace pictures;

PixelPoint path(int k) { return {100.0 + 60.0 * std::sin(0.11 * k), 80.0 + 45.0 * std::cos(0.09 * k)}; }

struct Result {
  std::vector<TrackedSample> samples;
  int ok = 0;
  double worst = 0.0;
};

/// Surveys and tracks `count` progressive frames made by `make`.
Result track(const Marker& marker, int count, const std::function<Field(int)>& make, std::optional<PixelPoint> start = {}) {
  Survey survey({marker, start, {}});
  for (int k = 0; k < 30; ++k) {
    const Field field = make(k);
    survey.add(field.image, k);
  }
  Result out;
  const auto look = survey.appearance();
  if (!look) return out;
  Tracker tracker({*look, start, {}, survey.still()});
  for (int k = 0; k < count; ++k) tracker.add(make(k));
  out.samples = tracker.finish();
  for (int k = 0; k < count; ++k) {
    const TrackedSample& s = out.samples[static_cast<std::size_t>(k)];
    if (s.loss != Loss::none) continue;
    ++out.ok;
    out.worst = std::max(out.worst, std::hypot(s.at.column - path(k).column, s.at.row - path(k).row));
  }
  return out;
}

Field with(const std::vector<Disc>& discs, int k) { return noisy_picture(discs, 200, 160, 0, 1, 3.0, static_cast<unsigned>(k + 1)); }

TEST(Tracker, FollowsEveryKindOfMarker) {
  const std::vector<std::pair<MarkerKind, Disc>> kinds{
      {MarkerKind::ring, {{}, 9.0, 4.0}}, {MarkerKind::bright, {{}, 7.0, 0.0}}, {MarkerKind::dark, {{}, 7.0, 0.0, 30.0, 0.0}}};
  for (const auto& [k, disc] : kinds) {
    const Result r = track(kind(k), 80, [&d = disc](int n) {
      Disc moved = d;
      moved.at = path(n);
      return with({moved}, n);
    });
    EXPECT_EQ(r.ok, 80) << name_of(k);
    EXPECT_LT(r.worst, 0.2) << name_of(k);
  }
}

TEST(Tracker, FollowsAPictureCutFromAFrame) {
  const auto make = [](int n) { return with({{path(n), 8.0, 3.0}, {{path(n).column + 7.0, path(n).row + 5.0}, 3.0, 0.0, 40.0, 0.0}}, n); };
  const Field first = make(0);
  const int c = static_cast<int>(std::lround(path(0).column)), r = static_cast<int>(std::lround(path(0).row));
  Marker marker = kind(MarkerKind::picture);
  marker.levels = {0.0, 1.0, 0.0};
  marker.picture = Image(27, 25);
  for (int j = 0; j < 25; ++j)
    for (int i = 0; i < 27; ++i) marker.picture(i, j) = first.image(c - 13 + i, r - 12 + j);
  const Result result = track(marker, 80, make);
  EXPECT_GE(result.ok, 78);
  EXPECT_LT(result.worst, 1.0);  // the picture is cut to whole pixels
}

TEST(Tracker, SomethingAlikeThatStandsStillIsNotTaken) {
  const Result r = track(kind(MarkerKind::bright), 90, [](int n) {
    std::vector<Disc> discs{{{40.0, 30.0}, 7.0, 0.0}};
    if (n < 50 || n > 70) discs.push_back({path(n), 7.0, 0.0});  // the marker is hidden for a while; the other is not
    return with(discs, n);
  });
  EXPECT_GT(r.ok, 60);
  EXPECT_LT(r.worst, 0.5);
  for (std::size_t k = 50; k <= 70; ++k) EXPECT_NE(r.samples[k].loss, Loss::none) << k;
}

TEST(Tracker, AStartSaysWhichOfTwo) {
  const auto make = [](int n) { return with({{path(n), 9.0, 4.0}, {{200.0 - path(n).column, path(n + 20).row}, 13.0, 6.0}}, n); };
  const Result r = track(kind(MarkerKind::ring), 25, make, path(0));
  EXPECT_GT(r.ok, 15);
  EXPECT_LT(r.worst, 0.5);
}

TEST(Tracker, LeavingTheFrameIsSaidAndTheMarkerFoundAgain) {
  const auto leaving = [](int k) { return PixelPoint{100.0 + 130.0 * std::sin(0.05 * k), 80.0}; };
  Survey survey({kind(MarkerKind::ring), {}, {}});
  const auto make = [&](int k) { return with({{leaving(k), 9.0, 4.0}}, k); };
  for (int k = 0; k < 20; ++k) survey.add(make(k).image, k);
  ASSERT_TRUE(survey.appearance());
  Tracker tracker({*survey.appearance(), {}, {}, {}});
  for (int k = 0; k < 63; ++k) tracker.add(make(k));
  const auto samples = tracker.finish();
  for (int k = 0; k < 63; ++k) {
    const auto& s = samples[static_cast<std::size_t>(k)];
    const bool inside = leaving(k).column < 190.0;
    if (inside) {
      EXPECT_EQ(s.loss, Loss::none) << k;
    }
    if (leaving(k).column > 192.0) {
      EXPECT_EQ(s.loss, Loss::outside) << k;
    }
  }
}

TEST(Tracker, HalfHiddenIsLost) {
  const Result whole = track(kind(MarkerKind::ring), 40, [](int n) { return with({{path(n), 9.0, 4.0}}, n); });
  ASSERT_EQ(whole.ok, 40);
  const Result r = track(kind(MarkerKind::ring), 40, [](int n) {
    Field field = with({{path(n), 9.0, 4.0}}, n);
    if (n == 34)
      for (int row = 0; row < 160; ++row)
        for (int c = static_cast<int>(path(n).column); c < 200; ++c) field.image(c, row) = 120;
    return field;
  });
  EXPECT_NE(r.samples[34].loss, Loss::none);
  EXPECT_EQ(r.ok, 39);
}

TEST(Tracker, CopiesAndMissingFramesAreLost) {
  Survey survey({kind(MarkerKind::ring), {}, {}});
  const auto make = [](int k) { return with({{path(k), 9.0, 4.0}}, k); };
  for (int k = 0; k < 20; ++k) survey.add(make(k).image, k);
  Tracker tracker({*survey.appearance(), {}, {}, {}});
  for (int k = 0; k < 40; ++k) {
    if (k == 15) {
      tracker.add_missing();
    } else {
      tracker.add(make(k == 25 ? 24 : k), k == 25);
    }
  }
  const auto samples = tracker.finish();
  EXPECT_EQ(samples[15].loss, Loss::no_frame);
  EXPECT_EQ(samples[25].loss, Loss::copy);
  EXPECT_EQ(std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.loss == Loss::none; }), 38);
}

TEST(Survey, FindsNothingWhereNothingIs) {
  Survey survey({kind(MarkerKind::ring), {}, {}});
  for (int k = 0; k < 6; ++k) survey.add(with({}, k).image, k);
  EXPECT_FALSE(survey.appearance());
  EXPECT_FALSE(survey.enough());
}

TEST(WhiteError, IsSeenInPositionsOfASmoothMotion) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.2);
  std::vector<TrackedSample> samples;
  for (int k = 0; k < 600; ++k) {
    const double angle = 0.13 * k;
    samples.push_back(
        {Loss::none, {160.0 + 90.0 * std::cos(angle) + noise(random), 90.0 + 4.0 * std::sin(2.0 * angle) + noise(random)}, 0.01, 0.9});
    if (k % 50 == 7) samples.back() = {Loss::covered, {}, 0.0, 0.0};
  }
  EXPECT_NEAR(white_error(samples), 0.2, 0.02);
  EXPECT_EQ(white_error(std::vector<TrackedSample>(samples.begin(), samples.begin() + 12)), 0.0);
}

TEST(PixelLocking, IsSeenInPositionsThatPreferFractions) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(0.0, 500.0);
  std::vector<double> free, pulled;
  for (int k = 0; k < 3000; ++k) {
    const double x = anywhere(random);
    free.push_back(x);
    pulled.push_back(x - 0.14 * std::sin(2.0 * 3.14159265358979 * x));  // RMS 0.099
  }
  EXPECT_LT(pixel_locking(free, 1.0), 0.03);
  EXPECT_NEAR(pixel_locking(pulled, 1.0), 0.099 * std::sqrt(2.0), 0.02);
  EXPECT_DOUBLE_EQ(pixel_locking({1.0, 2.0}, 1.0), 0.1);
}

}  // namespace
}  // namespace misfit
