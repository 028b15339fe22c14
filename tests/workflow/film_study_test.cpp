// A film of a pendulum whose motion the tests integrate themselves, and a system as text that says where its bob is in the picture: the
// parameters come back.
#include <gmock/gmock.h>
#include <misfit_models_registry.h>

#include "misfit/core/error.h"
#include "misfit/misfit.h"
#include "misfit/workflow/measure/film_channels.h"
#include "tests/track/swing_scene.h"
#include "tests/workflow/film.h"

namespace {

using namespace film;
using testing::HasSubstr;

constexpr double rate = 30.0, natural_frequency = 4.2, friction = 0.06, length_px = 520.0, pivot_x = 160.0, pivot_y = -400.0;

/// Angle of theta'' = −omega0² sin theta − c theta' from 0.2 rad at rest, by Runge–Kutta in steps of 1 ms.
std::vector<double> angles(double duration) {
  std::vector<double> out{0.2};
  double q = 0.2, v = 0.0;
  constexpr double h = 1e-3;
  const auto a = [](double angle, double speed) { return -natural_frequency * natural_frequency * std::sin(angle) - friction * speed; };
  while (static_cast<double>(out.size()) * h < duration + 1.0) {
    const double v1 = v, a1 = a(q, v), v2 = v + 0.5 * h * a1, a2 = a(q + 0.5 * h * v1, v2);
    const double v3 = v + 0.5 * h * a2, a3 = a(q + 0.5 * h * v2, v3), v4 = v + h * a3, a4 = a(q + h * v3, v4);
    q += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    out.push_back(q);
  }
  return out;
}

scene::Swing pendulum(double duration) {
  scene::Swing swing;
  swing.duration = duration;
  swing.light = 0.2;
  swing.path = [table = angles(duration)](double t) {
    const double place = std::max(0.0, t) * 1000.0, k = std::floor(place);
    const auto i = static_cast<std::size_t>(k);
    const double angle = table[i] + (place - k) * (table[i + 1] - table[i]);
    return PixelPoint{pivot_x + length_px * std::sin(angle), pivot_y + length_px * std::cos(angle)};
  };
  return swing;
}

void write_swing(const fs::path& path, const scene::Swing& swing) {
  std::string why;
  const auto sink = video_backend().create(path.string(), swing.width, swing.height, rate, why);
  ASSERT_TRUE(sink) << why;
  for (int k = 0; k < static_cast<int>(swing.duration * rate); ++k) sink->write(scene::frame(swing, k / rate).bgr.data());
}

constexpr const char* states = R"toml(
[states]
theta = { unit = "rad", scale = 0.1 }
omega = { unit = "rad/s", scale = 0.4 }
[equations]
theta = "omega"
omega = "-natural_frequency^2*sin(theta) - friction*omega"
[parameters]
natural_frequency = { unit = "rad/s", value = 4.0, bounds = [0.1, 100.0], free = true }
friction = { unit = "1/s", value = 0.01, bounds = [0.0, 10.0], free = true }
)toml";

constexpr const char* camera_unknown = R"toml(
pivot_x = { unit = "px", value = 150.0, bounds = [-1e4, 1e4], free = true }
pivot_y = { unit = "px", value = -300.0, bounds = [-1e4, 1e4], free = true }
length_px = { unit = "px", value = 400.0, bounds = [10.0, 1e5], free = true }
[outputs]
x_px = { unit = "px", formula = "pivot_x + length_px*sin(theta)", noise = 0.3 }
y_px = { unit = "px", formula = "pivot_y + length_px*cos(theta)", noise = 0.3 }
)toml";

constexpr const char* in_metres = R"toml(
length = { unit = "m", value = 0.5, bounds = [0.01, 10.0] }
middle = { unit = "m", value = 0.0, bounds = [-1.0, 1.0], free = true }
[outputs]
sideways = { unit = "m", formula = "middle + length*sin(theta)", noise = 1e-3 }
)toml";

class FilmStudy : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    write_swing(folder->path() / "swing.mp4", pendulum(12.0));
  }
  static void TearDownTestSuite() { folder.reset(); }

  static fs::path study(const std::string& name, const std::string& system, const std::string& experiment, const std::string& video = "") {
    folder->write(name + "_system.toml", "[system]\ndoc = \"pendulum on film\"\nsource = \"textbook\"\n" + system);
    return folder->write(name + ".toml", "[study]\nname = \"film\"\nmethods = [\"output_error\"]\n[system]\nfile = \"" + name +
                                             "_system.toml\"\n" + video + "[[experiment]]\nvideo = \"swing.mp4\"\n" + experiment);
  }
  [[nodiscard]] Fit fitted(const fs::path& study, const std::string& out) const {
    return Identification({.study = study.string(), .out = (folder->path() / out).string()}, registry_).fit("output_error");
  }
  FilmStudy() { misfit_models_register(registry_); }

  Registry registry_;
  static std::unique_ptr<TemporaryFolder> folder;
};
std::unique_ptr<TemporaryFolder> FilmStudy::folder;

/// Within three standard errors of the truth, and these are of use.
void expect_found(const Fit& fit, const std::string& name, double truth, double largest_sigma) {
  ASSERT_TRUE(fit.parameters.contains(name)) << fit.message;
  const Estimate& p = fit.parameters.at(name);
  std::printf("    %s %.6g +- %.2g, true %.6g\n", name.c_str(), p.value, p.sigma, truth);
  EXPECT_NEAR(p.value, truth, 3.0 * p.sigma) << name;
  EXPECT_LT(p.sigma, largest_sigma) << name;
}

TEST_F(FilmStudy, OfACameraWithUnknownPoseGivesFrequencyFrictionAndPivot) {
  const Fit fit = fitted(study("pixels", std::string(states) + camera_unknown, ""), "out_pixels");
  ASSERT_TRUE(fit.usable()) << fit.message;
  expect_found(fit, "natural_frequency", natural_frequency, 0.005);
  expect_found(fit, "friction", friction, 0.005);
  EXPECT_NEAR(fit.parameters.at("pivot_x").value, pivot_x, 0.25);  // colour is recorded for every second pixel: half of that
  expect_found(fit, "length_px", length_px, 20.0);
  EXPECT_NEAR(fit.parameters.at("natural_frequency").value, natural_frequency, 1e-3 * natural_frequency);
}

TEST_F(FilmStudy, WithAKnownLengthIsInMetres) {
  const fs::path toml = study("metres", std::string(states) + in_metres, "columns = { sideways = \"x_m\" }\n",
                              "[video]\nlength = \"0.5 m\"\nlength_ends = [160, -400, 160, 120]\norigin = [160, 0]\n");
  const Fit fit = fitted(toml, "out_metres");
  ASSERT_TRUE(fit.usable()) << fit.message;
  expect_found(fit, "natural_frequency", natural_frequency, 0.005);
  expect_found(fit, "friction", friction, 0.005);
  EXPECT_NEAR(fit.parameters.at("middle").value, 0.0, 1e-3);  // a pixel is 0.96 mm
}

std::string refusal(const fs::path& study, const Registry& registry) {
  try {
    (void)Identification({.study = study.string()}, registry).fit();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(FilmStudy, WrongOnesAreRefusedInWords) {
  const std::string system = std::string(states) + camera_unknown;
  EXPECT_THAT(refusal(study("other", system, "columns = { x_px = \"x_mm\" }\n"), registry_),
              AllOf(HasSubstr("x_mm"), HasSubstr("but x_px, y_px, x_m and y_m")));
  EXPECT_THAT(refusal(study("ends", system, "", "[video]\nlength = \"0.5 m\"\n"), registry_), HasSubstr("length_ends"));
  EXPECT_THAT(refusal(study("zero", system, "", "[video]\nlength = \"0 m\"\nlength_ends = [1, 2, 3, 4]\n"), registry_),
              HasSubstr("above 0 m"));
  EXPECT_THAT(refusal(study("same", system, "", "[video]\nlength = \"1 m\"\nlength_ends = [1, 2, 1, 2]\n"), registry_),
              HasSubstr("two different places"));
  std::string plain = std::string(states) + "[outputs]\nangle = { unit = \"rad\", formula = \"theta\", noise = 1e-3 }\n";
  EXPECT_THAT(refusal(study("angle", plain, ""), registry_), AllOf(HasSubstr("[camera]"), HasSubstr("x_px, y_px")));
}

TEST(FilmTable, PixelsAreColumnsAndRowsAndMetresGoUpwards) {
  Track track;
  track.t = {0.0, 0.1};
  track.P_y = {-30.0, std::nan("")};
  track.P_z = {20.0, std::nan("")};
  track.ok = {true, false};
  TrackFacts facts;
  facts.width = 640;
  facts.height = 480;
  VideoStudy video;
  EXPECT_EQ(film_table({{"", track, facts}}, video).find("x_m"), nullptr);
  video.length = KnownLength{{0.0, 0.0}, {30.0, 40.0}, 0.1};  // 2 mm per pixel
  video.origin = PixelPoint{300.0, 250.0};
  const Table table = film_table({{"", track, facts}}, video);
  EXPECT_EQ(table.at("x_px").values[0], 350.0);
  EXPECT_EQ(table.at("y_px").values[0], 260.0);
  EXPECT_NEAR(table.at("x_m").values[0], 0.1, 1e-12);
  EXPECT_NEAR(table.at("y_m").values[0], -0.02, 1e-12);
  EXPECT_TRUE(std::isnan(table.at("x_px").values[1]));
}

/// Two bright spots, each on a spring of its own, in one film.
void write_two_spots(const fs::path& path, double duration) {
  constexpr int width = 200, height = 100, across = 4;
  Writer film(path, width, height, rate);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 2.0);
  for (int k = 0; k < static_cast<int>(duration * rate); ++k) {
    const double t = k / rate;
    const PixelPoint left{55.0 + 20.0 * std::cos(4.0 * t), 40.0}, right{145.0, 50.0 + 20.0 * std::cos(5.5 * t)};
    Image image(width, height);
    for (int at = 0; at < width * height; ++at) {
      double inside = 0.0;
      const int column = at % width, row = at / width;
      for (int part = 0; part < across * across; ++part) {
        const int right_of = part % across, below = part / across;
        const double x = column + (right_of + 0.5) / across - 0.5, y = row + (below + 0.5) / across - 0.5;
        for (const PixelPoint& spot : {left, right}) inside += std::hypot(x - spot.column, y - spot.row) < 8.0 ? 1.0 : 0.0;
      }
      image.pixels[static_cast<std::size_t>(at)] =
          static_cast<std::uint8_t>(std::clamp(40.0 + 170.0 * inside / (across * across) + noise(random), 0.0, 255.0));
    }
    film.add(image);
  }
}

constexpr const char* two_springs = R"toml(
[system]
doc = "two springs"
source = "textbook"
[states]
a = { unit = "px", scale = 20.0 }
va = { unit = "px/s", scale = 80.0, rate_of = "a" }
b = { unit = "px", scale = 20.0 }
vb = { unit = "px/s", scale = 80.0, rate_of = "b" }
[parameters]
wa = { unit = "rad/s", value = 3.8, bounds = [0.1, 100.0], free = true }
wb = { unit = "rad/s", value = 5.7, bounds = [0.1, 100.0], free = true }
rest_a = { unit = "px", value = 50.0, free = true }
rest_b = { unit = "px", value = 45.0, free = true }
[equations]
va = "-wa^2*a"
vb = "-wb^2*b"
[outputs]
x_px_left = { unit = "px", formula = "rest_a + a", noise = 0.3 }
down = { unit = "px", formula = "rest_b + b", noise = 0.3 }
)toml";

TEST(SeveralMarkers, AreFollowedInOneFilmAndReadByOutputsOfTheirNames) {
  const TemporaryFolder folder;
  write_two_spots(folder.path() / "spots.mkv", 6.0);
  folder.write("system.toml", two_springs);
  const std::string head =
      "[study]\nname = \"film\"\nmethods = [\"output_error\"]\n[system]\nfile = \"system.toml\"\n[video]\nmarker = "
      "\"bright\"\n[video.markers]\nleft = { region = [0, 0, 100, 100] }\n";
  const std::string tail = "[[experiment]]\nvideo = \"spots.mkv\"\ncolumns = { down = \"y_px_right\" }\n";
  const fs::path study = folder.write("study.toml", head + "right = { region = [100, 0, 200, 100] }\n" + tail);
  Registry registry;
  misfit_models_register(registry);
  const Fit fit = Identification({.study = study.string(), .out = (folder.path() / "out").string()}, registry).fit("output_error");
  ASSERT_TRUE(fit.usable()) << fit.message;
  expect_found(fit, "wa", 4.0, 0.005);
  expect_found(fit, "wb", 5.5, 0.005);
  EXPECT_NEAR(fit.parameters.at("rest_a").value, 55.0, 0.1);
  EXPECT_NEAR(fit.parameters.at("rest_b").value, 50.0, 0.1);
  for (const char* file : {"track-left.csv", "track-right.csv", "track-left.json", "figures/contact_sheet-right.png"})
    EXPECT_TRUE(fs::exists(folder.path() / "out" / file)) << file;

  const auto refused = [&](const std::string& text) { return refusal(folder.write("other.toml", text), registry); };
  EXPECT_THAT(refused(head + "[[experiment]]\nvideo = \"spots.mkv\"\ncolumns = { down = \"y_px_right\" }\n"),
              AllOf(HasSubstr("y_px_right"), HasSubstr("x_px_left, y_px_left, x_m_left and y_m_left")));
  EXPECT_THAT(refused(head + "\"the right\" = { start = [1, 2] }\n" + tail), HasSubstr("letters, digits and '_'"));
  EXPECT_THAT(refused(head + "right = { begin = [1, 2] }\n" + tail), HasSubstr("begin"));
}

}  // namespace
