#include "misfit/core/version.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <string>

#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

TEST(Version, IsThatOfTheProject) {
  const std::string project = read_file(paths::source() / "CMakeLists.txt");
  EXPECT_NE(project.find(std::string("project(misfit VERSION ") + version() + " "), std::string::npos) << version();
}

TEST(Commit, IsAShortHashOrUnknown) { EXPECT_TRUE(std::regex_match(commit(), std::regex("unknown|[0-9a-f]{7,40}\\+?"))) << commit(); }

/// Runs the script that makes the header, for a source folder of our own.
class CommitScript : public ::testing::Test {
 protected:
  void run(const std::string& command) const {
    ASSERT_EQ(std::system(("cd '" + source() + "' && (" + command + ") >/dev/null 2>&1").c_str()), 0) << command;
  }
  std::string header() const {
    run("cmake -DSOURCE='" + source() + "' -DOUTPUT='" + output() + "' -DVERSION=1.2.3 -P '" + paths::source().string() +
        "/lib/misfit/core/commit.cmake'");
    return read_file(output());
  }
  void commit_a_file() const {
    run("git init && echo a > a && git add a");
    run("git -c user.name=n -c user.email=e@x -c commit.gpgsign=false commit -m m");
  }
  std::string source() const { return folder_.path().string(); }
  std::string output() const { return source() + "/commit.h"; }
  TemporaryFolder folder_;
};

TEST_F(CommitScript, OutsideGitTheCommitIsUnknown) {
  EXPECT_EQ(header(), "#define MISFIT_VERSION \"1.2.3\"\n#define MISFIT_COMMIT \"unknown\"\n");
}

TEST_F(CommitScript, AChangedTreeIsMarked) {
  if (std::system("git --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no git";
  commit_a_file();
  EXPECT_TRUE(std::regex_search(header(), std::regex("MISFIT_COMMIT \"[0-9a-f]{7,40}\"\n")));
  folder_.write("a", "changed");
  EXPECT_TRUE(std::regex_search(header(), std::regex("MISFIT_COMMIT \"[0-9a-f]{7,40}\\+\"\n")));
}

TEST_F(CommitScript, AnUnchangedHeaderIsNotTouched) {
  header();
  const auto before = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(output(), before);
  const auto stored = fs::last_write_time(output());
  header();
  EXPECT_EQ(fs::last_write_time(output()), stored);
}

}  // namespace
}  // namespace misfit
