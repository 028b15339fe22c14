// What gnuplot draws depends on the script alone, and what fails is said.
#include "misfit/report/gnuplot_run.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/report/figure.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

namespace fs = std::filesystem;

Figure line() {
  Figure figure;
  figure.name = "line";
  figure.x_label = "x";
  figure.x_unit = "s";
  Series s{"y", "y", Style::line, palette(0), {1.0, 2.0, 3.0}, {1.0, 10.0, 100.0}, {}, {}};
  figure.panels = {{"y", "-", {s}, std::nullopt, 0.0, 200.0, false}};
  return figure;
}

std::string drawn(const fs::path& folder) { return read_file(write_figure(folder, line())); }

/// A variable of the environment for the time of a test.
class Environment {
 public:
  Environment(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* before = std::getenv(name_.c_str())) before_ = before;
    ::setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_.c_str(), before_->c_str(), 1);
    } else {
      ::unsetenv(name_.c_str());
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

class UsersSetting : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(UsersSetting, ChangesNoDrawing) {
  const TemporaryFolder plain, other;
  const std::string expected = drawn(plain.path());
  const Environment set(GetParam().first, GetParam().second);
  EXPECT_EQ(drawn(other.path()), expected);
}

INSTANTIATE_TEST_SUITE_P(Each, UsersSetting,
                         testing::Values(std::pair{"GNUTERM", "dumb"}, std::pair{"LC_ALL", "de_DE.UTF-8"}, std::pair{"LC_NUMERIC", "de_DE"},
                                         std::pair{"GNUPLOT_LIB", "/nowhere"}, std::pair{"GNUPLOT_DRIVER_DIR", "/nowhere"},
                                         std::pair{"HOME", ""}, std::pair{"GDFONTPATH", "/nowhere"}, std::pair{"FIT_LOG", "/nowhere/x"}),
                         [](const auto& i) { return std::string(i.param.first); });

TEST(UsersGnuplotFile, ChangesNoDrawingWhereverItIs) {
  const TemporaryFolder plain, other, home;
  const std::string expected = drawn(plain.path());
  const std::string own = "set logscale y\nsystem('touch " + (home.path() / "run").string() + "')\n";
  home.write(".gnuplot", own);
  other.write(".gnuplot", own);
  const Environment set("HOME", home.path().string());
  EXPECT_EQ(drawn(other.path()), expected);
  EXPECT_FALSE(fs::exists(home.path() / "run"));
}

class FolderCalled : public testing::TestWithParam<const char*> {};

TEST_P(FolderCalled, IsDrawnInto) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  EXPECT_NE(drawn(GetParam()).find("</svg>"), std::string::npos);
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(folder.path() / GetParam() / "line.svg"));
  EXPECT_FALSE(fs::exists(folder.path() / "pwned"));
}

INSTANTIATE_TEST_SUITE_P(EachWay, FolderCalled,
                         testing::Values("-x", "--", "a b", "a'b", "a\"b", "$(touch pwned)", "`touch pwned`", "a;touch pwned", "a\nb",
                                         "\xff", "试验", "~", "*", "a\\"),
                         [](const auto& i) { return std::to_string(i.index); });

TEST(GnuplotLeaves, TheFilesOfTheFigureOnly) {
  const TemporaryFolder folder;
  static_cast<void>(drawn(folder.path()));
  EXPECT_EQ(folder.entries(), 3U);
  folder.write("bad.gp", "plot nonsense from here\n");
  expect_parts(message_of<RunError>([&] {
                 run_gnuplot(folder.path(), {{"bad", {"A title", "What it shows"}}});
               }),
               {"gnuplot failed", "bad.gp", "nonsense"});
  EXPECT_EQ(folder.entries(), 4U);
}

TEST(GnuplotLeaves, ADrawingThatEndsTooSoonOut) {
  const TemporaryFolder folder;
  folder.write("half.svg", "the old drawing");
  folder.write("half.gp", "set terminal svg\nset output out\nplot sin(x)\nset output\nexit\n");
  expect_parts(message_of<RunError>([&] {
                 run_gnuplot(folder.path(), {{"half", {"A title", "What it shows"}}});
               }),
               {"gnuplot failed", "half.gp", "it says nothing"});
  EXPECT_EQ(read_file(folder.path() / "half.svg"), "the old drawing");
}

TEST(GnuplotDrawing, ThatCannotBeWrittenIsToldFromOneThatCannotBeDrawn) {
  const TemporaryFolder folder;
  static_cast<void>(drawn(folder.path()));
  fs::remove(folder.path() / "line.svg");
  fs::create_directory(folder.path() / "line.svg");
  const std::string message = message_of<RunError>([&] { run_gnuplot(folder.path(), {{"line", {"A title", "What it shows"}}}); });
  expect_parts(message, {"line.svg", "cannot be written"});
  EXPECT_EQ(message.find("gnuplot failed"), std::string::npos);
}

/// Settings, variables, functions and panels of one script reach no other, whatever it ends with; options of its terminal do.
TEST(FiguresTogether, AreDrawnAsEachAlone) {
  const TemporaryFolder alone, together;
  const std::string expected = drawn(alone.path());
  const DrawingWords words{"A title", "What it shows"};
  const std::string plain = "set terminal svg background 'white'\nset output out\nplot sin(x)\nset output\ndrawn = 1\n";
  alone.write("plain.gp", plain);
  together.write("plain.gp", plain);
  together.write("first.gp",
                 "set terminal svg size 90, 90 dynamic\nset output out\nf(x) = 3\nx = 5\nset logscale y\nset linetype 1 lc rgb 'red'\n"
                 "set datafile separator ';'\nset multiplot layout 2, 1\nplot [1:2] x\nplot [1:2] x\ndrawn = 1\n");
  static_cast<void>(drawn(together.path()));
  const std::vector<std::string> drawings =
      run_gnuplot(together.path(), {{"first", words}, {"plain", words}, {"line", words}, {"plain", words}});
  ASSERT_EQ(drawings.size(), 4U);
  EXPECT_EQ(drawings[1], run_gnuplot(alone.path(), {{"plain", words}}).front());
  EXPECT_EQ(drawings[2], run_gnuplot(alone.path(), {{"line", words}}).front());
  EXPECT_EQ(drawings[3], drawings[1]);
  EXPECT_EQ(read_file(together.path() / "line.svg"), drawings[2]);
}

TEST(FiguresTogether, AreDrawnUpToTheOneThatFails) {
  const TemporaryFolder folder;
  static_cast<void>(drawn(folder.path()));
  fs::remove(folder.path() / "line.svg");
  folder.write("bad.gp", "set terminal svg\nset output out\nset multiplot\nplot nonsense from here\ndrawn = 1\n");
  const DrawingWords words{"A title", "What it shows"};
  const std::string message = message_of<RunError>([&] { run_gnuplot(folder.path(), {{"line", words}, {"bad", words}}); });
  expect_parts(message, {"gnuplot failed", "bad.gp", "nonsense"});
  EXPECT_TRUE(fs::exists(folder.path() / "line.svg"));
}

TEST(FigureNames, AreMadeUnlikeEachOther) {
  std::vector<Figure> figures(4);
  figures[0].name = figures[1].name = figures[3].name = "a";
  figures[2].name = "a.2";
  make_names_unique(figures);
  EXPECT_EQ(figures[1].name, "a.2");
  EXPECT_EQ(figures[2].name, "a.2.2");
  EXPECT_EQ(figures[3].name, "a.3");
}

}  // namespace
}  // namespace misfit::report
