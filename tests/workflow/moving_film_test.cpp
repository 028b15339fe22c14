// Films of a bob that swings, in colour, drawn by the tests and compressed: followed by its outline, never on a wrong place.
#include <gmock/gmock.h>

#include "misfit/core/error.h"
#include "tests/paths.h"
#include "tests/track/swing_scene.h"
#include "tests/workflow/film.h"

namespace {

using namespace film;
using testing::HasSubstr;

constexpr double rate = 30.0;

/// Writes the swing, every frame changed by `change` before it is compressed (.mp4: MPEG-4).
void write_film(const fs::path& path, const scene::Swing& swing, const std::function<void(misfit::ColourImage&, double)>& change = {}) {
  std::string why;
  const auto sink = video_backend().create(path.string(), swing.width, swing.height, rate, why);
  ASSERT_TRUE(sink) << why;
  for (int k = 0; k < static_cast<int>(swing.duration * rate); ++k) {
    misfit::ColourImage frame = scene::frame(swing, k / rate);
    if (change) change(frame, k / rate);
    sink->write(frame.bgr.data());
  }
}

VideoStudy automatic() {
  VideoStudy study;
  study.marker.kind = "auto";
  return study;
}

Score followed(const std::string& name, const scene::Swing& swing, const std::function<void(misfit::ColourImage&, double)>& change = {}) {
  const TemporaryFolder folder;
  write_film(folder.path() / "swing.mp4", swing, change);
  return score(
      name, folder.path() / "swing.mp4", automatic(), [&](std::size_t k) { return std::optional(swing.at(static_cast<double>(k) / rate)); },
      swing.radius);
}

/// Never on a wrong place, and the sigma is right within 1.5, as for rings.
void expect_no_lie(const Score& s) {
  EXPECT_LT(s.worst, 2.0);
  EXPECT_LT(s.z, 1.5);
  EXPECT_GT(s.z, 1.0 / 1.5);
}

void fill(misfit::ColourImage& image, int left, int right, const scene::Colour& colour) {
  for (int r = 0; r < image.height; ++r)
    for (int c = std::max(0, left); c <= std::min(image.width - 1, right); ++c)
      for (std::size_t k = 0; k < 3; ++k) image.bgr[image.at(c, r) + k] = static_cast<std::uint8_t>(colour[k]);
}

TEST(MovingFilm, ABobThatTurnsInChangingLightIsFoundInEveryFrame) {
  scene::Swing swing;
  swing.light = 0.4;
  swing.exposure = 1.0 / 60.0;
  const Score s = followed("bob, light, blur, turning", swing);
  EXPECT_GE(s.share(), 0.98);
  EXPECT_LT(s.rms_x, 0.4);
  EXPECT_LT(s.rms_y, 0.4);
  expect_no_lie(s);
  EXPECT_EQ(s.track.facts.marker, "moving");
  EXPECT_THAT(s.track.facts.chosen, HasSubstr("moves before a ground that stands still"));
  EXPECT_EQ(s.track.facts.fields, "progressive");
}

TEST(MovingFilm, HalfOfItLooksLikeTheWall) {
  scene::Swing swing;
  swing.like_the_wall = true;
  swing.turning = 0.0;
  swing.texture = 8.0;
  const Score s = followed("bob of which one half is the wall's colour", swing);
  EXPECT_GE(s.ok, s.inside * 8 / 10);
  EXPECT_LT(s.worst, 8.0);  // its visible half has its middle 6 px above that of the whole, always
}

TEST(MovingFilm, BehindAPostItIsLost) {
  const scene::Swing swing;
  const Score s = followed("bob that passes behind a post", swing, [](misfit::ColourImage& image, double) {
    fill(image, 150, 165, {60, 60, 60});
  });
  EXPECT_GE(s.share(), 0.5);
  EXPECT_LT(s.share(), 0.95);
  expect_no_lie(s);
}

TEST(MovingFilm, AHandThatPassesIsNotTaken) {
  const scene::Swing swing;
  const Score s = followed("hand in front", swing, [](misfit::ColourImage& image, double t) {
    const int hand = static_cast<int>(200.0 * (t - 5.0));
    if (t > 5.0 && t < 7.0) fill(image, hand - 40, hand, {90, 110, 190});
  });
  EXPECT_GE(s.share(), 0.8);
  expect_no_lie(s);
}

TEST(MovingFilm, TimesAreThoseOfTheFile) {
  // Made by ffmpeg (libx264, B-frames) from frames drawn at these times; ffprobe prints the same to 11 us.
  const auto time = [](double n) { return n / 30.0 + 0.008 * std::sin(1.3 * n) + (n > 60.0 ? (n - 60.0) / 60.0 : 0.0); };
  const VideoTrack result = track_video(paths::source() / "tests/apps/data/variable_rate.mp4", automatic());
  const Track& track = result.track;
  EXPECT_TRUE(result.facts.variable);
  EXPECT_EQ(result.facts.marker, "moving");
  ASSERT_GE(track.t.size(), 100u);  // the last frames out of a decoder have no time: as many as it holds back
  std::size_t ok = 0;
  for (std::size_t k = 0; k < track.t.size(); ++k) {
    const double t = time(static_cast<double>(k));
    EXPECT_NEAR(track.t[k], t, 2e-5);
    if (!track.ok[k]) continue;
    ++ok;
    EXPECT_NEAR(120.0 - track.P_y[k], 120.0 + 70.0 * std::sin(4.5 * t), 0.8);
    EXPECT_NEAR(80.0 + track.P_z[k], 80.0 + 20.0 * std::cos(4.5 * t), 0.8);
  }
  EXPECT_GE(ok, track.t.size() * 95 / 100);
  EXPECT_THAT(result.facts.warnings, testing::Contains(HasSubstr("do not follow each other at a constant rate")));
}

TEST(MovingFilm, AWallWithoutABobIsAnsweredInWords) {
  const TemporaryFolder folder;
  scene::Swing swing;
  swing.radius = 0.0;
  swing.duration = 2.0;
  write_film(folder.path() / "wall.mp4", swing);
  VideoStudy study;
  study.marker.kind = "moving";
  try {
    (void)track_video(folder.path() / "wall.mp4", study);
    FAIL() << "something was followed";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("wall.mp4"), HasSubstr("no object of one size moves"), HasSubstr("[video] marker")));
  }
}

}  // namespace
