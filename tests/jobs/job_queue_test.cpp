#include "misfit/jobs/job_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Jobs whose results are known, and which of them ran.
class Jobs {
 public:
  std::string operator()(std::size_t k) {
    const std::lock_guard lock(mutex_);
    ran_.insert(k);
    return result(k);
  }
  static std::string result(std::size_t k) { return std::string(k % 7, 'x') + std::to_string(k); }
  [[nodiscard]] const std::set<std::size_t>& ran() const { return ran_; }

 private:
  std::mutex mutex_;
  std::set<std::size_t> ran_;
};

class StoredJobsTest : public testing::Test {
 protected:
  [[nodiscard]] StoredJobs jobs(std::size_t count = 50, const std::string& digest = "d1", int threads = 2) const {
    return {folder_.path() / "jobs", digest, count, threads};
  }
  /// Runs and gives the numbers of the jobs that had to run.
  std::set<std::size_t> run(const StoredJobs& which) const {
    Jobs job;
    const auto results = run_stored_jobs(which, [&](std::size_t k) { return job(k); });
    EXPECT_TRUE(results);
    for (std::size_t k = 0; k < which.count; ++k) EXPECT_EQ(results->result(k), Jobs::result(k)) << k;
    return job.ran();
  }
  [[nodiscard]] fs::path checkpoint() const { return folder_.path() / "jobs" / "checkpoint_0.bin"; }
  void cut(std::uintmax_t by) const { fs::resize_file(checkpoint(), fs::file_size(checkpoint()) - by); }

  TemporaryFolder folder_;
};

TEST_F(StoredJobsTest, RunOnceAndAreThereTheNextTime) {
  EXPECT_EQ(run(jobs()).size(), 50U);
  EXPECT_TRUE(run(jobs()).empty());
  EXPECT_TRUE(run(jobs(50, "d1", 1)).empty());
}

TEST_F(StoredJobsTest, MoreOfThemKeepWhatIsThere) {
  (void)run(jobs(20));
  const std::set<std::size_t> more = run(jobs(30));
  EXPECT_EQ(more.size(), 10U);
  EXPECT_EQ(*more.begin(), 20U);
  EXPECT_TRUE(run(jobs(5)).empty());
}

TEST_F(StoredJobsTest, OtherInputsBeginAnew) {
  (void)run(jobs());
  EXPECT_EQ(run(jobs(50, "d2")).size(), 50U);
  EXPECT_EQ(run(jobs(50, "d1")).size(), 50U) << "the results of d1 were overwritten";
}

TEST_F(StoredJobsTest, ATornLastRecordIsDroppedWhereverItIsTorn) {
  (void)run(jobs(50, "d1", 1));
  const auto whole = fs::file_size(checkpoint());
  for (const std::uintmax_t by : {1U, 7U, 9U, 20U}) {
    cut(by);
    EXPECT_EQ(run(jobs(50, "d1", 1)), std::set<std::size_t>{49}) << by;
    EXPECT_EQ(fs::file_size(checkpoint()), whole);
  }
}

TEST_F(StoredJobsTest, AFlippedBitIsFoundAndAllBehindItIsDoneAgain) {
  (void)run(jobs(50, "d1", 1));
  std::string bytes = read_file(checkpoint());
  bytes[bytes.size() / 2] ^= 1;
  folder_.write("jobs/checkpoint_0.bin", bytes);
  const std::set<std::size_t> again = run(jobs(50, "d1", 1));
  EXPECT_GT(again.size(), 10U);
  EXPECT_LT(again.size(), 40U);
}

TEST_F(StoredJobsTest, ATornHeadIsOverwritten) {
  fs::create_directories(folder_.path() / "jobs");
  for (const char* text : {"", "misfit", "misfit checkpoint 1 dig"}) {
    folder_.write("jobs/checkpoint_0.bin", text);
    EXPECT_EQ(run(jobs(3, std::string("digest") + text[0])).size(), 3U);
  }
}

TEST_F(StoredJobsTest, AFileThatIsNoCheckpointIsKeptAndNamed) {
  fs::create_directories(folder_.path() / "jobs");
  const fs::path mine = folder_.write("jobs/checkpoint_0.bin", "something else altogether, and longer than the head of a checkpoint is");
  const std::string before = read_file(mine);
  expect_parts(message_of<WriteError>([&] { (void)run(jobs(3, "digest")); }), {"checkpoint_0.bin", "may be yours"});
  remove_stored_jobs(folder_.path() / "jobs");
  EXPECT_EQ(read_file(mine), before);
}

TEST_F(StoredJobsTest, NothingIsWrittenThroughALink) {
  fs::create_directories(folder_.path() / "jobs");
  const fs::path victim = folder_.write("victim", "");
  fs::create_symlink(victim, folder_.path() / "jobs/checkpoint_0.bin");
  expect_parts(message_of<WriteError>([&] { (void)run(jobs(3, "digest")); }), {"checkpoint_0.bin", "is a link"});
  fs::remove_all(folder_.path() / "jobs");
  fs::create_directory(folder_.path() / "elsewhere");
  fs::create_directory_symlink(folder_.path() / "elsewhere", folder_.path() / "jobs");
  expect_parts(message_of<WriteError>([&] { (void)run(jobs(3, "digest")); }), {"jobs", "is a link"});
  EXPECT_EQ(read_file(victim), "");
  EXPECT_TRUE(fs::is_empty(folder_.path() / "elsewhere"));
}

TEST_F(StoredJobsTest, RemovingThemLeavesWhatIsNotOurs) {
  (void)run(jobs(3, "digest"));
  folder_.write("jobs/mine.txt", "mine");
  remove_stored_jobs(folder_.path() / "jobs");
  EXPECT_FALSE(fs::exists(checkpoint()));
  EXPECT_EQ(read_file(folder_.path() / "jobs/mine.txt"), "mine");
}

TEST_F(StoredJobsTest, ResultsOfAnotherRankAreTaken) {
  (void)run(jobs(50, "d1", 1));
  fs::rename(checkpoint(), folder_.path() / "jobs" / "checkpoint_3.bin");
  EXPECT_TRUE(run(jobs()).empty());
}

TEST_F(StoredJobsTest, AStopKeepsWhatIsDone) {
  std::atomic<bool> stop{false};
  const auto job = [&](std::size_t k) {
    if (k == 9) stop = true;
    return Jobs::result(k);
  };
  EXPECT_FALSE(run_stored_jobs(jobs(50, "d1", 1), job, {}, &stop));
  const std::set<std::size_t> left = run(jobs());
  EXPECT_EQ(left.size(), 40U);
  EXPECT_EQ(*left.begin(), 10U);
}

TEST_F(StoredJobsTest, AJobThatThrowsEndsItAndKeepsTheOthers) {
  const auto job = [](std::size_t k) {
    if (k == 5) throw RunError("job five");
    return Jobs::result(k);
  };
  EXPECT_EQ(message_of<RunError>([&] { (void)run_stored_jobs(jobs(50, "d1", 1), job); }), "job five");
  EXPECT_EQ(run(jobs(50, "d1", 1)).size(), 45U);
}

TEST_F(StoredJobsTest, ProgressCountsWhatWasThereBefore) {
  (void)run(jobs(20));
  std::size_t first = 0, total = 0;
  const auto job = [](std::size_t k) { return Jobs::result(k); };
  const auto progress = [&](std::size_t done, std::size_t of) {
    if (first == 0) first = done;
    total = of;
  };
  EXPECT_TRUE(run_stored_jobs(jobs(30, "d1", 1), job, progress));
  EXPECT_EQ(first, 21U);
  EXPECT_EQ(total, 30U);
}

TEST_F(StoredJobsTest, ASecondProcessOnTheSameFolderIsRefused) {
  fs::create_directories(folder_.path() / "jobs");
  const CheckpointWriter other(checkpoint(), "d1");
  expect_parts(message_of<RunError>([&] { (void)run_stored_jobs(jobs(), Jobs::result); }), {"another misfit is at work", "jobs"});
}

TEST(Checkpoint, NumbersKeepEveryBit) {
  const std::vector<double> numbers{0.1, -0.0, std::nan(""), 1e-308, std::numeric_limits<double>::infinity()};
  const std::vector<double> back = unpack_numbers(pack_numbers(numbers));
  ASSERT_EQ(back.size(), numbers.size());
  EXPECT_EQ(pack_numbers(back), pack_numbers(numbers));
  EXPECT_THROW((void)unpack_numbers("123"), RunError);
}

}  // namespace
}  // namespace misfit
