#include "misfit/data/intervals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

TEST(Intervals, BootstrapsAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  Bootstrap b{"output_error", "residuals in blocks", 40, 200, 1, 7, {{"failed: no state", 1}}, {"blocks are cut"}, {}, {}};
  b.numbers = {{"trim", "rad", 0.21, 0.001, 0.2101, 0.0012, 0.208, 0.2125, 199}};
  b.curves = {{"C_m",
               "alpha_T",
               "rad",
               "-",
               {0.1, 0.2},
               {0.01, -0.01},
               {1e-3, std::nan("")},
               {0.01, -0.01},
               {1e-3, 2e-3},
               {0.0, -0.02},
               {0.02, 0.0},
               {5.0, 0.0}}};
  write_bootstrap(folder.path(), {b});
  const Bootstrap back = read_bootstrap(folder.path()).front();
  EXPECT_EQ(back.block, 40);
  EXPECT_EQ(back.failed, 1U);
  EXPECT_EQ(back.failures, b.failures);
  EXPECT_EQ(back.notes, b.notes);
  write_resampling_notes(folder.path(), {"sliding_bin is not resampled"});
  EXPECT_EQ(read_resampling_notes(folder.path()), std::vector<std::string>{"sliding_bin is not resampled"});
  EXPECT_EQ(back.numbers.front().upper, 0.2125);
  EXPECT_EQ(back.numbers.front().fit_sigma, 0.001);
  EXPECT_EQ(back.curves.front().sigma, b.curves.front().sigma);
  EXPECT_TRUE(std::isnan(back.curves.front().fit_sigma[1]));
  const std::string csv = read_file(folder.path() / "bootstrap.csv");
  EXPECT_NE(csv.find("output_error,C_m,alpha_T,5.729577951308233,deg,0.01,0.001"), std::string::npos) << csv;
}

TEST(Intervals, ProfilesAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const LikelihoodProfile p{"filter_error", "m_a",           "kg", 0.3, 0.03, 0.0, 1.0, {0.2, 0.3, 0.4}, {9.0, 0.0, 11.0}, 0.24, 0.4, true,
                            false,          {"no upper end"}};
  write_profiles(folder.path(), {p});
  const LikelihoodProfile back = read_profiles(folder.path()).front();
  EXPECT_EQ(back.value, p.value);
  EXPECT_EQ(back.drop, p.drop);
  EXPECT_EQ(back.lower, 0.24);
  EXPECT_TRUE(back.lower_found);
  EXPECT_FALSE(back.upper_found);
  EXPECT_EQ(back.plain_sigma, 0.0);
  EXPECT_EQ(back.words, p.words);
}

TEST(Intervals, RandomStartsAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const MultiStart s{"filter_error", 5, 1, 7, {{"it cannot be run", 1}}, {-2.0, 0.1, 3.0, 40.0}, 1, 2, 1, {{"k", "N/m", 2.0, 0.1, 2.5}},
                     {"a word"}};
  write_multi_starts(folder.path(), {s});
  const MultiStart back = read_multi_starts(folder.path()).front();
  EXPECT_EQ(back.drop, s.drop);
  EXPECT_EQ(back.failures, s.failures);
  EXPECT_EQ(back.same + 10 * back.lower + 100 * back.higher, 121U);
  EXPECT_EQ(back.runs + 10 * back.failed, 15U);
  EXPECT_EQ(back.seed, 7U);
  EXPECT_EQ(back.numbers.front().best, 2.5);
  EXPECT_EQ(back.numbers.front().sigma, 0.1);
  EXPECT_EQ(back.words, s.words);
}

TEST(Intervals, AFileOfAnotherFormIsNamed) {
  const TemporaryFolder folder;
  write_atomically(folder.path() / "profile.json", "[{\"method\": 3}]");
  EXPECT_THROW(static_cast<void>(read_profiles(folder.path())), InputError);
  EXPECT_THROW(static_cast<void>(read_bootstrap(folder.path())), InputError);
}

}  // namespace
}  // namespace misfit
