// Files cut off at every hundredth byte, and with bits turned over: read, or refused in words; never a crash.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numeric>

#include "misfit/core/error.h"
#include "misfit/data/log/log.h"
#include "tests/core/temporary_folder.h"
#include "tests/data/log/logs_of_the_tests.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All of it; whatever is wrong is an InputError with words that begin with the file.
void read_or_refuse(const fs::path& file) {
  try {
    const auto reader = open_log(file);
    std::vector<std::size_t> all(reader->log().channels.size());
    std::iota(all.begin(), all.end(), 0U);
    reader->read(all);
    for (const LogChannel& c : reader->log().channels) EXPECT_EQ(c.values.size(), c.samples) << c.name;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos) << error.what();
  }
}

class DamagedLog : public testing::TestWithParam<std::string> {
 protected:
  const fs::path file_ = paths::source() / "tests/data/logs" / GetParam();
  const std::string content_ = content_of(file_);
  const bool by_a_program_ = file_.extension() == ".h5" || GetParam() == "version73.mat";  // which takes longer
  const TemporaryFolder folder_;
};

TEST_P(DamagedLog, CutOffAnywhereIsReadOrRefused) {
  ASSERT_FALSE(content_.empty());
  const std::size_t step = 100;
  for (std::size_t size = 0; size < content_.size(); size += step) read_or_refuse(folder_.write(GetParam(), content_.substr(0, size)));
  read_or_refuse(folder_.write(GetParam(), content_.substr(0, content_.size() - 1)));
}

TEST_P(DamagedLog, WithBitsTurnedOverIsReadOrRefused) {
  const int runs = by_a_program_ ? 50 : 400;
  std::uint64_t state = 12345;
  const auto next = [&] { return state = state * 6364136223846793005ULL + 1442695040888963407ULL, state >> 33U; };
  for (int run = 0; run < runs; ++run) {
    std::string damaged = content_;
    const std::uint64_t bits = 1 + next() % 8;
    for (std::uint64_t i = 0; i < bits; ++i) {
      char& byte = damaged[next() % damaged.size()];
      byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << (next() % 8)));
    }
    read_or_refuse(folder_.write(GetParam(), damaged));
  }
}

INSTANTIATE_TEST_SUITE_P(All, DamagedLog, logs_of_the_tests(), name_of_log);

}  // namespace
}  // namespace misfit
