// Values of every file of tests/data/logs, to the bit, against what a reference reader said (make_logs.py).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/data/log/log.h"
#include "tests/core/temporary_folder.h"
#include "tests/data/log/logs_of_the_tests.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

fs::path logs() { return paths::source() / "tests/data/logs"; }

struct Expected {
  std::string unit, clock;
  std::vector<double> values;
};

std::map<std::string, Expected> expected_of(const fs::path& file) {
  std::ifstream in(file.string() + ".expected");
  std::map<std::string, Expected> out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string name, numbers;
    Expected e;
    std::getline(fields, name, '\t');
    std::getline(fields, e.unit, '\t');
    std::getline(fields, e.clock, '\t');
    for (std::string number; std::getline(fields, number, ' ');) e.values.push_back(std::strtod(number.c_str(), nullptr));
    out[name] = e;
  }
  return out;
}

std::vector<std::size_t> all_of(const Log& log) {
  std::vector<std::size_t> all(log.channels.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

class LogFile : public testing::TestWithParam<std::string> {};

TEST_P(LogFile, HasTheReferenceReadersValuesToTheBit) {
  const fs::path file = logs() / GetParam();
  const auto reader = open_log(file);
  reader->read(all_of(reader->log()));
  const auto expected = expected_of(file);
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(reader->log().channels.size(), expected.size());
  for (const LogChannel& c : reader->log().channels) {
    SCOPED_TRACE(c.name);
    ASSERT_TRUE(expected.contains(c.name));
    const Expected& e = expected.at(c.name);
    EXPECT_EQ(c.unit, e.unit);
    EXPECT_EQ(c.clock ? reader->log().channels[*c.clock].name : "-", e.clock);
    EXPECT_EQ(c.samples, e.values.size());
    ASSERT_EQ(c.values.size(), e.values.size());
    for (std::size_t i = 0; i < c.values.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(c.values[i]), std::bit_cast<std::uint64_t>(e.values[i]))
          << i << ": " << c.values[i] << ", " << e.values[i];
  }
}

TEST_P(LogFile, GivesOneChannelAloneAsWithAllOthers) {
  const auto whole = open_log(logs() / GetParam());
  whole->read(all_of(whole->log()));
  const auto one = open_log(logs() / GetParam());
  const std::size_t last = one->log().channels.size() - 1;
  one->read({last});
  EXPECT_EQ(one->log().channels[last].values, whole->log().channels[last].values);
  if (last > 0) {
    EXPECT_THAT(one->log().channels[0].values, IsEmpty());
  }
}

INSTANTIATE_TEST_SUITE_P(All, LogFile, logs_of_the_tests(), name_of_log);

std::string refusal(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / name, std::ios::binary) << content;
  try {
    static_cast<void>(open_log(folder.path() / name));
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

using namespace std::string_literals;

TEST(Logs, FormatsThatAreNotReadSayWhatToDo) {
  EXPECT_THAT(refusal("a.parquet", "PAR1\x15\x04"s), HasSubstr("write it as CSV or NPZ"));
  EXPECT_THAT(refusal("a.xls", "\xD0\xCF\x11\xE0\xA1\xB1"s), HasSubstr("save the sheet as CSV"));
  EXPECT_THAT(refusal("a.csv.gz", "\x1F\x8B\x08"s), HasSubstr("gunzip"));
  EXPECT_THAT(refusal("a.bin", "\0\1\2\3 and so on, of no format"s), HasSubstr("no format that is read; read are CSV, MAT"));
}

TEST(Logs, ANameOfAFormatWithOtherContentIsNoCsv) {
  for (const std::string& end : std::vector<std::string>{".mat", ".h5", ".npy", ".NPZ", ".ulg", ".bin"}) {
    SCOPED_TRACE(end);
    EXPECT_THAT(refusal("a" + end, "<html>not found</html>"), HasSubstr("its first bytes are those of no "));
    EXPECT_THAT(refusal("a" + end, ""), HasSubstr("called " + lower_case(end)));
  }
  EXPECT_THAT(refusal("a.xlsx", "PK\x03\x04 cut off"s), HasSubstr("Excel workbook (.xlsx) is not read: save the sheet as CSV"));
  EXPECT_THAT(refusal("a.nc", "CDF\x01\0\0"s), HasSubstr("nccopy"));
  EXPECT_EQ(refusal("a.dat", "t,y\n0,1\n1,2\n"), "read");
  EXPECT_EQ(refusal("a.xls", "t\ty\n0\t1\n1\t2\n"), "read") << "many instruments call their text so";
}

std::string npy(const std::string& head) { return "\x93NUMPY\x01\0"s + static_cast<char>(head.size()) + '\0' + head; }

TEST(Logs, ADamagedFileNamesTheByteAndWhatWasExpected) {
  EXPECT_THAT(refusal("a.npy", npy("{'descr': '<f8' ")), HasSubstr("byte "));
  EXPECT_THAT(refusal("a.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }")),
              HasSubstr("bytes of numbers are expected, as the shape says"));
  EXPECT_THAT(refusal("a.npy", npy("{'descr': '|O', 'fortran_order': False, 'shape': (3,), }")), HasSubstr("objects of Python"));
}

TEST(Logs, NotesWhatADamagedLogHasLost) {
  EXPECT_THAT(open_log(logs() / "damaged.bin")->log().notes,
              ElementsAre(HasSubstr("no message is there, 15 bytes of the log are left out")));
  EXPECT_THAT(open_log(logs() / "appended.ulg")->log().notes, ElementsAre(HasSubstr("no message is there, up to where the log goes on")));
}

/// Not at the next byte 8, of which there are many.
TEST(Logs, ADamagedULogGoesOnAtTheNextWholeMarkOfSynchronisation) {
  constexpr std::size_t damage = 336, mark = 1273;  // the message behind the first mark, the second mark
  std::ifstream in(logs() / "instances.ulg", std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(in), {}};
  content.replace(damage, 6, "\xFF\xFF\xFF\x08\0I"s);
  const TemporaryFolder folder;
  const auto reader = open_log(folder.write("a.ulg", content));
  EXPECT_THAT(reader->log().notes, ElementsAre(HasSubstr("byte 336: no message is there, up to where the log goes on " +
                                                         std::to_string(mark - damage) + " bytes")));
}

TEST(Logs, AChannelIsFoundByItsWholeNameOrByItsEndIfThatIsTheOnlyOne) {
  const auto reader = open_log(logs() / "instances.ulg");
  const Log& log = reader->log();
  EXPECT_EQ(log.channels[log.index_of("slow.T")].name, "slow.T");
  EXPECT_EQ(log.index_of("T"), log.index_of("slow.T"));
  try {
    static_cast<void>(log.index_of("timestamp"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("may be one of"));
  }
  try {
    static_cast<void>(log.index_of("slow.TT"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'slow.T'"));
  }
}

}  // namespace
}  // namespace misfit
