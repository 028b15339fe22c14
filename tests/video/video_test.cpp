#include "misfit/video/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <new>

#include "misfit/core/error.h"
#include "misfit/video/canvas.h"
#include "misfit/video/frame_at.h"
#include "misfit/video/module.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

fs::path flight() { return paths::source() / "configs/mpf_f111/flight.mkv"; }
fs::path gaps() { return paths::source() / "tests/apps/data/gaps.mkv"; }

std::string first_bytes(const fs::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

template <class Error>
std::string error_of(const fs::path& file) {
  try {
    Video video(file);
    while (video.next()) {
    }
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// In a process of its own: reads `file` and keeps every frame until memory ends. Exit status 0: the error said so.
[[noreturn]] void read_until_memory_ends(const fs::path& file) {
  constexpr int separate = 1 << 16;  // [bytes] from here on every piece of memory counts towards the limit
  ::mallopt(M_MMAP_THRESHOLD, separate);
  std::vector<Frame> frames;
  frames.reserve(10'000);
  try {
    Video video(file);
    frames.push_back(*video.next());
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    constexpr rlim_t more = 10'000'000;
    const rlimit limit{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + more, RLIM_INFINITY};
    ::setrlimit(RLIMIT_AS, &limit);
    while (auto frame = video.next()) frames.push_back(std::move(*frame));
  } catch (const std::bad_alloc&) {
    ::_exit(0);
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(2);
}

TEST(VideoDeathTest, WhereMemoryEndsInTheDecodingThreadTheCallerIsTold) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more address space than the limit leaves";
#endif
  EXPECT_EXIT(read_until_memory_ends(flight()), testing::ExitedWithCode(0), "");
}

/// A picture of which every line differs from every other, and every frame from every other.
Image stripes(int width, int height, int number) {
  Image image(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) image(c, r) = static_cast<std::uint8_t>((40 + 7 * r + 3 * c + 11 * number) % 200);
  return image;
}

void write(const fs::path& path, const std::vector<Image>& images, double rate) {
  std::string why;
  auto sink = video_backend().create(path.string(), images.front().width, images.front().height, rate, why);
  ASSERT_TRUE(sink) << why;
  for (const Image& image : images) {
    std::vector<std::uint8_t> bgr;
    for (std::uint8_t grey : image.pixels) bgr.insert(bgr.end(), 3, grey);
    sink->write(bgr.data());
  }
}

TEST(Video, GivesEveryFrameInOrderWithItsNumber) {
  const TemporaryFolder folder;
  std::vector<Image> images;
  for (int n = 0; n < 40; ++n) images.push_back(stripes(64, 48, n));
  write(folder.path() / "a.mkv", images, 25.0);
  Video video(folder.path() / "a.mkv");
  EXPECT_EQ(video.facts().width, 64);
  EXPECT_EQ(video.facts().height, 48);
  EXPECT_NEAR(video.facts().rate, 25.0, 1e-9);
  long n = 0;
  while (auto frame = video.next()) {
    ASSERT_EQ(frame->number, n);
    EXPECT_FALSE(frame->repeated);
    int worst = 0;
    for (std::size_t k = 0; k < frame->image.pixels.size(); ++k)
      worst = std::max(worst, std::abs(frame->image.pixels[k] - images[static_cast<std::size_t>(n)].pixels[k]));
    EXPECT_LE(worst, 3) << "frame " << n;  // grey → limited-range luma → grey
    ++n;
  }
  EXPECT_EQ(n, 40);
  EXPECT_TRUE(video.facts().finished);
  EXPECT_THAT(notes_of(video.facts()), IsEmpty());
}

TEST(Video, CopiesOfTheFrameBeforeAreMarked) {
  const TemporaryFolder folder;
  write(folder.path() / "a.mkv", {stripes(64, 48, 0), stripes(64, 48, 1), stripes(64, 48, 1), stripes(64, 48, 2)}, 25.0);
  Video video(folder.path() / "a.mkv");
  std::vector<bool> repeated;
  while (auto frame = video.next()) repeated.push_back(frame->repeated);
  EXPECT_EQ(repeated, (std::vector<bool>{false, false, true, false}));
  EXPECT_EQ(video.facts().repeated, 1);
}

TEST(Video, GapsBetweenTimestampsAreMissingFrames) {
  Video video(gaps());
  std::vector<long> numbers;
  while (auto frame = video.next()) numbers.push_back(frame->number);
  EXPECT_EQ(numbers.back(), 89);
  EXPECT_EQ(video.facts().decoded + video.facts().missing, 90);
  EXPECT_GT(video.facts().missing, 2);
  EXPECT_THAT(notes_of(video.facts()), testing::ElementsAre(HasSubstr("missing between others")));
}

TEST(Video, FramesHaveTheTimesOfTheFile) {
  Video video(paths::source() / "tests/apps/data/variable_rate.mp4");
  EXPECT_TRUE(video.facts().variable);
  long n = 0, timed = 0;
  while (auto frame = video.next()) {
    const auto k = static_cast<double>(n);  // what ffprobe prints, to 11 us
    const double truth = k / 30.0 + 0.008 * std::sin(1.3 * k) + (k > 60.0 ? (k - 60.0) / 60.0 : 0.0);
    EXPECT_NEAR(frame->time.value_or(truth), truth, 2e-5) << n;
    timed += frame->time ? 1 : 0;
    EXPECT_EQ(frame->number, n++);  // none is missing where the intervals differ
  }
  EXPECT_EQ(n, 120);
  EXPECT_GE(timed, 100);
  EXPECT_EQ(video.facts().missing, 0);
  EXPECT_NEAR(video.facts().rate, 24.2, 0.5);
  EXPECT_THAT(notes_of(video.facts()), testing::Contains(HasSubstr("constant rate")));
}

TEST(Video, ColoursComeWhereTheyAreAskedFor) {
  Video grey(gaps()), coloured(gaps(), Colours::bgr);
  const auto a = grey.next(), b = coloured.next();
  EXPECT_TRUE(a->colour.empty());
  ASSERT_EQ(b->colour.bgr.size(), 3 * b->image.pixels.size());
  EXPECT_EQ(a->image, b->image);
  for (std::size_t k = 0; k < b->image.pixels.size(); k += 997) EXPECT_NEAR(b->colour.bgr[3 * k + 1], b->image.pixels[k], 2);
}

/// What FrameReader is to give for some frames of a film, by their numbers; the number of all.
std::pair<std::map<std::size_t, FramePicture>, std::size_t> pictures_of(const fs::path& file, const std::vector<std::size_t>& numbers) {
  std::map<std::size_t, FramePicture> out;
  Video video(file, Colours::bgr);
  std::size_t k = 0;
  for (; const auto frame = video.next(); ++k) {
    if (std::find(numbers.begin(), numbers.end(), k) == numbers.end()) continue;
    const int width = frame->image.width, height = frame->image.height;
    std::string why;
    const auto bytes = video_backend().encoded(frame->colour.bgr.data(), width, height, video_module::PictureFormat::jpeg, why);
    out[k] = {width, height, frame->time.value_or(-1.0), std::string(bytes.begin(), bytes.end())};
  }
  return {out, k};
}

TEST(FrameReader, GivesTheFrameOfATimeInAnyOrder) {
  const std::vector<std::size_t> numbers = {0, 1, 2, 40, 400, 399, 17, 300, 301, 0, 501};
  for (const fs::path& film : {paths::source() / "configs/film_pendulum/swing.mp4", flight()}) {
    const auto [frames, count] = pictures_of(film, numbers);
    ASSERT_GT(count, 501U);
    FrameReader reader(film);
    for (const std::size_t k : numbers) {
      const FramePicture& frame = frames.at(k);
      const auto found = reader.at(frame.t);
      ASSERT_TRUE(found) << film << k;
      EXPECT_NEAR(found->t, frame.t, 1e-6) << film << k;
      EXPECT_TRUE(found->jpeg == frame.jpeg) << film << " frame " << k;
      EXPECT_EQ(found->width, frame.width);
      EXPECT_EQ(found->height, frame.height);
    }
  }
}

TEST(FrameReader, BetweenFramesTheEarlierIsShownAndBehindTheEndTheLast) {
  const fs::path film = paths::source() / "configs/film_pendulum/swing.mp4";
  const auto [frames, count] = pictures_of(film, {100, 101});
  FrameReader reader(film);
  EXPECT_NEAR(reader.at(0.5 * (frames.at(100).t + frames.at(101).t))->t, frames.at(100).t, 1e-6);
  EXPECT_NEAR(reader.at(-3.0)->t, 0.0, 1e-6);
  const double step = frames.at(101).t - frames.at(100).t;
  EXPECT_NEAR(reader.at(1e6)->t, step * static_cast<double>(count - 1), 1.5 * step);
}

TEST(FrameReader, SaysWhatItCannotRead) {
  const TemporaryFolder folder;
  folder.write("text.mp4", "no video at all");
  EXPECT_THROW(FrameReader(folder.path() / "text.mp4"), RunError);
  EXPECT_THROW(FrameReader(folder.path() / "none.mp4"), InputError);
}

TEST(Video, StoppedEarlyEndsItsThread) {
  for (int k = 0; k < 3; ++k) {
    Video video(gaps());
    ASSERT_TRUE(video.next().has_value());
  }
}

TEST(Video, TruncatedIsSaidWithTheCounts) {
  const TemporaryFolder folder;
  folder.write("cut.mkv", first_bytes(flight(), 1'500'000));
  Video video(folder.path() / "cut.mkv");
  while (video.next()) {
  }
  EXPECT_EQ(video.facts().declared, 2380);
  EXPECT_LT(video.facts().decoded, 1200);
  EXPECT_GT(video.facts().decoded, 300);
  EXPECT_THAT(notes_of(video.facts()), testing::ElementsAre(AllOf(HasSubstr("truncated or damaged"), HasSubstr("2380"),
                                                                  HasSubstr(std::to_string(video.facts().decoded)))));
}

TEST(Video, MissingFileNamesTheNearest) {
  EXPECT_THAT(error_of<InputError>(paths::source() / "configs/mpf_f111/fligth.mkv"),
              AllOf(HasSubstr("no such file"), HasSubstr("flight.mkv")));
}

TEST(Video, WhatIsNoVideoIsSaid) {
  const TemporaryFolder folder;
  folder.write("empty.mkv", "");
  folder.write("text.mkv", "t[s],P_y[px]\n0,1\n");
  folder.write("head.mkv", first_bytes(flight(), 500));
  EXPECT_THAT(error_of<RunError>(folder.path() / "empty.mkv"), AllOf(HasSubstr("empty.mkv"), HasSubstr("empty")));
  EXPECT_THAT(error_of<RunError>(folder.path() / "text.mkv"), AllOf(HasSubstr("text.mkv"), HasSubstr("not a video")));
  EXPECT_THAT(error_of<RunError>(folder.path() / "head.mkv"), HasSubstr("not a video"));
  EXPECT_THAT(error_of<InputError>(folder.path()), HasSubstr("not a file"));
}

TEST(ReadImage, IsGreyAndSaysWhatItCannotRead) {
  const TemporaryFolder folder;
  Canvas canvas(20, 10);
  canvas.paste({stripes(20, 10, 0), 0, 1}, {0.0, 0.0, 20.0, 10.0}, {});
  canvas.write_png(folder.path() / "a.png");
  EXPECT_EQ(read_image(folder.path() / "a.png"), stripes(20, 10, 0));
  folder.write("b.png", "no picture");
  EXPECT_THROW((void)read_image(folder.path() / "b.png"), RunError);
  EXPECT_THROW((void)read_image(folder.path() / "c.png"), InputError);
}

TEST(Field, LinesLieWhereTheFrameHasThem) {
  const Image frame = stripes(8, 7, 0);
  const Field even = field_of(frame, 0), odd = field_of(frame, 1);
  EXPECT_EQ(even.image.height, 4);
  EXPECT_EQ(odd.image.height, 3);
  EXPECT_EQ(odd.image(3, 1), frame(3, 3));
  EXPECT_DOUBLE_EQ(odd.row_of(1.0), 3.0);
  EXPECT_DOUBLE_EQ(even.image_row(5.0), 2.5);
}

}  // namespace
}  // namespace misfit
