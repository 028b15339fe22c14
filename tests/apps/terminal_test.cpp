// What standard output is decides how wide and in which colours is printed.
#include "apps/terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace misfit {
namespace {

/// Stands a terminal of this width behind standard output for its lifetime.
class WindowOnOutput {
 public:
  explicit WindowOnOutput(unsigned short columns) : master_(::posix_openpt(O_RDWR | O_NOCTTY)), saved_(::dup(STDOUT_FILENO)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    const int slave = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
    if (slave < 0) return;
    const winsize size{24, columns, 0, 0};
    works_ = ::ioctl(slave, TIOCSWINSZ, &size) == 0;
    ::dup2(slave, STDOUT_FILENO);
    ::close(slave);
  }
  ~WindowOnOutput() {
    ::dup2(saved_, STDOUT_FILENO);
    ::close(saved_);
    if (master_ >= 0) ::close(master_);
  }
  WindowOnOutput(const WindowOnOutput&) = delete;
  WindowOnOutput& operator=(const WindowOnOutput&) = delete;
  [[nodiscard]] bool works() const { return works_; }

 private:
  int master_, saved_;
  bool works_ = false;
};

TextStyle style_in(unsigned short columns) {
  const WindowOnOutput window(columns);
  return window.works() ? terminal_style() : TextStyle{0, 0, false};
}

class TerminalStyle : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("TERM", "xterm", 1);
    ::unsetenv("NO_COLOR");
    if (style_in(80).width == 0) GTEST_SKIP() << "no pseudo-terminal";
  }
  void TearDown() override { ::unsetenv("NO_COLOR"); }
};

TEST_F(TerminalStyle, KeepsToTheWindowAndLinesToWhatCanBeRead) {
  EXPECT_EQ(style_in(80).width, 79U);
  EXPECT_EQ(style_in(80).table, 79U);
  EXPECT_EQ(style_in(200).width, 110U);
  EXPECT_EQ(style_in(200).table, 199U);
  EXPECT_EQ(style_in(20).width, 40U) << "narrower would be one word per line";
}

TEST_F(TerminalStyle, HasColourUnlessItIsRefused) {
  EXPECT_TRUE(style_in(80).colour);
  ::setenv("NO_COLOR", "1", 1);
  EXPECT_FALSE(style_in(80).colour);
  ::setenv("NO_COLOR", "", 1);
  EXPECT_TRUE(style_in(80).colour) << "no-color.org: present and not empty";
  ::setenv("TERM", "dumb", 1);
  EXPECT_FALSE(style_in(80).colour);
}

TEST(PrintableStreamWithColours, LetsTheseSequencesPassAndNoOthers) {
  std::ostringstream text;
  {
    PrintableStream stream(text);
    text << "\033[1mname\033[0m";
    stream.allow_colours();
    text << "\033[1mname\033[0m \033[2J\033[31m\033";
  }
  EXPECT_EQ(text.str(), "\\x1b[1mname\\x1b[0m\033[1mname\033[0m \\x1b[2J\\x1b[31m\\x1b");
}

}  // namespace
}  // namespace misfit
