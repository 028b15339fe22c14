// misfit open as somebody uses it: browser_test.py in Debian's chromium, on a study of two seconds and on the swivel that rubs.
#include "tests/apps/oscillator_study.h"
#include "tests/paths.h"

namespace {

using namespace program;

class InABrowser : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* needed : {"/usr/bin/chromium", "/usr/bin/chromedriver", "/usr/bin/python3"}) {
      if (!fs::exists(needed)) GTEST_SKIP() << needed << " is not installed (packages.txt)";
    }
    if (std::system("/usr/bin/python3 -c 'import selenium' 2> /dev/null") != 0)
      GTEST_SKIP() << "python3-selenium is not installed (packages.txt)";
    const char* blank =
        "timeout 60 /usr/bin/chromium --headless=new --no-sandbox --disable-dev-shm-usage --disable-gpu --dump-dom about:blank";
    if (std::system((std::string(blank) + " > /dev/null 2>&1").c_str()) != 0)
      GTEST_SKIP() << "chromium cannot show an empty page on this machine: " << blank;
  }

  static void expect_good(const fs::path& folder, const std::string& scenario) {
    const std::string script = paths::source() / "tests/serve/browser_test.py";
    const fs::path said = folder / "browser.log";
    const std::string command = "/usr/bin/python3 '" + script + "' '" + paths::program().string() + "' '" + folder.string() + "' " +
                                scenario + " > '" + said.string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << content(said);
  }
};

TEST_F(InABrowser, WhereItFailsIsFoundAndTheEffectAddedOnTheSwivelThatRubs) {
  const StudyCopy study("swivel_friction");
  constexpr std::size_t samples = 2380;  // of the flight, 40 s
  study.change_rows("track.csv",
                    [](std::size_t row, const auto& cells) { return row > samples ? "" : cells[0] + "," + cells[1] + "," + cells[2]; });
  expect_good(study.path(""), "find_and_add");
}

TEST_F(InABrowser, TheFrameAtTheCursorHasTheMarkerWhereItIs) {
  const StudyCopy study("film_pendulum");
  expect_good(study.path(""), "film");
}

TEST_F(InABrowser, AStudyWithAnErrorIsMended) {
  const OscillatorStudy study;
  expect_good(study.path(""), "mend");
}

TEST_F(InABrowser, AParameterIsFixedAndAMarkedTimeHeldOut) {
  const OscillatorStudy study;
  expect_good(study.path(""), "settings");
}

TEST_F(InABrowser, TwoPagesShowTheSameAndLeaveEachOtherWhatIsInHand) {
  const OscillatorStudy study;
  expect_good(study.path(""), "two_pages");
}

TEST_F(InABrowser, ACommandIsStoppedAndAKilledServerOpenedAgain) {
  const OscillatorStudy study;
  expect_good(study.path(""), "stop_and_kill");
}

TEST_F(InABrowser, NamesThatAreScriptsStayNames) {
  const OscillatorStudy study;
  expect_good(study.path(""), "hostile");
}

}  // namespace
