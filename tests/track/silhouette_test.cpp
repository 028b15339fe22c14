#include "misfit/track/silhouette.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/track/locate.h"
#include "tests/track/swing_scene.h"

namespace misfit {
namespace {

using testing::HasSubstr;

std::vector<ColourImage> spread(const scene::Swing& swing, int count = 24) {
  std::vector<ColourImage> frames;
  for (int k = 0; k < count; ++k) frames.push_back(scene::frame(swing, swing.duration * k / count));
  return frames;
}

/// Places of the object in frames between those it was learnt from, against the truth.
struct Result {
  double worst = 0.0, mean_sigma = 0.0, rms = 0.0;
  Silhouette silhouette;
};

Result follow(const scene::Swing& swing) {
  const std::vector<ColourImage> frames = spread(swing);
  Background background(frames);
  std::string why;
  Result out;
  const auto found = find_silhouette(frames, background, {}, why);
  EXPECT_TRUE(found) << why;
  if (!found) return out;
  out.silhouette = *found;
  constexpr int count = 20;
  const double s = found->shrink;
  for (int k = 0; k < count; ++k) {
    const double t = swing.duration * (k + 0.37) / count;
    const PixelPoint truth = swing.at(t);
    const Image foreground = background.foreground(scene::frame(swing, t), found->shrink);
    const Location at =
        locate({foreground, 0, 1}, found->marker, {(truth.column + 3.0 + 0.5) / s - 0.5, (truth.row - 2.0 + 0.5) / s - 0.5});
    EXPECT_TRUE(at.converged);
    const double x = (at.at.column + 0.5) * s - 0.5 - truth.column, y = (at.at.row + 0.5) * s - 0.5 - truth.row;
    out.worst = std::max(out.worst, std::hypot(x, y));
    out.rms += 0.5 * (x * x + y * y) / count;
    out.mean_sigma += s * at.sigma / count;  // of the fit alone: what the outline is not, the tracker adds
  }
  out.rms = std::sqrt(out.rms);
  std::printf("    size %.1f x %.1f px, shrunk %d, RMS %.3f px, worst %.3f px, sigma %.3f px\n", found->width, found->height, found->shrink,
              out.rms, out.worst, out.mean_sigma);
  return out;
}

/// The outline of a disc is found from all sides alike: well within the width of a pixel.
void expect_close(const Result& r) {
  EXPECT_LT(r.worst, 0.6);
  EXPECT_LT(r.rms, 0.25);
}

TEST(Silhouette, OfABobThatTurnsBeforeATexturedWall) {
  const Result r = follow({});
  expect_close(r);
  EXPECT_NEAR(r.silhouette.width, 28.0, 2.5);
  EXPECT_NEAR(r.silhouette.height, 28.0, 2.5);
}

TEST(Silhouette, WhileTheLightChangesByHalf) {
  scene::Swing swing;
  swing.light = 0.5;
  expect_close(follow(swing));
}

TEST(Silhouette, BlurredByItsMotion) {
  scene::Swing swing;
  swing.exposure = 1.0 / 60.0;  // 6 px at the lowest point
  expect_close(follow(swing));
}

TEST(Silhouette, OfAnySize) {
  for (const double radius : {5.0, 9.0, 30.0}) {
    scene::Swing swing;
    swing.radius = radius;
    expect_close(follow(swing));
  }
}

std::string why_not(const std::vector<ColourImage>& frames) {
  Background background(frames);
  std::string why;
  EXPECT_FALSE(find_silhouette(frames, background, {}, why));
  return why;
}

TEST(Silhouette, NothingThatMovesIsSaid) {
  scene::Swing swing;
  swing.radius = 0.0;
  EXPECT_THAT(why_not(spread(swing)), HasSubstr("no object of one size moves"));
}

TEST(Silhouette, ACameraThatMovesIsSaid) {
  scene::Swing swing;
  swing.texture = 60.0;
  std::vector<ColourImage> frames = spread(swing);
  for (std::size_t k = 0; k < frames.size(); ++k)
    std::rotate(frames[k].bgr.begin(), frames[k].bgr.begin() + static_cast<std::ptrdiff_t>(3 * (37 * k % 101)), frames[k].bgr.end());
  EXPECT_THAT(why_not(frames), HasSubstr("the camera moves"));
}

TEST(Background, LightThatChangesSmoothlyIsNoForeground) {
  scene::Swing swing;
  swing.light = 0.6;
  const std::vector<ColourImage> frames = spread(swing);
  const Background background(frames);
  const Image foreground = background.foreground(frames.back());
  const PixelPoint bob = swing.at(swing.duration * 23 / 24.0);
  std::size_t wrong = 0;
  for (int r = 0; r < foreground.height; ++r)
    for (int c = 0; c < foreground.width; ++c)
      wrong += foreground(c, r) > 127 && std::hypot(c - bob.column, r - bob.row) > swing.radius + 2.0 ? 1 : 0;
  EXPECT_LT(wrong, 40u);
}

TEST(Blobs, PartsNearEachOtherAreOne) {
  Image picture(60, 40);
  for (int r = 10; r < 20; ++r)
    for (int c = 10; c < 30; ++c) picture(c, r) = c == 19 || c == 20 ? 0 : 255;
  for (int r = 30; r < 36; ++r)
    for (int c = 50; c < 56; ++c) picture(c, r) = 255;
  const std::vector<Blob> blobs = blobs_of(picture, 20.0);
  ASSERT_EQ(blobs.size(), 2u);
  EXPECT_NEAR(blobs[0].at.column, 19.5, 1e-9);
  EXPECT_NEAR(blobs[0].at.row, 14.5, 1e-9);
  EXPECT_EQ(blobs[0].area, 180.0);
  EXPECT_EQ(blobs[1].width(), 6.0);
}

}  // namespace
}  // namespace misfit
