// The track of the flight against the known apex, as it is and spoilt in every way the test can think of: losing is allowed, lying is not.
#include "tests/workflow/film.h"

#include <gmock/gmock.h>

#include "misfit/core/error.h"
#include "tests/paths.h"

namespace {

using namespace film;
using testing::HasSubstr;

/// Every frame of the clip through `change`, to a file without loss, tracked and scored.
Score spoilt(
    const std::string& name, const std::function<void(Image&, std::size_t)>& change, const VideoStudy& study = {},
    const std::function<std::optional<PixelPoint>(std::size_t)>& where = [](std::size_t k) { return std::optional(truth()[k]); },
    double radius = 11.0) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "spoilt.avi";
  {
    Writer writer(path, 720, 720, frame_rate);
    for (std::size_t n = 0; n < frames().size(); ++n) {
      Image frame = frames()[n];
      change(frame, n);
      writer.add(frame);
    }
  }
  return score(name, path, study, where, radius);
}

void add_noise(Image& frame, double sigma) {
  static std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, sigma);
  for (std::uint8_t& p : frame.pixels) p = static_cast<std::uint8_t>(std::clamp(std::lround(p + noise(random)), 0L, 255L));
}

TEST(Film, WholeFlight) {
  const Score s = score("the flight as it is", flight(), {}, [](std::size_t k) { return std::optional(truth()[k]); });
  EXPECT_EQ(s.track.track.t.size(), 4760u);
  EXPECT_LE(s.rms_x, 0.15);
  EXPECT_LE(s.rms_y, 0.15);
  EXPECT_GE(s.share(), 0.98);
  EXPECT_EQ(s.track.facts.fields, "top_first");
  EXPECT_EQ(s.track.facts.decoded, 2380);
  EXPECT_THAT(s.track.facts.warnings, testing::IsEmpty());
  EXPECT_NEAR(s.track.track.t[4759], 4759 / 59.94, 1e-3);
  expect_honest(s);
}

TEST(Film, NoiseOfTwelveGreyLevels) {
  const Score s = spoilt("noise of 12 grey levels", [](Image& frame, std::size_t) { add_noise(frame, 12.0); });
  EXPECT_GE(s.share(), 0.95);
  expect_honest(s);
}

TEST(Film, BlurOfTwoPixels) {
  const Score s = spoilt("blur of 2 px in the fields", [](Image& frame, std::size_t) {
    frame = woven(blurred(field_of(frame, 0).image, 2.0, 1.0), blurred(field_of(frame, 1).image, 2.0, 1.0));
  });
  EXPECT_GE(s.share(), 0.95);
  expect_honest(s);
}

/// Every line is then half of each field: which of the two pictures of the marker was first cannot be determined.
TEST(Film, FieldsBlendedByABlurAreRefused) {
  try {
    spoilt("blur of 2 px over woven fields", [](Image& frame, std::size_t) { frame = blurred(frame, 2.0, 2.0); });
    ADD_FAILURE() << "blended fields were tracked";
  } catch (const RunError& error) {
    std::printf("    %s\n", error.what());
    EXPECT_THAT(error.what(), HasSubstr("blends of two fields"));
  }
}

TEST(Film, BrightnessDriftingByHalf) {
  const Score s = spoilt("brightness falling to half", [](Image& frame, std::size_t n) {
    const double factor = 1.0 - 0.5 * static_cast<double>(n) / 299.0;
    for (std::uint8_t& p : frame.pixels) p = static_cast<std::uint8_t>(std::lround(p * factor));
  });
  EXPECT_GE(s.share(), 0.95);
  expect_honest(s);
}

TEST(Film, BrightSpotOfTheSameSize) {
  const Score s = spoilt("bright spots of the same size", [](Image& frame, std::size_t n) {
    paint_disc(frame, 180.0, 180.0, 11.0, 240);
    paint_disc(frame, 100.0 + 1.5 * static_cast<double>(n), 420.0, 11.0, 240);
  });
  EXPECT_GE(s.share(), 0.95);
  expect_honest(s);
}

TEST(Film, BarThatHidesTheMarker) {
  std::size_t hidden_ok = 0;
  const Score s = spoilt("a bar hides it for 0.5 s", [](Image& frame, std::size_t n) {
    if (n < 150 || n >= 165) return;
    const double a = truth()[2 * n].column, b = truth()[2 * n + 1].column;
    paint_bar(frame, std::min(a, b) - 25.0, std::max(a, b) + 25.0, n % 2 == 0 ? 90 : 200);
  });
  for (std::size_t k = 300; k < 330; ++k) hidden_ok += s.track.track.ok[k] ? 1 : 0;
  EXPECT_EQ(hidden_ok, 0u);
  EXPECT_GE(s.share(), 0.94);  // 30 of 600 are hidden
  expect_honest(s);
}

TEST(Film, BarsThatItPassesBehind) {
  const Score s = spoilt("two bars it passes behind", [](Image& frame, std::size_t) {
    paint_bar(frame, 200.0, 230.0, 60);
    paint_bar(frame, 480.0, 510.0, 200);
  });
  expect_honest(s);
}

/// Which frames are kept when 5 % are dropped.
std::vector<std::size_t> kept_frames() {
  std::mt19937 random(5);
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < frames().size(); ++n)
    if (random() % 20 != 0) kept.push_back(n);
  return kept;
}

TEST(Film, FivePercentOfTheFramesDropped) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "dropped.avi";
  const auto kept = kept_frames();
  {
    Writer writer(path, 720, 720, frame_rate);
    for (std::size_t n : kept) writer.add(frames()[n]);
  }
  const Score s =
      score("5 % of the frames dropped", path, {}, [&](std::size_t k) { return std::optional(truth()[2 * kept[k / 2] + k % 2]); });
  EXPECT_GE(s.share(), 0.8);
  expect_honest(s);
}

TEST(Film, FivePercentOfTheFramesRepeatedInsteadOfTheNext) {
  const auto kept = kept_frames();
  std::size_t repeated = 0;
  const Score s = spoilt(
      "5 % replaced by the one before",
      [&](Image& frame, std::size_t n) {
        if (n == 0 || std::binary_search(kept.begin(), kept.end(), n)) return;
        frame = frames()[n - 1];
        ++repeated;
      },
      {}, [&](std::size_t k) { return std::optional(truth()[k]); });
  EXPECT_GT(s.track.facts.repeated, 5);
  EXPECT_GE(s.share(), 0.85);
  expect_honest(s);
}

TEST(Film, TimestampsTellWhereFramesAreMissing) {
  // The first 3 s of the flight with 5 % of the frames left out and the others at their times, written by ffmpeg (select, vsync
  // passthrough).
  const Score s = score("5 % left out, timestamps kept", paths::source() / "tests/apps/data/gaps.mkv", {},
                        [&](std::size_t k) { return std::optional(truth()[k]); });
  EXPECT_GT(s.track.facts.missing, 2);
  EXPECT_EQ(s.track.facts.lost.at("no frame in the file"), static_cast<std::size_t>(2 * s.track.facts.missing));
  EXPECT_THAT(s.track.facts.warnings, testing::Contains(HasSubstr("missing between others")));
  expect_honest(s);
}

TEST(Film, ProgressiveAtTheFieldRate) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "progressive.avi";
  {
    Writer writer(path, 720, 720, 2.0 * frame_rate);
    for (std::size_t n = 0; n < 240; ++n)
      for (int parity : {0, 1}) writer.add(doubled(field_of(frames()[n], parity)));
  }
  const Score s = score("progressive, 59.94 frames/s", path, {}, [](std::size_t k) { return std::optional(truth()[k]); });
  EXPECT_EQ(s.track.facts.fields, "progressive");
  EXPECT_EQ(s.track.track.t.size(), 480u);
  EXPECT_GE(s.share(), 0.95);
  expect_honest(s);
}

TEST(Film, WrongFieldOrderInTheStudyIsNoticedAndSaid) {
  for (const char* fields : {"bottom_first", "progressive"}) {
    VideoStudy study;
    study.fields = fields;
    const Score s = spoilt(
        std::string("the study says ") + fields, [](Image&, std::size_t) {}, study);
    EXPECT_EQ(s.track.facts.fields, "top_first");
    EXPECT_THAT(s.track.facts.warnings,
                testing::Contains(testing::AllOf(HasSubstr(fields), HasSubstr("top_first"), HasSubstr("contradicts"))));
    EXPECT_GE(s.share(), 0.98);
    expect_honest(s);
  }
}

TEST(Film, BottomFieldFirstIsSeen) {
  // The lines of every frame changed places pairwise: what was exposed first now lies in the odd rows, one line below.
  const Score s = spoilt(
      "bottom field first",
      [](Image& frame, std::size_t) {
        const Image even = field_of(frame, 0).image, odd = field_of(frame, 1).image;
        frame = woven(odd, even);
      },
      {},
      [](std::size_t k) {
        return std::optional(PixelPoint{truth()[k].column, truth()[k].row + (k % 2 == 0 ? 1.0 : -1.0)});
      });
  EXPECT_EQ(s.track.facts.fields, "bottom_first");
  EXPECT_GE(s.share(), 0.98);
  expect_honest(s);
}

TEST(Film, MarkersOfEightAndThirtyPixels) {
  for (const double diameter : {8.0, 30.0}) {
    const Score s = spoilt(
        "marker of " + std::to_string(static_cast<int>(diameter)) + " px",
        [&](Image& frame, std::size_t n) {
          for (int parity : {0, 1}) paint_ring(frame, parity, 2, truth()[2 * n + static_cast<std::size_t>(parity)], diameter);
          add_noise(frame, 4.0);
        },
        {}, [](std::size_t k) { return std::optional(truth()[k]); }, 0.5 * diameter);
    EXPECT_NEAR(2.0 * s.track.facts.outer, diameter, 0.1 * diameter);
    EXPECT_GE(s.share(), 0.95);
    expect_honest(s);
  }
}

}  // namespace
