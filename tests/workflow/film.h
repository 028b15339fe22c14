#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <random>

#include "misfit/core/table.h"
#include "misfit/video/module.h"
#include "misfit/video/video.h"
#include "misfit/workflow/measure/track_video.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

/// Films made by tests out of the flight of mpf_f111, whose apex is known in every field (data/apex_truth.csv, which the program never
/// reads).
namespace film {

namespace fs = std::filesystem;
using namespace misfit;

inline fs::path flight() { return paths::source() / "configs/mpf_f111/flight.mkv"; }
constexpr double frame_rate = 29.97;

/// Apex of every field of the flight, in pixels of the frame.
inline const std::vector<PixelPoint>& truth() {
  static const std::vector<PixelPoint> points = [] {
    const Table table = read_csv(paths::source() / "tests/apps/data/apex_truth.csv");
    std::vector<PixelPoint> out;
    for (std::size_t k = 0; k < table.rows(); ++k) out.push_back({360.0 - table.at("P_y").values[k], 360.0 + table.at("P_z").values[k]});
    return out;
  }();
  return points;
}

/// The first frames of the flight, decoded once.
inline const std::vector<Image>& frames() {
  static const std::vector<Image> all = [] {
    std::vector<Image> out;
    Video video(flight());
    while (out.size() < 300) out.push_back(video.next()->image);
    return out;
  }();
  return all;
}

/// Writes grey pictures to a file without loss (.mkv) or as its name says.
class Writer {
 public:
  Writer(const fs::path& path, int width, int height, double rate) {
    std::string why;
    sink_ = video_backend().create(path.string(), width, height, rate, why);
    EXPECT_TRUE(sink_) << why;
  }
  void add(const Image& image) {
    std::vector<std::uint8_t> bgr;
    bgr.reserve(3 * image.pixels.size());
    for (const std::uint8_t grey : image.pixels) bgr.insert(bgr.end(), 3, grey);
    sink_->write(bgr.data());
  }

 private:
  std::unique_ptr<video_module::Sink> sink_;
};

/// What came out of a film, against the truth.
struct Score {
  double rms_x = 0.0, rms_y = 0.0, worst = 0.0, z = 0.0, seconds = 0.0;
  std::size_t inside = 0, inside_ok = 0, ok = 0;
  VideoTrack track;
  [[nodiscard]] double share() const { return static_cast<double>(inside_ok) / static_cast<double>(inside); }
};

/// `where(k)`: the apex in sample k; nullopt where there is none to be seen. `radius`: of the ring.
inline Score score(const std::string& name, const fs::path& path, const VideoStudy& study,
                   const std::function<std::optional<PixelPoint>(std::size_t)>& where, double radius = 11.0) {
  Score s;
  const auto begin = std::chrono::steady_clock::now();
  s.track = track_video(path, study);
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const TrackFacts& f = s.track.facts;
  double squares = 0.0;
  for (std::size_t k = 0; k < s.track.track.t.size(); ++k) {
    const auto at = where(k);
    const bool inside =
        at && at->column > radius && at->row > radius && at->column < f.width - 1 - radius && at->row < f.height - 1 - radius;
    s.inside += inside ? 1 : 0;
    if (!s.track.track.ok[k]) continue;
    ++s.ok;
    s.inside_ok += inside ? 1 : 0;
    if (!at) {
      s.worst = 1e9;  // found where nothing is
      continue;
    }
    const double x = 0.5 * f.width - s.track.track.P_y[k] - at->column, y = 0.5 * f.height + s.track.track.P_z[k] - at->row;
    s.rms_x += x * x;
    s.rms_y += y * y;
    squares += 0.5 * (x * x + y * y) / std::pow(s.track.track.sigma[k], 2.0);
    s.worst = std::max(s.worst, std::hypot(x, y));
  }
  const auto n = static_cast<double>(s.ok);
  s.rms_x = std::sqrt(s.rms_x / n);
  s.rms_y = std::sqrt(s.rms_y / n);
  s.z = std::sqrt(squares / n);
  std::printf(
      "%-34s RMS %.3f %.3f px, worst %.2f px, ok %zu of %zu inside (%.2f %%), error/sigma %.2f, sigma %.3f px, %s, %.1f s = %.1f x real "
      "time\n",
      name.c_str(), s.rms_x, s.rms_y, s.worst, s.inside_ok, s.inside, 100.0 * s.share(), s.z, f.sigma, f.fields.c_str(), s.seconds,
      s.track.track.t.back() / s.seconds);
  for (const auto& [why, count] : f.lost) std::printf("    lost: %zu %s\n", count, why.c_str());
  for (const auto& warning : f.warnings) std::printf("    ! %s\n", warning.c_str());
  return s;
}

/// Never a lie: no ok sample farther than 3 px from the truth, sigma right within 1.5.
inline void expect_honest(const Score& s) {
  EXPECT_LT(s.worst, 3.0);
  EXPECT_LT(s.z, 1.5);
  EXPECT_GT(s.z, 1.0 / 1.5);
}

/// A ring of diameter `diameter` painted into one field's lines of `frame` over the old marker, by 8 x 8 points per pixel.
inline void paint_ring(Image& frame, int first_row, int step, const PixelPoint& at, double diameter, double cover = 13.0) {
  const double outer = 0.5 * diameter, inner = 0.45 * outer, reach = std::max(cover, outer + 1.5);
  for (int row = first_row; row < frame.height; row += step) {
    if (std::abs(row - at.row) > reach + 1.0) continue;
    for (int column = std::max(0, static_cast<int>(at.column - reach) - 1);
         column <= std::min(frame.width - 1, static_cast<int>(at.column + reach) + 1); ++column) {
      double sum = 0.0;
      for (int k = 0; k < 64; ++k) {
        const int i = k % 8, j = k / 8;
        const double x = column + (i + 0.5) / 8.0 - 0.5 - at.column, y = row + (j + 0.5) / 8.0 - 0.5 - at.row;
        const double rho = std::hypot(x, y);
        sum += rho < inner ? 35.0 : rho < outer ? 238.0 : rho < reach ? 140.0 : frame(column, row);
      }
      frame(column, row) = static_cast<std::uint8_t>(std::lround(sum / 64.0));
    }
  }
}

inline void paint_disc(Image& frame, double column, double row, double radius, int grey) {
  for (int r = 0; r < frame.height; ++r)
    for (int c = 0; c < frame.width; ++c)
      if (std::hypot(c - column, r - row) <= radius) frame(c, r) = static_cast<std::uint8_t>(grey);
}

inline void paint_bar(Image& frame, double left, double right, int grey) {
  for (int r = 0; r < frame.height; ++r)
    for (int c = std::max(0, static_cast<int>(left)); c <= std::min(frame.width - 1, static_cast<int>(right)); ++c)
      frame(c, r) = static_cast<std::uint8_t>(grey);
}

/// Gaussian blur by `sigma_x` columns and `sigma_y` lines of an image.
inline Image blurred(const Image& image, double sigma_x, double sigma_y) {
  const auto weights = [](double sigma) {
    std::vector<double> w;
    const int half = static_cast<int>(std::ceil(3.0 * sigma));
    double sum = 0.0;
    for (int k = -half; k <= half; ++k) {
      w.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
      sum += w.back();
    }
    for (double& v : w) v /= sum;
    return w;
  };
  const std::vector<double> wx = weights(sigma_x), wy = weights(sigma_y);
  const int hx = static_cast<int>(wx.size() / 2), hy = static_cast<int>(wy.size() / 2);
  std::vector<double> middle(image.pixels.size());
  for (int r = 0; r < image.height; ++r) {
    for (int c = 0; c < image.width; ++c) {
      double sum = 0.0;
      for (int k = -hx; k <= hx; ++k) sum += wx[static_cast<std::size_t>(k + hx)] * image(std::clamp(c + k, 0, image.width - 1), r);
      middle[image.at(c, r)] = sum;
    }
  }
  Image out(image.width, image.height);
  for (int r = 0; r < image.height; ++r) {
    for (int c = 0; c < image.width; ++c) {
      double sum = 0.0;
      for (int k = -hy; k <= hy; ++k)
        sum += wy[static_cast<std::size_t>(k + hy)] * middle[image.at(c, std::clamp(r + k, 0, image.height - 1))];
      out(c, r) = static_cast<std::uint8_t>(std::lround(sum));
    }
  }
  return out;
}

/// Two fields woven into a frame.
inline Image woven(const Image& even, const Image& odd) {
  Image out(even.width, even.height + odd.height);
  for (int r = 0; r < out.height; ++r)
    for (int c = 0; c < out.width; ++c) out(c, r) = (r % 2 == 0 ? even : odd)(c, r / 2);
  return out;
}

/// A field as a full frame: lines between are means of their neighbours.
inline Image doubled(const Field& field) {
  Image out(field.image.width, field.frame_height());
  for (int r = 0; r < out.height; ++r) {
    const double line = field.image_row(r);
    const int above = std::clamp(static_cast<int>(std::floor(line)), 0, field.image.height - 1);
    const int below = std::clamp(static_cast<int>(std::ceil(line)), 0, field.image.height - 1);
    for (int c = 0; c < out.width; ++c) out(c, r) = static_cast<std::uint8_t>((field.image(c, above) + field.image(c, below) + 1) / 2);
  }
  return out;
}

}  // namespace film
