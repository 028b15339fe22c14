// The refits of discover on the stored queue: shared by ranks, found again after a sudden end.

#include "tests/apps/on_ranks.h"
#include "tests/apps/oscillator_study.h"
#include "tests/apps/short_flight.h"  // killed_at()

namespace {

using namespace program;
using Words = std::vector<std::string>;

class DiscoverJobs : public testing::Test {
 protected:
  [[nodiscard]] Words words(const std::string& out) const {
    return {"discover", study_.path("study.toml").string(), "--out", study_.path(out).string(), "--threads", "1"};
  }
  [[nodiscard]] std::string candidates(const std::string& out) const { return content(study_.path(out) / "candidates.json"); }

  const OscillatorStudy study_;
};

TEST_F(DiscoverJobs, ASearchThatWasKilledGoesOnToTheSameAnswer) {
  const Outcome whole = program::run(words("whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_FALSE(fs::exists(study_.path("whole") / "discover_refits")) << "nobody needs them any more";
  const fs::path refits = study_.path("killed") / "discover_refits" / "checkpoint_0.bin";
  constexpr std::uintmax_t more_than_a_head = 1000;
  const std::uintmax_t left = killed_at(words("killed"), refits, more_than_a_head);
  EXPECT_GT(left, more_than_a_head) << "it was not killed among its refits";
  EXPECT_FALSE(fs::exists(study_.path("killed") / "candidates.json"));
  const Outcome again = program::run(words("killed"));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(candidates("killed"), candidates("whole"));
  EXPECT_FALSE(fs::exists(study_.path("killed") / "discover_refits"));
}

using DiscoverJobsUnderMpi = UnderMpi<DiscoverJobs>;

TEST_F(DiscoverJobsUnderMpi, FindTheSameOnRanks) {
  ASSERT_EQ(program::run(words("alone")).status, 0);
  const Outcome ranks = on_ranks(2, words("ranks"));
  ASSERT_EQ(ranks.status, 0) << ranks.err;
  EXPECT_EQ(candidates("ranks"), candidates("alone"));
  EXPECT_EQ(ranks.out.find("\nVerdict\n"), ranks.out.rfind("\nVerdict\n")) << "one rank speaks:\n" << ranks.out;
  const Outcome known = on_ranks(2, words("ranks"));
  EXPECT_EQ(known.status, 0) << known.err;
  EXPECT_EQ(known.out, ranks.out);
}

TEST_F(DiscoverJobsUnderMpi, ALadderIsNotClimbedBySeveral) {
  Words words = this->words("ladder");
  words.emplace_back("--auto");
  const Outcome outcome = on_ranks(2, words);
  EXPECT_NE(outcome.status, 0);
  expect_parts(outcome.err, {"--auto cannot run under mpirun"});
  EXPECT_FALSE(fs::exists(study_.path("ladder") / "ladder.json"));
}

}  // namespace
