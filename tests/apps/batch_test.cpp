// Many studies as one job.

#include <sys/resource.h>

#include <algorithm>

#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;

/// Three short cuts of the validation motion, the second with a column that is not there.
class ThreeTests : public testing::Test {
 protected:
  ThreeTests() {
    const fs::path from = paths::source() / "configs" / "validation";
    std::istringstream lines(content(from / "alpha_history.csv"));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    std::string study = content(from / "study.toml");
    study = study.substr(0, study.find("[reference]"));
    study = std::regex_replace(study, std::regex("methods = .*"), "methods = [\"sliding_bin\"]");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = "test" + std::to_string(k + 1);
      fs::create_directories(folder_.path() / name);
      std::string text = k == 1 ? "t[s],alfa_T[deg],x\n" : rows.front() + "\n";
      for (std::size_t i = 0; i < 900; ++i) text += rows[1 + 900 * k + i] + "\n";
      folder_.write(name + "/alpha_history.csv", text);
      folder_.write(name + "/study.toml", study);
    }
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  TemporaryFolder folder_;
};

TEST_F(ThreeTests, AFolderIsSearchedAndOneThatFailsIsARow) {
  const Outcome outcome = program::run({"batch", folder_.path().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out, {"test1", "test2", "failed", "test3", "p (homogeneity)", "trim", "deg", "'alfa_T[deg]'"});
  const json batch = json::parse(content(path("batch/batch.json")));
  ASSERT_EQ(batch.at("studies").size(), 3U);
  EXPECT_EQ(batch.at("studies")[1].at("status"), "failed");
  EXPECT_NEAR(batch.at("studies")[0].at("values").at("trim").at("value").get<double>(), 12.0 * 0.0174533, 0.01);
  const auto& summary = batch.at("summary");
  const auto trim = std::find_if(summary.begin(), summary.end(), [](const json& s) { return s.at("name") == "trim"; });
  ASSERT_NE(trim, summary.end());
  EXPECT_EQ(trim->at("studies"), 2);
  EXPECT_NEAR(trim->at("mean").get<double>(), 12.0, 0.3);
  EXPECT_TRUE(first_line(path("batch/batch.csv")).starts_with("study,method,status,"));
  expect_parts(content(path("batch/batch.csv")), {"trim[deg],trim_sigma[deg]", "\"", "test3,sliding_bin,converged"});
  EXPECT_TRUE(fs::exists(path("batch/figures/batch_sliding_bin.svg")));
  EXPECT_TRUE(fs::exists(path("batch/studies/test1/fit/sliding_bin/curves.csv")));
}

TEST_F(ThreeTests, AListIsReadInItsOrderAndTheSameAgain) {
  folder_.write("list.txt", "# two of them, and one that is not there\ntest3\ntest1/study.toml  # the first\n\ntest3\ntest9/study.toml\n");
  const Outcome first = program::run({"batch", path("list.txt").string(), "--threads", "2", "--out", path("a").string()});
  ASSERT_EQ(first.status, 0) << first.err;
  const json batch = json::parse(content(path("a/batch.json")));
  ASSERT_EQ(batch.at("studies").size(), 3U) << "each once";
  EXPECT_EQ(batch.at("studies")[0].at("study"), "test3");
  EXPECT_EQ(batch.at("studies")[2].at("study"), "test9");
  expect_parts(batch.at("studies")[2].at("message").get<std::string>(), {"no such file"});
  ASSERT_EQ(program::run({"batch", path("list.txt").string(), "--threads", "1", "--out", path("b").string()}).status, 0);
  EXPECT_EQ(content(path("a/batch.csv")), content(path("b/batch.csv")));
  const auto when = fs::last_write_time(path("a/studies/test1/fit/sliding_bin/fit.json"));
  const Outcome again = program::run({"batch", path("list.txt").string(), "--out", path("a").string()});
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(fs::last_write_time(path("a/studies/test1/fit/sliding_bin/fit.json")), when);
}

TEST_F(ThreeTests, AMendedStudyIsDoneAgain) {
  ASSERT_EQ(program::run({"batch", folder_.path().string()}).status, 0);
  fs::copy_file(path("test1/alpha_history.csv"), path("test2/alpha_history.csv"), fs::copy_options::overwrite_existing);
  const Outcome outcome = program::run({"batch", folder_.path().string(), "--json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(json::parse(outcome.out).at("studies")[1].at("status"), "converged");
}

/// The names that a batch of these folders gives, in its order.
std::vector<std::string> names_of_batch(const fs::path& folder, std::initializer_list<const char*> studies) {
  std::string list;
  for (const char* study : studies) list += std::string(study) + "\n";
  std::ofstream(folder / "list.txt") << list;
  const fs::path out = folder / "named";
  EXPECT_EQ(program::run({"batch", (folder / "list.txt").string(), "--out", out.string()}).status, 0);
  std::vector<std::string> names;
  const json batch = json::parse(content(out / "batch.json"));
  for (const json& row : batch.at("studies")) names.push_back(row.at("study"));
  return names;
}

TEST_F(ThreeTests, StudiesOfOneNameTakeTheirFoldersInWhateverOrder) {
  for (const std::string day : {"may", "june", "july"}) {
    fs::create_directory(path(day));
    fs::copy(path("test1"), path(day + "/run"));
  }
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_of_batch(folder_.path(), {"may/run", "june/run", "test1"}), (Names{"may_run", "june_run", "test1"}));
  EXPECT_EQ(names_of_batch(folder_.path(), {"july/run", "june/run", "may/run"}), (Names{"july_run", "june_run", "may_run"}));
}

/// The digest stands in the head of the checkpoint: another one is another batch.
TEST_F(ThreeTests, EveryFileOfAStudyMakesItAnotherBatch) {
  folder_.write("test1/b.csv", "alpha_T[deg],C_m_alphadot[-]\n1,2\n");
  folder_.write("test1/cut.png", "one");
  std::ofstream(path("test1/study.toml"), std::ios::app) << "\n[reference]\nC_m_alphadot = \"b.csv\"\n\n[video]\nmarker = \"cut.png\"\n";
  const auto digest = [&] {
    EXPECT_EQ(program::run({"batch", path("test1").string(), "--out", path("digest").string()}).status, 0);
    return first_line(path("digest/checkpoints/checkpoint_0.bin"));
  };
  const std::string before = digest();
  EXPECT_EQ(digest(), before);
  folder_.write("test1/b.csv", "alpha_T[deg],C_m_alphadot[-]\n1,3\n");
  const std::string reference = digest();
  EXPECT_NE(reference, before);
  folder_.write("test1/cut.png", "two");
  EXPECT_NE(digest(), reference);
}

/// Two files may be open at a time, and the folder and the checkpoint are: the studies are not to blame, and are done when there is room
/// again.
TEST_F(ThreeTests, WhatTheMachineRefusesIsNoRow) {
  const std::vector<std::string> words{"batch", folder_.path().string(), "--threads", "1"};
  const Outcome first = program::run(words, [] {
    const int next = ::dup(STDIN_FILENO);
    ::close(next);
    const rlimit limit{static_cast<rlim_t>(next) + 2, static_cast<rlim_t>(next) + 2};
    if (next < 0 || ::setrlimit(RLIMIT_NOFILE, &limit) != 0) ::_exit(77);
  });
  EXPECT_EQ(first.status, 1) << first.out;
  expect_parts(first.err, {"Too many open files"});
  EXPECT_TRUE(fs::exists(path("batch/checkpoints/checkpoint_0.bin"))) << "it was in the jobs that it ended";
  ASSERT_EQ(program::run(words).status, 0);
  const json batch = json::parse(content(path("batch/batch.json")));
  EXPECT_EQ(batch.at("studies")[0].at("status"), "converged");
  EXPECT_EQ(batch.at("studies")[2].at("status"), "converged");
}

TEST_F(ThreeTests, WhatIsNoListIsRefused) {
  const auto refused = [&](const std::string& argument, std::initializer_list<const char*> expected) {
    const Outcome outcome = program::run({"batch", argument});
    EXPECT_EQ(outcome.status, 2) << argument;
    EXPECT_EQ(outcome.out, "");
    expect_parts(outcome.err, expected);
  };
  refused(path("lst.txt").string(), {"no such file"});
  refused(path("test1/alpha_history.csv").string(), {"alpha_history.csv:1", "neither", "t[s]"});
  fs::create_directory(path("empty"));
  refused(path("empty").string(), {"no study.toml"});
  folder_.write("empty.txt", "# nothing\n\n");
  refused(path("empty.txt").string(), {"names no study"});
  EXPECT_EQ(program::run({"batch"}).status, 2);
}

TEST_F(ThreeTests, NothingButFailuresIsStatusOne) {
  const Outcome outcome = program::run({"batch", path("test2").string()});
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  expect_parts(outcome.out, {"failed"});
}

}  // namespace
