// Studies that start from a video, or whose camera is calibrated from pictures.
#include <gmock/gmock.h>

#include "misfit/video/canvas.h"
#include "tests/apps/program.h"
#include "tests/paths.h"
#include "tests/workflow/film.h"

namespace {

using namespace film;
using program::content;
using program::Outcome;
using program::StudyCopy;
using testing::AllOf;
using testing::HasSubstr;

/// mpf_f111 on the first 3 s of its video.
class ShortStudy : public StudyCopy {
 public:
  ShortStudy() : StudyCopy("mpf_f111") {
    fs::copy_file(paths::source() / "tests/apps/data/gaps.mkv", path("gaps.mkv"));
    change("flight.mkv", "gaps.mkv");
  }
};

TEST(TrackVerb, WritesTrackFactsAndContactSheetAndSkipsThemTheNextTime) {
  const ShortStudy study;
  const Outcome outcome = study.run("track");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("86 frames decoded of 90 declared"), HasSubstr("top_first"), HasSubstr("missing between others")));
  EXPECT_EQ(program::first_line(study.out("track.csv")), "t[s],P_y[px],P_z[px],sigma[px],ok");
  const auto facts = study.result("track.json");
  EXPECT_EQ(facts.at("samples"), 180);
  EXPECT_EQ(facts.at("fields").at("used"), "top_first");
  EXPECT_EQ(facts.at("lost").at("no frame in the file"), 8);
  EXPECT_TRUE(content(study.out("figures/contact_sheet.png")).starts_with("\x89PNG"));
  const auto before = fs::last_write_time(study.out("track.csv"));
  const Outcome again = study.run("track", {"--json"});
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(program::json::parse(again.out).at("ok"), facts.at("ok"));
  EXPECT_EQ(fs::last_write_time(study.out("track.csv")), before);
}

TEST(TrackVerb, CheckVideoShowsEverySample) {
  const ShortStudy study;
  const Outcome outcome = study.run("track", {"--check-video", study.path("check.avi").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  Video video(study.path("check.avi"));
  while (video.next()) {
  }
  EXPECT_EQ(video.facts().decoded, 172);  // two fields of each of the 86 frames
  EXPECT_NEAR(video.facts().rate, 59.94, 0.01);
}

TEST(RunOnAVideo, GoesFromFramesToReportAndItsResolvedStudyDoesToo) {
  const ShortStudy study;
  study.change("methods = [^\n]*", "methods = [\"sliding_bin\"]");
  const Outcome outcome = study.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  const std::string page = content(study.out("report.html"));
  EXPECT_THAT(page, AllOf(HasSubstr("data:image/png;base64,"), HasSubstr("no frame in the file"), HasSubstr("missing between others")));
  for (const char* file : {"track.csv", "attitude.csv", "figures/track_flight.svg", "figures/contact_sheet.png"})
    EXPECT_TRUE(fs::exists(study.out(file))) << file;
  const Outcome again = study.run();
  EXPECT_EQ(again.out, outcome.out);
  EXPECT_TRUE(fs::exists(study.out("figures/contact_sheet.png")));
  const Outcome resolved = program::run({"run", study.out("resolved.toml").string()});
  EXPECT_EQ(resolved.status, 0) << resolved.err << content(study.out("resolved.toml"));
  EXPECT_EQ(content(study.out("out/track.csv")), content(study.out("track.csv")));
}

TEST(RunOnAVideo, CurvesAgreeWithThoseOfTheTrackWithinTheirBands) {
  const StudyCopy from_video("mpf_f111"), from_track("mpf_f111");
  from_track.start_from_track();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(from_video.run("track").status, 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("misfit track of 79.4 s: %.1f s, %.1f times real time\n", seconds, 79.4 / seconds);
  for (const StudyCopy* study : {&from_video, &from_track}) {
    study->change("methods = [^\n]*", "methods = [\"sliding_bin\", \"equation_error\"]");
    ASSERT_EQ(study->run().status, 0);
  }
  for (const char* method : {"sliding_bin", "equation_error"}) {
    const std::string file = std::string("fit/") + method + "/curves.csv";
    const auto a = program::curve_points(from_video.out(file), "C_m"), b = program::curve_points(from_track.out(file), "C_m");
    ASSERT_GT(a.size(), 50U);
    double worst = 0.0, squares = 0.0, count = 0.0;
    for (const auto& p : a) {
      const auto q = std::lower_bound(b.begin(), b.end(), p.x, [](const auto& c, double x) { return c.x < x; });
      if (q == b.begin() || q == b.end() || !(p.count > 0.0) || !(q->count > 0.0) || !((q - 1)->count > 0.0)) continue;
      const double f = (p.x - (q - 1)->x) / (q->x - (q - 1)->x);
      const double value = (1.0 - f) * (q - 1)->value + f * q->value;
      const double sigmas = (p.value - value) / std::hypot(p.sigma, q->sigma);
      worst = std::max(worst, std::abs(sigmas));
      squares += sigmas * sigmas;
      count += 1.0;
    }
    std::printf("%s: C_m from video and from track differ by %.2f sigma RMS, %.2f at most, over %.0f angles\n", method,
                std::sqrt(squares / count), worst, count);
    ASSERT_GT(count, 30.0);
    EXPECT_LT(worst, 2.0);
  }
}

TEST(ARungOfAVideoStudy, TakesTheTrackOfTheStudyBelowInsteadOfReadingTheVideoAgain) {
  const ShortStudy study;
  study.change("methods = [^\n]*", "methods = [\"filter_error\"]");
  ASSERT_EQ(study.run("track").status, 0);
  const Outcome outcome = program::run({"add", study.path("study.toml").string(), "system:parachute_spherical"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string rung = "rungs/01_parachute_spherical/out/";
  EXPECT_EQ(content(study.out(rung + "track.csv")), content(study.out("track.csv")));
  const auto stage = study.result(rung + "run.json").at("stages").at("track/flight");
  EXPECT_THAT(stage.at("command").get<std::string>(), AllOf(HasSubstr("copied from"), HasSubstr("track.csv ")));
  EXPECT_EQ(stage.at("inputs").at("../../../gaps.mkv"),
            study.result("run.json").at("stages").at("track/flight").at("inputs").at("gaps.mkv"));
  const auto before = fs::last_write_time(study.out(rung + "track.csv"));
  EXPECT_EQ(program::run({"track", study.out("rungs/01_parachute_spherical").string()}).status, 0);
  EXPECT_EQ(fs::last_write_time(study.out(rung + "track.csv")), before) << "the rung itself has no reason to read the video";
}

void expect_refused(const StudyCopy& study, int status, const std::vector<std::string>& parts) {
  const Outcome outcome = study.run("track");
  EXPECT_EQ(outcome.status, status) << outcome.out;
  for (const auto& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
}

TEST(VideosThatCannotBeTracked, AreAnsweredInWords) {
  const StudyCopy study("mpf_f111");
  const auto video = [&](const std::string& name) { study.change("video = \"[^\"]*\"", "video = \"" + name + "\""); };
  video("fligth.mkv");
  expect_refused(study, 2, {"study.toml:", "fligth.mkv", "did you mean 'flight.mkv'"});
  video("track.csv");
  expect_refused(study, 1, {"track.csv", "not a video"});
  study.write("empty.mkv", "");
  video("empty.mkv");
  expect_refused(study, 1, {"empty.mkv", "the file is empty"});
  { const Writer nothing(study.path("none.avi"), 720, 720, frame_rate); }
  video("none.avi");
  expect_refused(study, 1, {"none.avi"});
  Writer(study.path("one.mkv"), 720, 720, frame_rate).add(frames().front());
  video("one.mkv");
  expect_refused(study, 1, {"one.mkv", "one frame only"});
  {
    Writer writer(study.path("grey.mkv"), 320, 240, frame_rate);
    for (int n = 0; n < 50; ++n) writer.add(Image(320, 240, static_cast<std::uint8_t>(90 + n)));
  }
  video("grey.mkv");
  expect_refused(study, 1, {"grey.mkv", "found in none of the", "marker"});
}

TEST(TruncatedVideo, IsTrackedAsFarAsItGoesAndSaid) {
  const StudyCopy study("mpf_f111");
  const std::string bytes = content(study.path("flight.mkv"));
  study.write("cut.mkv", bytes.substr(0, 600'000));
  study.change("flight.mkv", "cut.mkv");
  const Outcome outcome = study.run("track");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("truncated or damaged"), HasSubstr("declares 2380 frames")));
}

TEST(WrongVideoSection, IsRefusedWithThePlace) {
  for (const auto& [change, part] : {std::pair{"start = [1]", "[column, row]"},
                                     {"region = [5, 5, 1, 1]", "left must be below right"},
                                     {"marker = \"rnig\"", "did you mean 'ring'"}}) {
    const StudyCopy study("mpf_f111");
    study.change("marker = \"ring\"[^\n]*", change);
    expect_refused(study, 2, {"study.toml:", part});
  }
}

/// The sweep of mpf_f111 as pictures: rings painted where a pinhole camera with h_c = 0.15 m, K = 134 px/m sees the rig's points.
void paint_sweep(const StudyCopy& study) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 4.0);
  std::string table = "theta[deg],file\n";
  for (int k = -6; k <= 6; ++k) {
    const double degrees = 3.0 * k, theta = degrees * 3.14159265358979 / 180.0;
    const double x[3] = {0.31 + 3.447 * std::cos(theta), 0.31 - 0.42 * std::cos(theta), 0.31 + 2.1 * std::cos(theta)};
    const double z[3] = {3.447 * std::sin(theta), 0.42 * std::sin(theta), -2.1 * std::sin(theta)};
    Image picture(720, 720, 110);
    for (int p = 0; p < 3; ++p) paint_ring(picture, 0, 1, {360.0, 360.0 + 5.69 * 134.0 * (z[p] + 0.15) / (5.69 - x[p])}, 14.0, 0.0);
    const std::string name = "sweep_" + std::to_string(k + 6) + ".png";
    for (std::uint8_t& grey : picture.pixels) grey = static_cast<std::uint8_t>(std::clamp(std::lround(grey + noise(random)), 0L, 255L));
    Canvas canvas(720, 720);
    canvas.paste({picture, 0, 1}, {0.0, 0.0, 720.0, 720.0}, {});
    canvas.write_png(study.path(name));
    table += std::to_string(degrees) + "," + name + "\n";
  }
  study.write("angles.csv", table);
}

TEST(CalibrateFromPictures, GivesTheCameraThatTookThem) {
  const StudyCopy study("mpf_f111");
  paint_sweep(study);
  study.change("sweep = \"static_sweep.csv\"", "sweep_images = \"angles.csv\"");
  const Outcome outcome = study.run("calibrate");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto camera = study.result("camera.json");
  std::printf("%s", outcome.out.c_str());
  EXPECT_NEAR(camera.at("h_c").at("value"), 0.15, 2e-4);
  EXPECT_NEAR(camera.at("K").at("value"), 134.0, 0.05);
  EXPECT_LT(camera.at("rms_px"), 0.1);
  EXPECT_TRUE(fs::exists(study.out("figures/sweep_sheet.png")));
  EXPECT_EQ(program::first_line(study.out("sweep.csv")), "theta[deg],P_1y[px],P_1z[px],P_2y[px],P_2z[px],P_3y[px],P_3z[px]");
}

TEST(CalibrateFromPictures, WrongTablesAreRefusedWithThePlace) {
  const StudyCopy study("mpf_f111");
  study.change("sweep = \"static_sweep.csv\"", "sweep_images = \"angles.csv\"");
  for (const auto& [table, part] : {std::pair{"theta[deg],file\n3,none.png\n", "angles.csv:2: no such file 'none.png'"},
                                    {"theta[deg],file\n3,\n", "angles.csv:2"},
                                    {"theta[deg],file,from[s],to[s]\n3,flight.mkv,2,1\n", "must be before"}}) {
    study.write("angles.csv", table);
    const Outcome outcome = study.run("calibrate");
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part));
  }
}

/// Which lasts 4.95 s; counted at the rate at which it begins, 4 s.
TEST(CalibrateFromPictures, PartsOfAVideoOfVariableRateAreFoundByItsTimes) {
  const StudyCopy study("mpf_f111");
  study.change("sweep = \"static_sweep.csv\"", "sweep_images = \"angles.csv\"");
  fs::copy_file(paths::source() / "tests/apps/data/variable_rate.mp4", study.path("sweep.mp4"));
  study.write("angles.csv", "theta[deg],file,from[s],to[s]\n0,sweep.mp4,0,1\n3,sweep.mp4,4.6,4.9\n");
  const Outcome outcome = study.run("calibrate");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("three markers"), testing::Not(HasSubstr("lies in this part"))));
}

TEST(CalibrateFromPictures, WithoutMarkersNameTheirTable) {
  const StudyCopy study("mpf_f111");
  study.change("sweep = \"static_sweep.csv\"", "sweep_images = \"angles.csv\"");
  Canvas(90, 90).write_png(study.path("black.png"));
  study.write("angles.csv", "theta[deg],file\n0,black.png\n5,black.png\n10,black.png\n");
  const Outcome outcome = study.run("calibrate");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("angles.csv (black.png"), HasSubstr("three markers")));
}

}  // namespace
