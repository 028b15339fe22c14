#pragma once

#include <vector>

#include "misfit/track/tracker.h"
#include "misfit/video/contact_sheet.h"
#include "misfit/video/video.h"

namespace misfit {

/// Collects what the contact sheet will show: frames evenly over the video, and the first losses.
class Shots {
 public:
  explicit Shots(long declared);

  void offer(const Frame& frame, const Field& field, std::size_t sample, const TrackedSample& found);
  [[nodiscard]] std::vector<Shot> finish(const std::vector<TrackedSample>& track, const std::vector<double>& times, double radius);

 private:
  void halve();

  long every_, next_ = 0, field_before_ = -1;
  std::size_t lost_ = 0;
  bool was_lost_ = false;
  std::vector<Shot> shots_;
  std::vector<std::size_t> samples_;
};

}  // namespace misfit
