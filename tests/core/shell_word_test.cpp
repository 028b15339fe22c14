#include "misfit/core/shell_word.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(ShellWord, IsQuotedWhereAShellWouldSplitOrReadIt) {
  EXPECT_EQ(shell_word("configs/dc_motor"), "configs/dc_motor");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("two words"), "'two words'");
  EXPECT_EQ(shell_word("$HOME"), "'$HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace misfit
