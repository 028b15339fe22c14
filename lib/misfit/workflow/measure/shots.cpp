#include "misfit/workflow/measure/shots.h"

#include <fmt/format.h>

namespace misfit {
namespace {

constexpr long regular_shots = 15;
constexpr std::size_t lost_shots = 5, trail_length = 40;

void complete(Shot& shot, const std::vector<TrackedSample>& track, std::size_t sample) {
  shot.label = fmt::format("{:.2f} s", shot.t);
  for (std::size_t k = sample > trail_length ? sample - trail_length : 0; k <= sample; ++k) {
    if (track[k].loss == Loss::none) shot.trail.push_back(track[k].at);
  }
  if (!shot.trail.empty()) shot.zoom_at = shot.trail.back();
  if (track[sample].loss == Loss::none) {
    shot.at = {track[sample].at};
  } else {
    shot.lost = "lost: " + words(track[sample].loss);
  }
}

}  // namespace

Shots::Shots(long declared) : every_(declared / regular_shots + 1) {}

void Shots::offer(const Frame& frame, const Field& field, std::size_t sample, const TrackedSample& found) {
  const bool lost = found.loss != Loss::none;
  const bool begins = lost && !was_lost_ && lost_ < lost_shots;
  was_lost_ = lost;
  const bool due = frame.number >= next_ && field_before_ != frame.number;
  field_before_ = frame.number;
  if (!due && !begins) return;
  if (due) next_ = frame.number - frame.number % every_ + every_;
  if (begins && !due) ++lost_;
  shots_.push_back({field, 0.0, {}, {}, 0.0, {}, {}, {}});
  samples_.push_back(sample);
  if (std::ssize(shots_) > 4 * regular_shots) halve();  // the container did not declare how many there are
}

std::vector<Shot> Shots::finish(const std::vector<TrackedSample>& track, const std::vector<double>& times, double radius) {
  while (!samples_.empty() && samples_.back() >= times.size()) {
    samples_.pop_back();
    shots_.pop_back();
  }
  for (std::size_t k = 0; k < shots_.size(); ++k) {
    shots_[k].t = times[samples_[k]];
    shots_[k].radius = radius;
    complete(shots_[k], track, samples_[k]);
  }
  return std::move(shots_);
}

void Shots::halve() {
  every_ *= 2;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < shots_.size(); k += 2, ++kept) {
    shots_[kept] = std::move(shots_[k]);
    samples_[kept] = samples_[k];
  }
  shots_.resize(kept);
  samples_.resize(kept);
}

}  // namespace misfit
