#include "misfit/video/frame_at.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/video/module.h"
#include "misfit/video/stream.h"

namespace misfit {
namespace {

constexpr double rounding_of_timestamps = 0.3;  // of an interval: how much later a timestamp may be than the time it stands for
constexpr double near_ahead = 2.0;              // [s] decoded on, rather than sought
constexpr double before_seek = 0.5;             // [s] by which a seek aims earlier, since decoders begin at what they can decode alone

}  // namespace

FrameReader::FrameReader(std::filesystem::path path) : path_(std::move(path)) { begin(); }

void FrameReader::begin() {
  stream_ = opened_stream(path_);
  const std::vector<double>& first = stream_->first_timestamps;
  origin_ = first.empty() ? 0.0 : first.front();
  has_timestamps_ = first.size() > 1 && first[1] > first[0];
  interval_ = 1.0 / stream_->rate;
  grey_.resize(static_cast<std::size_t>(stream_->width) * static_cast<std::size_t>(stream_->height));
  shown_.reset();
  shown_ = decode();
  if (shown_) shown_->t = 0.0;
  ahead_ = decode();
}

/// The frame behind `ahead_`, or `shown_`, or none: a frame without a timestamp follows it by the usual interval.
std::optional<FrameReader::Decoded> FrameReader::decode() {
  Decoded out;
  out.bgr.resize(3 * grey_.size());
  if (!stream_->next(grey_.data(), out.bgr.data())) return std::nullopt;
  out.t = stream_->timestamp - origin_;
  if (shown_ && !(out.t > shown_->t)) out.t = shown_->t + interval_;
  return out;
}

/// False: it ended behind `t`, or where no timestamp tells where it is (0: none, or the very beginning).
bool FrameReader::seek(double t) {
  if (!has_timestamps_ || !stream_->seek(std::max(0.0, origin_ + t - before_seek))) return false;
  shown_.reset();
  shown_ = decode();
  ahead_ = shown_ ? decode() : std::nullopt;
  return shown_ && shown_->t > 0.0 && shown_->t <= t;
}

void FrameReader::read_until(double t) {
  while (ahead_ && ahead_->t <= t) {
    shown_ = std::move(ahead_);
    ahead_ = decode();
  }
}

std::optional<FramePicture> FrameReader::at(double t) {
  const double latest = std::max(t, 0.0) + rounding_of_timestamps * interval_;
  const bool passed = !shown_ || shown_->t > latest, far = ahead_ && ahead_->t < latest - near_ahead;
  if ((passed || far) && !seek(latest)) begin();
  read_until(latest);
  if (!shown_) return std::nullopt;
  std::string why;
  const std::vector<std::uint8_t> bytes =
      video_backend().encoded(shown_->bgr.data(), stream_->width, stream_->height, video_module::PictureFormat::jpeg, why);
  if (bytes.empty()) return std::nullopt;
  return FramePicture{stream_->width, stream_->height, shown_->t, std::string(bytes.begin(), bytes.end())};
}

}  // namespace misfit
