// A program that ends in the middle, by SIGKILL or on a full disk, leaves nothing torn; the same command then comes to the same results as
// one that was never disturbed. MISFIT_SUDDEN_ENDS says how often each (default 1: ./dev check asks for 20).

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "tests/apps/oscillator_study.h"

namespace {

using namespace program;
using testing::IsEmpty;

int times_asked() {
  const char* asked = std::getenv("MISFIT_SUDDEN_ENDS");
  return asked == nullptr ? 1 : std::atoi(asked);
}

class SuddenEnd : public testing::TestWithParam<std::string> {
 protected:
  SuddenEnd() {
    const Outcome whole = program::run(study_.command(GetParam(), out("whole")));
    EXPECT_EQ(whole.status, 0) << whole.err;
    seconds_ = whole.seconds;
    whole_ = results_in(out("whole"));
    EXPECT_GT(whole_.size(), 3U);
  }
  [[nodiscard]] fs::path out(const std::string& name) const { return study_.path(name); }

  const OscillatorStudy study_;
  double seconds_ = 0.0;
  std::map<std::string, std::string> whole_;
};

TEST_P(SuddenEnd, ByAKillAtAnyMomentIsGoneOnFrom) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> moment(0.02, 1.0);
  for (int k = 0; k < times_asked(); ++k) {
    const fs::path folder = out("killed_" + std::to_string(k));
    const TemporaryFolder captured;
    const pid_t child = start(captured.path(), study_.command(GetParam(), folder));
    const double seconds = moment(random) * seconds_;
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    ::kill(child, SIGKILL);
    (void)finish(captured.path(), child);
    const Outcome again = program::run(study_.command(GetParam(), folder));
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(differences(whole_, results_in(folder)), IsEmpty()) << "killed after " << seconds << " s";
  }
}

/// In a child with its own small disk: too small first, then large enough. 0: right; 77: no disk can be mounted here.
int on_a_small_disk(const fs::path& folder, const std::vector<std::string>& command, int kilobytes,
                    const std::map<std::string, std::string>& whole) {
  const auto options = [](int size) { return "size=" + std::to_string(size) + "k"; };
  if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
  (void)::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  if (::mount("tmpfs", folder.c_str(), "tmpfs", 0, options(kilobytes).c_str()) != 0) return 77;
  const Outcome full = program::run(command);
  if (full.status != 0) {
    if (full.status != 1 || full.err.find("No space left on device") == std::string::npos ||
        full.err.find(folder.string()) == std::string::npos) {
      std::printf("with %d kB: status %d, %s\n", kilobytes, full.status, full.err.c_str());
      return 1;
    }
    for (const auto& [name, text] : results_in(folder)) {
      if (const auto there = whole.find(name); there != whole.end() && name != "report.html" && there->second != text &&
                                               name.find("studies/") == std::string::npos && name.find("ladder") == std::string::npos) {
        std::printf("with %d kB: %s is torn\n", kilobytes, name.c_str());
        return 1;
      }
    }
  }
  constexpr int enough = 65536;
  if (::mount("tmpfs", folder.c_str(), "tmpfs", MS_REMOUNT, options(enough).c_str()) != 0) return 77;
  const Outcome again = program::run(command);
  const std::vector<std::string> others = differences(whole, results_in(folder));
  if (again.status == 0 && others.empty()) return 0;
  std::printf("after %d kB: status %d, %s, other: %s\n", kilobytes, again.status, again.err.c_str(),
              others.empty() ? "" : others.front().c_str());
  return 1;
}

TEST_P(SuddenEnd, OnAFullDiskNamesTheFileAndIsGoneOnFrom) {
  std::uintmax_t all = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out("whole"))) all += entry.is_regular_file() ? entry.file_size() : 0;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.02, 0.9);
  for (int k = 0; k < times_asked(); ++k) {
    const fs::path folder = out("full_" + std::to_string(k));
    fs::create_directory(folder);
    const int kilobytes = static_cast<int>(share(random) * static_cast<double>(all) / 1024.0) + 8;
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
      const int result = on_a_small_disk(folder, study_.command(GetParam(), folder), kilobytes, whole_);
      std::fflush(stdout);
      ::_exit(result);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no small file system can be mounted here";
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << kilobytes << " kB";
  }
}

INSTANTIATE_TEST_SUITE_P(OfVerb, SuddenEnd, testing::Values("run", "discover", "batch", "uncertainty"),
                         [](const auto& entry) { return entry.param; });

}  // namespace
