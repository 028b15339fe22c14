// Films of a plane that a camera sees obliquely, with a chessboard, tags or known places in it: the way of a tag in metres, within the
// sigma that is said, and in words what cannot be.
#include <gmock/gmock.h>
#include <misfit_models_registry.h>

#include "misfit/core/error.h"
#include "misfit/misfit.h"
#include "misfit/workflow/measure/film_channels.h"
#include "misfit/workflow/measure/plane_calibration.h"
#include "tests/track/oblique_scene.h"
#include "tests/workflow/film.h"

namespace {

using namespace film;
using oblique::Camera;
using oblique::Paint;
using oblique::Place;
using testing::AllOf;
using testing::HasSubstr;

constexpr double rate = 30.0, natural_frequency = 5.2, friction = 0.08, length = 0.36;  // [1/s], [rad/s], [1/s], [m]
constexpr Place pivot{0.02, 0.22}, corner{-0.15, -0.11}, other_tag{0.28, 0.2};          // [m]; inner corner of the board

/// Angle of theta'' = −omega0² sin theta − c theta' from 0.7 rad at rest, by Heun's steps of 0.1 ms.
std::vector<double> angles(int frames) {
  std::vector<double> out;
  double q = 0.7, v = 0.0;
  constexpr double h = 1e-4;
  const auto a = [](double angle, double speed) { return -natural_frequency * natural_frequency * std::sin(angle) - friction * speed; };
  double next = 0.0;
  for (long k = 0; static_cast<int>(out.size()) < frames; ++k) {
    if (static_cast<double>(k) * h >= next - 0.5 * h) {
      out.push_back(q);
      next += 1.0 / rate;
    }
    const double a1 = a(q, v), v2 = v + h * a1, a2 = a(q + h * v, v2);
    q += 0.5 * h * (v + v2);
    v += 0.5 * h * (a1 + a2);
  }
  return out;
}

Place bob(double angle) { return {pivot.x + length * std::sin(angle), pivot.y - length * std::cos(angle)}; }

/// A tag (7) swings before a board of 8 x 6 squares of 40 mm and a second tag (23 of 5x5).
class FilmOfAPlane : public testing::Test {
 protected:
  static constexpr int frames = 100;

  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    way = angles(frames);
    const oblique::View view(camera);
    const Paint board = oblique::chessboard(8, 6, 0.04, corner);
    const Paint second = oblique::tag(oblique::tag_23_of_5x5, other_tag, 0.09);
    Writer writer(folder->path() / "swing.mkv", camera.width, camera.height, rate);
    for (int k = 0; k < frames; ++k) {
      const double angle = way[static_cast<std::size_t>(k)];
      writer.add(view.picture({board, second, oblique::tag(oblique::tag_7_of_4x4, bob(angle), 0.06, angle)}, static_cast<unsigned>(k)));
    }
  }
  static void TearDownTestSuite() { folder.reset(); }

  static fs::path path() { return folder->path() / "swing.mkv"; }
  static VideoStudy study() {
    VideoStudy video;
    video.fields = "auto";
    video.marker = {"aruco", std::nullopt, 7};
    video.aruco.dictionary = "4x4";
    return video;
  }
  /// Followed once: it does not depend on the source of metres.
  static const VideoTrack& followed() {
    static const VideoTrack track = track_video(path(), study());
    return track;
  }
  static void expect_places(const PlaneFacts& plane, const VideoStudy& video, const Place& origin);

  static const Camera camera;
  static std::vector<double> way;
  static std::unique_ptr<TemporaryFolder> folder;
};
const Camera FilmOfAPlane::camera;
std::vector<double> FilmOfAPlane::way;
std::unique_ptr<TemporaryFolder> FilmOfAPlane::folder;

/// Errors are those of the track, which differ from frame to frame, and those of the map, which are common to all: both within what is
/// said.
void FilmOfAPlane::expect_places(const PlaneFacts& plane, const VideoStudy& video, const Place& origin) {
  FilmTrack film{"", followed().track, followed().facts};
  film.facts.plane = plane;
  const Table table = film_table({film}, video);
  double sum = 0.0, worst = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    if (!film.track.ok[k]) continue;
    const Place truth = bob(way[k]);
    const double x = table.at("x_m").values[k] - truth.x + origin.x, y = table.at("y_m").values[k] - truth.y + origin.y;
    const double sigma = std::hypot(film.track.sigma[k] * plane.scale, plane.sigma);
    sum += 0.5 * (x * x + y * y) / (sigma * sigma);
    worst = std::max(worst, std::hypot(x, y));
    ++count;
  }
  ASSERT_GT(count, 90);
  std::printf("    %s: %d of %zu, errors %.2f sigma (RMS), worst %.2f mm; map %.3f px RMS, known to %.2f mm\n", plane.from.c_str(), count,
              way.size(), std::sqrt(sum / count), 1e3 * worst, plane.rms, 1e3 * plane.sigma);
  EXPECT_LT(sum / count, 2.0 * 2.0);
}

TEST_F(FilmOfAPlane, ATagIsFollowedInAllFramesAndPlacedWithinItsSigma) {
  const Track& track = followed().track;
  EXPECT_EQ(followed().facts.ok, static_cast<std::size_t>(frames));
  EXPECT_THAT(followed().facts.marker, HasSubstr("ArUco tag 7 of 4x4"));
  double squares = 0.0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const PixelPoint truth = camera.pixel(bob(way[k]));
    const double x = 0.5 * camera.width - track.P_y[k] - truth.column, y = 0.5 * camera.height + track.P_z[k] - truth.row;
    EXPECT_LT(std::hypot(x, y), 6.0 * track.sigma[k]) << k;
    squares += 0.5 * (x * x + y * y) / (track.sigma[k] * track.sigma[k]) / frames;
  }
  std::printf("    errors are %.2f sigma (RMS), median sigma %.3f px\n", std::sqrt(squares), followed().facts.sigma);
  EXPECT_LT(squares, 1.5 * 1.5);
  EXPECT_LT(followed().facts.sigma, 0.15);
}

TEST_F(FilmOfAPlane, WithAChessboardHiddenInSomeFramesHasPlacesInMetres) {
  VideoStudy video = study();
  video.chessboard = ChessboardStudy{8, 6, 0.04};
  const auto plane = calibrate_plane(path(), video, followed().track);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->points, 35U);
  EXPECT_GE(plane->frames, 1U);
  EXPECT_LT(plane->frames, 16U) << "the bob hides it in others";
  EXPECT_LT(plane->rms, 0.25);
  EXPECT_GT(plane->sigma, 0.0);
  expect_places(*plane, video, corner);
  video.origin = camera.pixel(pivot);
  expect_places(*calibrate_plane(path(), video, followed().track), video, pivot);
}

TEST_F(FilmOfAPlane, WithKnownPointsHasPlacesInMetres) {
  VideoStudy video = study();
  std::mt19937 random(5);
  std::normal_distribution<double> error(0.0, 0.4);
  for (const Place& p : {Place{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.25}, {-0.3, 0.25}, {0.0, -0.25}, {0.1, 0.3}, {-0.32, 0.0}}) {
    const PixelPoint at = camera.pixel(p);
    video.points.push_back(
        {"p" + std::to_string(video.points.size()), PixelPoint{at.column + error(random), at.row + error(random)}, std::nullopt, p.x, p.y});
  }
  const auto plane = calibrate_plane(path(), video, followed().track);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->frames, 0U);
  EXPECT_TRUE(plane->warnings.empty());
  expect_places(*plane, video, {0.0, 0.0});

  video.points[4].at->column += 60.0;
  EXPECT_THAT(calibrate_plane(path(), video, followed().track)->warnings, testing::ElementsAre(AllOf(HasSubstr("'p4'"), HasSubstr("px"))));
  video.points.resize(4);
  std::swap(video.points[0].at, video.points[1].at);
  try {
    (void)calibrate_plane(path(), video, followed().track);
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_THAT(refused.what(), AllOf(HasSubstr("video.points"), HasSubstr("exchanged")));
  }
}

TEST_F(FilmOfAPlane, WithATagThatStandsStillHasPlacesInMetres) {
  VideoStudy video = study();
  video.aruco = {"5x5", 23, 0.09};
  const auto plane = calibrate_plane(path(), video, followed().track);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->from, "aruco");
  EXPECT_EQ(plane->points, 4U);
  EXPECT_GT(plane->sigma, 1e-3) << "a small tag far from the bob says little";
  expect_places(*plane, video, other_tag);

  video.aruco.plane.reset();
  for (const Place& p : {Place{-0.3, -0.2}, {0.3, -0.2}, {-0.3, 0.25}})
    video.points.push_back({"p" + std::to_string(video.points.size()), camera.pixel(p), std::nullopt, p.x, p.y});
  video.points.push_back({"tag", std::nullopt, 23, other_tag.x, other_tag.y});
  expect_places(*calibrate_plane(path(), video, followed().track), video, {0.0, 0.0});
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const RunError& refused) {
    return refused.what();
  }
  return "no error";
}

TEST_F(FilmOfAPlane, WhatIsNotInThePictureIsSaidInWords) {
  VideoStudy video = study();
  const Track& track = followed().track;
  video.chessboard = ChessboardStudy{7, 6, 0.04};
  EXPECT_THAT(refusal([&] { (void)calibrate_plane(path(), video, track); }),
              AllOf(HasSubstr("swing.mkv"), HasSubstr("7 x 6"), HasSubstr("8 x 6 squares"), HasSubstr("[video.chessboard]")));
  video.chessboard.reset();
  video.aruco.plane = 23;
  video.aruco.side = 0.09;
  EXPECT_THAT(refusal([&] { (void)calibrate_plane(path(), video, track); }), AllOf(HasSubstr("tag 23"), HasSubstr("seen are 7")));
  video.aruco.plane = 7;
  EXPECT_THAT(refusal([&] { (void)calibrate_plane(path(), video, track); }), HasSubstr("must stand still"));
  video = study();
  video.marker.id = 8;
  EXPECT_THAT(refusal([&] { (void)track_video(path(), video); }),
              AllOf(HasSubstr("tag 8"), HasSubstr("none of 100 frames"), HasSubstr("7")));
  video.marker.id = 7;
  video.region = {0.0, 0.0, 20.0, 20.0};
  EXPECT_THAT(refusal([&] { (void)track_video(path(), video); }), HasSubstr("none of 100 frames"));
}

TEST(FilmWithAHiddenBoard, IsDeclinedInWords) {
  const TemporaryFolder folder;
  const oblique::View view{Camera{}};
  {
    Writer writer(folder.path() / "hidden.mkv", 480, 360, rate);
    for (unsigned k = 0; k < 6; ++k)
      writer.add(view.picture({oblique::chessboard(8, 6, 0.04, corner), oblique::disc({0.1, 0.05}, 0.05, 90.0)}, k));
  }
  VideoStudy video;
  video.chessboard = ChessboardStudy{8, 6, 0.04};
  EXPECT_THAT(refusal([&] { (void)calibrate_plane(folder.path() / "hidden.mkv", video, {}); }),
              AllOf(HasSubstr("just 8 x 6 squares is seen whole"), HasSubstr("hidden")));
}

TEST(FilmThroughALens, HasItsDistortionFromTheChessboard) {
  const TemporaryFolder folder;
  Camera camera;
  camera.k1 = -0.12;
  camera.yaw = 0.4;
  const oblique::View view(camera);
  {
    Writer writer(folder.path() / "lens.mkv", camera.width, camera.height, rate);
    for (unsigned k = 0; k < 4; ++k) writer.add(view.picture({oblique::chessboard(12, 9, 0.05, {-0.25, -0.18})}, k));
  }
  Track track;
  std::vector<Place> places;
  for (int k = 0; k < 20; ++k) {
    places.push_back({0.25 * std::cos(0.9 * k), 0.18 * std::sin(1.3 * k)});
    const PixelPoint at = camera.pixel(places.back());
    track.t.push_back(0.1 * k);
    track.P_y.push_back(0.5 * camera.width - at.column);
    track.P_z.push_back(at.row - 0.5 * camera.height);
    track.ok.push_back(true);
  }
  VideoStudy video;
  video.chessboard = ChessboardStudy{12, 9, 0.05};
  const auto plane = calibrate_plane(folder.path() / "lens.mkv", video, track);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->k1, camera.k1, 0.01);
  const PlaneMap map = map_of(*plane);
  double worst = 0.0;
  for (const Place& p : places) {
    const PixelPoint at = camera.pixel(p);
    const auto found = map.place({at.column, at.row});
    ASSERT_TRUE(found);
    worst = std::max(worst, std::hypot(found->x() - p.x - 0.25, found->y() - p.y - 0.18));
  }
  std::printf("    k1 %.4f, worst %.3f mm, known to %.3f mm, %.3f px RMS\n", plane->k1, 1e3 * worst, 1e3 * plane->sigma, plane->rms);
  EXPECT_LT(worst, 4.0 * plane->sigma);
}

/// A tag that goes to the right, 9 mm in a frame; frame 12 shows it where frame 11 does, and a second one stands below it.
TEST(FilmOfTags, LosesAFrameShownTwiceAndAsksWhichOfTwoOfOneId) {
  const TemporaryFolder folder;
  const oblique::Camera camera{240, 180, 300.0, 0.5, 0.2, 1.2, 0.0};
  const oblique::View view(camera);
  const auto at = [](int k) { return Place{-0.1 + 0.009 * (k == 12 ? 11 : k), 0.05}; };
  {
    Writer one(folder.path() / "one.mkv", camera.width, camera.height, rate),
        two(folder.path() / "two.mkv", camera.width, camera.height, rate);
    for (int k = 0; k < 24; ++k) {
      const Paint moving = oblique::tag(oblique::tag_7_of_4x4, at(k), 0.12);
      one.add(view.picture({moving}, static_cast<unsigned>(k)));
      two.add(view.picture({oblique::tag(oblique::tag_7_of_4x4, {0.0, -0.15}, 0.12), moving}, static_cast<unsigned>(k)));
    }
  }
  VideoStudy video;
  video.fields = "auto";
  video.marker = {"aruco", std::nullopt, 7};
  video.aruco.dictionary = "4x4";
  const VideoTrack track = track_video(folder.path() / "one.mkv", video);
  ASSERT_EQ(track.track.ok.size(), 24U);
  EXPECT_FALSE(track.track.ok[12]);
  EXPECT_TRUE(track.track.ok[11] && track.track.ok[13]);
  EXPECT_EQ(track.facts.ok, 23U);

  EXPECT_THAT(refusal([&] { (void)track_video(folder.path() / "two.mkv", video); }),
              AllOf(HasSubstr("two tags of id 7"), HasSubstr("start")));
  video.start = camera.pixel(at(0));
  const VideoTrack chosen = track_video(folder.path() / "two.mkv", video);
  for (int k = 0; k < 24; ++k) {
    if (!chosen.track.ok[static_cast<std::size_t>(k)]) continue;
    EXPECT_NEAR(0.5 * camera.width - chosen.track.P_y[static_cast<std::size_t>(k)], camera.pixel(at(k)).column, 0.3) << k;
  }
}

constexpr const char* pendulum = R"toml([system]
doc = "pendulum on film"
source = "textbook"
[states]
theta = { unit = "rad", scale = 0.1 }
omega = { unit = "rad/s", scale = 0.4 }
[equations]
theta = "omega"
omega = "-natural_frequency^2*sin(theta) - friction*omega"
[parameters]
natural_frequency = { unit = "rad/s", value = 5.0, bounds = [0.1, 100.0], free = true }
friction = { unit = "1/s", value = 0.01, bounds = [0.0, 10.0], free = true }
length = { unit = "m", value = 0.3, bounds = [0.01, 10.0], free = true }
pivot_x = { unit = "m", value = 0.1, bounds = [-10.0, 10.0], free = true }
pivot_y = { unit = "m", value = 0.3, bounds = [-10.0, 10.0], free = true }
[outputs]
x_m = { unit = "m", formula = "pivot_x + length*sin(theta)", noise = 1e-3 }
y_m = { unit = "m", formula = "pivot_y - length*cos(theta)", noise = 1e-3 }
)toml";

TEST_F(FilmOfAPlane, GivesAPendulumItsFrequencyAndLength) {
  folder->write("system.toml", pendulum);
  const fs::path toml = folder->write("study.toml", R"toml([study]
name = "film"
methods = ["output_error"]
[system]
file = "system.toml"
[video]
marker = "aruco"
id = 7
[video.chessboard]
columns = 8
rows = 6
square = "40 mm"
[[experiment]]
video = "swing.mkv"
)toml");
  Registry registry;
  misfit_models_register(registry);
  const Fit fit = Identification({.study = toml.string(), .out = (folder->path() / "out").string()}, registry).fit("output_error");
  ASSERT_TRUE(fit.usable()) << fit.message;
  const double board = read_track_facts(folder->path() / "out/track.json").plane.value().sigma;
  const auto expect = [&](const char* name, double truth, double common, double largest) {
    const Estimate& p = fit.parameters.at(name);
    std::printf("    %s %.6g +- %.2g %s, true %.6g\n", name, p.value, p.sigma, p.unit.c_str(), truth);
    EXPECT_NEAR(p.value, truth, 3.0 * std::hypot(p.sigma, common)) << name;
    EXPECT_LT(p.sigma, largest) << name;
  };
  expect("natural_frequency", natural_frequency, 0.0, 0.005);
  expect("friction", friction, 0.0, 0.01);
  expect("length", length, board, 2e-3);
  expect("pivot_x", pivot.x - corner.x, board, 2e-3);
  expect("pivot_y", pivot.y - corner.y, board, 2e-3);
}

}  // namespace
