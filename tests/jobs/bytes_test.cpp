#include "misfit/jobs/bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace misfit {

enum class Paint : std::uint8_t { red, green };
struct Point {
  double x = 0.0;
  std::string name;
};

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<Point> auto& point) {
  auto& [x, name] = point;
  bytes(x, name);
}

namespace {

struct Everything {
  double number = -0.1, infinite = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
  int count = -3;
  bool yes = true;
  Paint colour = Paint::green;
  std::string text{"a\0b", 3}, empty;
  std::vector<double> numbers{1.0, 5e-324};
  std::vector<bool> flags{true, false, true};
  std::vector<Point> points{{1.0, "one"}, {2.0, ""}};
  std::optional<double> there = 3.0, absent;
  std::optional<std::pair<double, double>> pair{{4.0, 5.0}};
  std::map<std::string, Point> map{{"p", {6.0, "six"}}};
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(3, 2), nothing;
  Eigen::VectorXd vector = Eigen::VectorXd::LinSpaced(4, 0.0, 1.0);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = Eigen::MatrixXd::Random(2, 3);

  template <class Bytes>
  void all(Bytes& bytes) {
    bytes(number, infinite, none, count, yes, colour, text, empty, numbers, flags, points, there, absent, pair, map, matrix, nothing,
          vector, rows);
  }
};

std::string bytes_of(Everything data) {
  ByteWriter writer;
  data.all(writer);
  return writer.take();
}

TEST(Bytes, ComeBackToTheLastBit) {
  Everything before, after;
  before.number = 1.0 / 3.0;
  after.text = after.points.front().name = "to be written over";
  after.map["other"] = {};
  after.absent = 1.0;
  after.nothing = Eigen::MatrixXd::Ones(2, 2);
  const std::string bytes = bytes_of(before);
  ByteReader reader(bytes);
  after.all(reader);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(bytes_of(after), bytes);
  EXPECT_EQ(after.number, 1.0 / 3.0);
  EXPECT_EQ(after.text, std::string("a\0b", 3));
  EXPECT_EQ(after.points[1].x, 2.0);
  EXPECT_EQ(after.map.size(), 1U);
  EXPECT_FALSE(after.absent.has_value());
  EXPECT_EQ(after.nothing.size(), 0);
  EXPECT_EQ(after.matrix, before.matrix);
  EXPECT_EQ(after.rows, before.rows);
}

TEST(Bytes, ThatEndTooEarlyAreRefused) {
  const std::string bytes = bytes_of({});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Everything into;
    ByteReader reader(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(into.all(reader), RunError) << size;
  }
}

TEST(Bytes, ASizeThatIsNotThereReservesNothing) {
  ByteWriter writer;
  writer(std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::uint64_t>::max());
  const std::string bytes = writer.take();
  std::string text;
  std::vector<double> numbers;
  std::vector<Point> points;
  Eigen::MatrixXd matrix;
  EXPECT_THROW(ByteReader{bytes}(text), RunError);
  EXPECT_THROW(ByteReader{bytes}(numbers), RunError);
  EXPECT_THROW(ByteReader{bytes}(points), RunError);
  EXPECT_THROW(ByteReader{bytes}(matrix), RunError);
}

}  // namespace
}  // namespace misfit
