#include "misfit/data/track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

class TrackFile : public ::testing::Test {
 protected:
  Track read(const std::string& content, const ColumnMap& columns = {}) const {
    return read_track(folder_.write("track.csv", content), columns);
  }
  std::string input_error(const std::string& content, const ColumnMap& columns = {}) const {
    return message_of<InputError>([&] { (void)read(content, columns); });
  }
  TemporaryFolder folder_;
};

TEST_F(TrackFile, WithThreeColumnsHasNoSigmaAndNothingLost) {
  const Track track = read("t[s],P_y[px],P_z[px]\n0,1,2\n0.02,3,4\n");
  EXPECT_EQ(track.t, (std::vector<double>{0.0, 0.02}));
  EXPECT_EQ(track.P_y, (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(track.P_z, (std::vector<double>{2.0, 4.0}));
  EXPECT_TRUE(std::isnan(track.sigma[0]));
  EXPECT_EQ(track.ok, (std::vector<bool>{true, true}));
  EXPECT_TRUE(track.notes.empty());
}

TEST_F(TrackFile, ConvertsUnits) { EXPECT_DOUBLE_EQ(read("t[ms],P_y[px],P_z[px]\n20,1,2\n").t[0], 0.02); }

TEST_F(TrackFile, LostSamplesKeepTheirRow) {
  const Track track = read("t[s],P_y[px],P_z[px],sigma[px],ok\n0,1,2,0.5,1\n1,3,4,0.5,0\n2,,,,0\n3,5,,0.5,1\n4,5,6,,1\n");
  EXPECT_EQ(track.ok, (std::vector<bool>{true, false, false, false, true}));
  for (const std::size_t i : {1U, 2U, 3U}) EXPECT_TRUE(std::isnan(track.P_y[i]) && std::isnan(track.P_z[i])) << i;
  EXPECT_EQ(track.sigma[0], 0.5);
  EXPECT_TRUE(std::isnan(track.sigma[4]));
  EXPECT_EQ(track.notes, (std::vector<std::string>{"3 of 5 samples are lost"}));
}

TEST_F(TrackFile, RowsWithoutTimeAreDroppedAndSaid) {
  const Track track = read("t[s],P_y[px],P_z[px]\n0,1,2\n,3,4\n1,5,6\n");
  EXPECT_EQ(track.P_y, (std::vector<double>{1.0, 5.0}));
  EXPECT_EQ(track.notes, (std::vector<std::string>{"1 row without a time was dropped"}));
}

TEST_F(TrackFile, PositionsBeyondAnyImageAreLostAndSaid) {
  const Track track = read("t[s],P_y[px],P_z[px]\n0,1,2\n1,-999999,4\n2,1e5,6\n");
  EXPECT_EQ(track.ok, (std::vector<bool>{true, false, true}));
  ASSERT_EQ(track.notes.size(), 2U);
  expect_parts(track.notes[0], {"1 sample more than 100000 px"});
}

TEST_F(TrackFile, TimeThatDoesNotIncreaseNamesLineAndBothTimes) {
  expect_parts(input_error("# comment\nt[s],P_y[px],P_z[px]\n0,1,2\n0.5,1,2\n0.25,1,2\n"), {"track.csv:5", "0.25 s after 0.5 s"});
  expect_parts(input_error("t[s],P_y[px],P_z[px]\n0.5,1,2\n0.5,1,2\n"), {"track.csv:3", "0.5 s after 0.5 s"});
}

TEST_F(TrackFile, AllLostIsSaidInWords) {
  const std::string content = "t[s],P_y[px],P_z[px],ok\n0,1,2,0\n1,,,1\n";
  expect_parts(message_of<RunError>([&] { (void)read(content); }), {"track.csv", "all 2 samples are lost"});
  expect_parts(message_of<RunError>([&] { (void)read("t[s],P_y[px],P_z[px]\n,1,2\n"); }), {"its one sample is lost"});
}

TEST_F(TrackFile, AMissingColumnNamesTheNearest) {
  expect_parts(input_error("t[s],Py[px],P_z[px]\n0,1,2\n"), {"track.csv", "'P_y'", "did you mean 'Py[px]'"});
}

TEST_F(TrackFile, AWrongUnitIsRefused) { expect_parts(input_error("t[s],P_y[m],P_z[px]\n0,1,2\n"), {"'P_y[m]'", "'px'"}); }

TEST_F(TrackFile, TextNamesLineAndColumn) {
  expect_parts(input_error("t[s],P_y[px],P_z[px]\n0,lost,2\n"), {"track.csv:2", "'P_y[px]'", "'lost'"});
}

TEST_F(TrackFile, AWrongSigmaOrFlagNamesTheLine) {
  expect_parts(input_error("t[s],P_y[px],P_z[px],sigma[px]\n0,1,2,0\n"), {"track.csv:2", "sigma = 0 px"});
  expect_parts(input_error("t[s],P_y[px],P_z[px],ok\n0,1,2,0.5\n"), {"track.csv:2", "ok = 0.5", "0 or 1"});
}

TEST_F(TrackFile, ColumnsMapAnyHeader) {
  const ColumnMap columns{{{"t", "time_s"}, {"P_y", "col[px]"}, {"P_z", "row"}, {"ok", "valid"}}};
  const Track track = read("valid,row,col[px],time_s\n1,2,1,0\n0,4,3,1\n", columns);
  EXPECT_EQ(track.P_y[0], 1.0);
  EXPECT_EQ(track.P_z[0], 2.0);
  EXPECT_EQ(track.ok, (std::vector<bool>{true, false}));
}

TEST_F(TrackFile, AMapToAnAbsentHeaderOrOfAnUnknownSignalIsRefused) {
  const std::string content = "t[s],P_y[px],P_z[px]\n0,1,2\n";
  expect_parts(input_error(content, {{{"ok", "valid"}}}), {"no column 'valid'"});
  expect_parts(input_error(content, {{{"P_x", "P_y"}}}), {"'P_x'", "did you mean 'P_y'"});
}

TEST_F(TrackFile, IsReadBackAsWritten) {
  const Track track = read("t[s],P_y[px],P_z[px],sigma[px],ok\n0,1.25,2,0.5,1\n0.016683,,,,0\n0.033367,-3,4.125,,1\n");
  write_track(folder_.path() / "copy.csv", track);
  const Track copy = read_track(folder_.path() / "copy.csv");
  EXPECT_EQ(copy.t, track.t);
  EXPECT_EQ(copy.ok, track.ok);
  EXPECT_EQ(copy.P_y[2], -3.0);
  EXPECT_EQ(copy.P_z[2], 4.125);
  EXPECT_TRUE(std::isnan(copy.P_y[1]) && std::isnan(copy.sigma[2]));
  EXPECT_EQ(copy.sigma[0], 0.5);
}

TEST(TrackExample, OfASimulatedFlightIsRead) {
  const Track track = read_track(paths::source() / "tests/data/files/track.csv");
  ASSERT_EQ(track.t.size(), 200U);
  EXPECT_NEAR(track.t[199] / 199.0, 1.0 / 59.94, 1e-6);
  EXPECT_EQ(track.P_y[0], 123.857);
  EXPECT_EQ(track.P_z[1], 224.292);
}

}  // namespace
}  // namespace misfit
