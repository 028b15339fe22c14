#include "misfit/serve/session_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/temporary_folder.h"

namespace misfit::serve {
namespace {

using testing::HasSubstr;

TEST(TheScriptOfASession, HasCommandsAndTextsInTheirOrder) {
  const TemporaryFolder folder;
  const SessionScript script(folder.path());
  EXPECT_EQ(script.text(), "");
  script.record(command_of({"add", "my study", "it's", "--out", "o"}));
  script.record_text("my study/study.toml", "a = 'END_OF_STUDY'");
  EXPECT_THAT(script.text(), HasSubstr("set -e\n"));
  EXPECT_THAT(script.text(), HasSubstr("\nmisfit add 'my study' 'it'\\''s' --out o\n"
                                       "cat > 'my study/study.toml' <<'END_OF_STUDY_'\na = 'END_OF_STUDY'\nEND_OF_STUDY_\n"));
}

}  // namespace
}  // namespace misfit::serve
