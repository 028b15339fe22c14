// Every key of the reference is in a test; those that no other test writes are read here.
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "misfit/core/files.h"
#include "misfit/data/study_keys.h"
#include "tests/data/study_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using EveryKey = StudyFolder;

TEST_F(EveryKey, OfACameraGivenAsNumbersIsRead) {
  const Study study = read_with(R"([geometry]
R = "3.4 m"
[camera]
h_c = { value = "15 cm", sigma = 0.002 }
K = "133 px/m"
camera_roll = "2 deg"
centre_y = 6
centre_z = "-4 px"
pixel_aspect = 0.02
lens_k1 = -0.1
camera_distance = "5 cm"
)");
  const auto& given = study.camera.given;
  EXPECT_FALSE(study.camera.from_sweep());
  EXPECT_DOUBLE_EQ(given.at("h_c").value, 0.15);
  EXPECT_EQ(given.at("h_c").sigma, 0.002);
  EXPECT_DOUBLE_EQ(given.at("K").value, 133.0);
  EXPECT_DOUBLE_EQ(given.at("camera_roll").value, 2.0 * 3.14159265358979323846 / 180.0);
  EXPECT_EQ(given.at("centre_y").value, 6.0);
  EXPECT_EQ(given.at("centre_z").value, -4.0);
  EXPECT_EQ(given.at("pixel_aspect").value, 0.02);
  EXPECT_EQ(given.at("lens_k1").value, -0.1);
  EXPECT_DOUBLE_EQ(given.at("camera_distance").value, 0.05);
  EXPECT_EQ(given.size(), 8U);
}

TEST_F(EveryKey, OfNoiseIsRead) {
  const Study study = read_with("[noise]\nx = { frequency = \"0.13 Hz\" }\ny = { value = 2, fixed = false, frequency = 50 }\nz = 0.1\n");
  EXPECT_EQ(study.noise.at("x").frequency, 0.13);
  EXPECT_FALSE(study.noise.at("x").fixed) << "what is white and what is coloured is estimated together";
  EXPECT_EQ(study.noise.at("y").frequency, 50.0);
  EXPECT_EQ(study.noise.at("y").sigma.value, 2.0);
  EXPECT_TRUE(study.noise.at("z").fixed);
  EXPECT_FALSE(study.noise.at("z").frequency);
}

TEST_F(EveryKey, OfVideoAndPicturesIsRead) {
  const std::string experiment = "[[experiment]]\nvideo = \"flight.mkv\"\n";
  const Study study = read_with(experiment + R"([camera]
sweep_images = "other.csv"
sweep_marker = "bright"
sweep_points = [10, 20, 30, 40, 50, 60]
[video]
fields = "progressive"
check_fields = false
marker = "template.png"
start = [120, 80]
region = [10, 20, 300, 200]
)");
  EXPECT_EQ(study.experiments.front().video->filename(), "flight.mkv");
  EXPECT_EQ(study.camera.sweep_images->filename(), "other.csv");
  EXPECT_EQ(study.camera.sweep_marker.kind, "bright");
  ASSERT_EQ(study.camera.sweep_points.size(), 3U);
  EXPECT_EQ(study.video.fields, "progressive");
  EXPECT_FALSE(study.video.check_fields);
  EXPECT_EQ(study.video.marker.kind, "picture");
  EXPECT_EQ(study.video.marker.picture->filename(), "template.png");
  EXPECT_TRUE(study.video.start.has_value());
  EXPECT_EQ(study.video.region, (std::array<double, 4>{10.0, 20.0, 300.0, 200.0}));
  const Study plain = read_with(experiment +
                                "[camera]\nsweep_images = \"other.csv\"\n[video]\nmarker = \"dark\"\n"
                                "markers = { upper = { marker = \"bright\", start = [5, 6], region = [1, 2, 30, 40] }, lower = {} }\n");
  EXPECT_EQ(plain.video.marker_names(), (std::vector<std::string>{"upper", "lower"}));
  EXPECT_EQ(plain.video.markers[0].marker.kind, "bright");
  EXPECT_EQ(plain.video.markers[0].start->column, 5.0);
  EXPECT_EQ(plain.video.markers[0].region, (std::array<double, 4>{1.0, 2.0, 30.0, 40.0}));
  EXPECT_EQ(plain.video.markers[1].marker.kind, "dark") << "that of [video]";
  EXPECT_TRUE(plain.video.check_fields);
  EXPECT_EQ(plain.camera.sweep_marker.kind, "dark") << "that of [video]";
}

TEST_F(EveryKey, OfAPlaneInAFilmIsRead) {
  const std::string film = "[[experiment]]\nvideo = \"flight.mkv\"\n[camera]\nsweep = \"static_sweep.csv\"\n[video]\n";
  const VideoStudy board = read_with(film + "chessboard = { columns = 8, rows = 6, square = \"30 mm\" }\n").video;
  EXPECT_EQ(board.chessboard->columns, 8);
  EXPECT_EQ(board.chessboard->rows, 6);
  EXPECT_DOUBLE_EQ(board.chessboard->square, 0.03);
  EXPECT_TRUE(board.has_plane());
  const VideoStudy tag = read_with(film + R"(marker = "aruco"
id = 7
aruco = { dictionary = "5x5", plane = 3, side = "5 cm" }
markers = { left = {}, right = { id = 8 } }
)")
                             .video;
  EXPECT_EQ(tag.markers[0].marker.id, 7) << "that of [video]";
  EXPECT_EQ(tag.markers[1].marker.id, 8);
  EXPECT_EQ(tag.aruco.dictionary, "5x5");
  EXPECT_EQ(tag.aruco.plane, 3);
  EXPECT_DOUBLE_EQ(tag.aruco.side.value_or(0.0), 0.05);
  const VideoStudy points = read_with(film + R"([video.points]
a = { pixel = [10, 200], place = [0, 0] }
b = { pixel = [300, 210], place = ["50 cm", 0] }
c = { pixel = [290, 20], place = [0.5, "300 mm"] }
d = { tag = 4, place = [0, 0.3] }
)")
                                .video;
  ASSERT_EQ(points.points.size(), 4U);
  EXPECT_EQ(points.points[1].at->column, 300.0);
  EXPECT_DOUBLE_EQ(points.points[2].y, 0.3);
  EXPECT_EQ(points.points[3].tag, 4);
  EXPECT_FALSE(points.points[3].at);
}

TEST_F(EveryKey, OfAPlaneInAFilmIsRefusedInWords) {
  const auto refused = [&](const std::string& video) {
    return error_with("[[experiment]]\nvideo = \"flight.mkv\"\n[camera]\nsweep = \"static_sweep.csv\"\n[video]\n" + video);
  };
  EXPECT_THAT(refused("chessboard = { columns = 8, rows = 6 }\n"), HasSubstr("square = \"30 mm\""));
  EXPECT_THAT(refused("chessboard = { columns = 8, rows = 6, square = \"30 mm\", squares = 4 }\n"), HasSubstr("squares"));
  EXPECT_THAT(refused("chessboard = { columns = 8, rows = 2, square = \"30 mm\" }\n"), HasSubstr("rows"));
  const std::string board = "chessboard = { columns = 8, rows = 6, square = \"30 mm\" }\n";
  EXPECT_THAT(refused(board + "aruco = { plane = 3, side = \"5 cm\" }\n"), HasSubstr("one of length, chessboard, points and aruco.plane"));
  EXPECT_THAT(refused("aruco = { plane = 3 }\n"), HasSubstr("side"));
  EXPECT_THAT(refused("aruco = { dictionary = \"4x5\" }\n"), HasSubstr("4x4"));
  EXPECT_THAT(refused("marker = \"aruco\"\n"), HasSubstr("id = 7"));
  EXPECT_THAT(refused("marker = \"ring\"\nid = 7\n"), HasSubstr("only marker = \"aruco\""));
  EXPECT_THAT(refused("marker = \"aruco\"\nid = 7\nfields = \"top_first\"\n"), HasSubstr("whole frames"));
  EXPECT_THAT(refused("[video.points]\na = { pixel = [1, 2], place = [0, 0] }\n"), HasSubstr("four points"));
  EXPECT_THAT(refused("[video.points]\na = { place = [0, 0] }\n"), HasSubstr("either pixel"));
  std::string line = "[video.points]\n";
  for (const char* k : {"1", "2", "3", "5"})
    line += std::string("p") + k + " = { pixel = [" + k + "0, " + k + "5], place = [" + k + ", 2" + k + "] }\n";
  EXPECT_THAT(refused(line), HasSubstr("on one line"));
}

TEST_F(EveryKey, OfForceLimitsAndResamplingIsRead) {
  const Study study = read_with(R"([force]
correlation_time = "20 ms"
strength = { value = 3, sigma = 1 }
[fit]
time_limit = "2 min"
[discover]
time_limit = 90
[camera]
sweep = "static_sweep.csv"
[uncertainty]
bootstrap = 20
block = 64
camera = "calibration"
recalibrate = true
perturb = { R1 = "1 in" }
)");
  EXPECT_DOUBLE_EQ(study.force_time.value_or(0.0), 0.02);
  EXPECT_EQ(study.force_strength->value, 3.0);
  EXPECT_EQ(study.force_strength->sigma, 1.0);
  EXPECT_EQ(study.fit_time_limit, 120.0);
  EXPECT_EQ(study.discover_time_limit, 90.0);
  EXPECT_EQ(study.uncertainty->bootstrap, 20);
  EXPECT_EQ(study.uncertainty->block, 64);
  EXPECT_TRUE(study.uncertainty->recalibrate);
  EXPECT_FALSE(read_with("[uncertainty]\nbootstrap = 20\n").uncertainty->recalibrate);
}

TEST_F(EveryKey, OfTheHoldOfInputsIsReadWhereTheSystemIsAFile) {
  const Study study = read("[system]\nfile = \"model.toml\"\nhold = { u = \"zero_order\", wind = \"band_limited\" }\n");
  EXPECT_EQ(study.system_hold.size(), 2U);
  EXPECT_EQ(study.system_hold.at("u").hold, "zero_order");
  EXPECT_EQ(study.system_hold.at("wind").hold, "band_limited");
  EXPECT_THAT(error_of("[system]\nfile = \"model.toml\"\nhold = { u = \"zero\" }\n"),
              testing::AllOf(HasSubstr("study.toml:3"), HasSubstr("zero_order")));
  EXPECT_THAT(error_of("[system]\nkind = \"duffing\"\nhold = { u = \"zero_order\" }\n"), HasSubstr("inputs of a declared system (file)"));
}

/// "fit" of "fit", "curves" of "curves.NAME".
std::string section_of(const config::KeyGroup& group) { return group.path.substr(0, group.path.find('.')); }

/// A test that writes neither the table nor `key =` does not try the key.
TEST(KeysOfTheReference, AreEachWrittenInATest) {
  std::vector<std::string> tests;
  for (const auto& entry : fs::recursive_directory_iterator(paths::source() / "tests")) {
    const std::string end = entry.path().extension().string();
    if (end == ".cpp" || end == ".h") tests.push_back(read_file(entry.path()));
  }
  std::vector<std::string> untried;
  for (const config::KeyGroup& group : study_keys()) {
    for (const config::Key& key : group.keys) {
      if (key.any) continue;
      const std::string named = group.path == "geometry" ? "|\"" + key.name + "\"" : "";  // those of the rig are tried in a loop
      const std::regex written("(^|[^A-Za-z_0-9]|\\\\n)" + key.name + " *=[^=]" + named);
      const bool tried = std::any_of(tests.begin(), tests.end(), [&](const std::string& text) {
        return text.find("[" + section_of(group)) != std::string::npos && std::regex_search(text, written);
      });
      if (!tried) untried.push_back(group.path + " " + key.name);
    }
  }
  EXPECT_THAT(untried, testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
