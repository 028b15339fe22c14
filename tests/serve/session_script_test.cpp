#include "misfit/serve/session_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "tests/core/temporary_folder.h"

namespace misfit::serve {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(TheScriptOfASession, HasCommandsAndTextsInTheirOrder) {
  const TemporaryFolder folder;
  const SessionScript script(folder.path());
  EXPECT_EQ(script.text(), "");
  script.record(command_of({"add", "my study", "it's", "--out", "o"}));
  script.record_text(script.open(), "my study/study.toml", "a = 'END_OF_STUDY'");
  EXPECT_THAT(script.text(), HasSubstr("set -e\n"));
  EXPECT_THAT(script.text(), HasSubstr("\nmisfit add 'my study' 'it'\\''s' --out o\n"
                                       "cat > 'my study/study.toml' <<'END_OF_STUDY_'\na = 'END_OF_STUDY'\nEND_OF_STUDY_\n"));
}

TEST(TheScriptOfASession, GoesToTheFolderInWhichEachCommandWasTyped) {
  const TemporaryFolder folder, other;
  const std::filesystem::path before = std::filesystem::current_path();
  const SessionScript script(folder.path());
  script.record("misfit fit s");
  script.record("misfit run s");
  std::filesystem::current_path(other.path());
  const SessionScript next(folder.path());
  next.record("misfit fit ../s");
  next.record("misfit run ../s");
  std::filesystem::current_path(before);
  EXPECT_THAT(script.text(), EndsWith("set -e\ncd -- " + before.string() + "\nmisfit fit s\nmisfit run s\ncd -- " + other.path().string() +
                                      "\nmisfit fit ../s\nmisfit run ../s\n"));
}

TEST(TheScriptOfASession, DoesNotDoAgainWhatWasStoppedOrRefusedAndGoesOnAfterAMethodThatDeclined) {
  const TemporaryFolder folder;
  const SessionScript script(folder.path());
  script.record("misfit add s drag");
  script.record("misfit add s drag");
  script.record_end("misfit add s drag", 1, true);
  script.record("misfit set s 'a.b=1'");
  script.record_end("misfit set s 'a.b=1'", 2, false);
  script.record("misfit fit s");
  script.record_end("misfit fit s", 1, false);
  script.record_end("misfit run s", 1, false);  // never recorded
  EXPECT_THAT(script.text(), EndsWith("\nmisfit add s drag\n# stopped: misfit add s drag\n# ended with status 2: misfit set s 'a.b=1'\n"
                                      "misfit fit s || [ $? -eq 1 ]\n"));
}

TEST(TheScriptOfASession, IsWrittenByServersOfOneFolderInTurn) {
  const TemporaryFolder folder;
  constexpr int commands = 200;
  const auto write = [&](const std::string& name) {
    const SessionScript script(folder.path());
    for (int k = 0; k < commands; ++k) {
      const std::string command = "misfit fit " + name + std::to_string(k);
      script.record(command);
      script.record_end(command, 2, false);
    }
  };
  std::thread one(write, "a"), other(write, "b");
  one.join();
  other.join();
  const std::string text = SessionScript(folder.path()).text();
  for (const std::string name : {"a", "b"}) {
    for (int k = 0; k < commands; ++k) EXPECT_THAT(text, HasSubstr("# ended with status 2: misfit fit " + name + std::to_string(k) + "\n"));
  }
}

}  // namespace
}  // namespace misfit::serve
