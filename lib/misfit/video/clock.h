#pragma once

#include <optional>
#include <vector>

namespace misfit {

/// How time runs from frame to frame.
struct FrameClock {
  bool constant = true;  ///< frames lie on a grid of 1 / rate (places of it may be empty)
  double rate = 0.0;     ///< frames per second; of a variable one the inverse of the median interval
};

/// From timestamps [s], increasing. Constant at the `declared` rate, if all but 1 % of them lie within 1.2 ms of its grid (containers round
/// to 1 ms); else at the rate that they themselves show (a file that was cut declares a wrong one); else variable. With fewer than three
/// timestamps: the declared rate.
[[nodiscard]] FrameClock clock_of(const std::vector<double>& timestamps, double declared);

/// Numbers frames on the grid of a constant rate, so that the numbers of those that are missing stay free. The rate may be a little wrong
/// (the first frames alone show it): the grid follows what its times drift against it.
class FrameNumbers {
 public:
  /// Of the next frame, at `time` [s] since the first. One more than that before, where there is no time, or none near the grid.
  [[nodiscard]] long next(const std::optional<double>& time, double rate);

 private:
  long number_ = -1;
  double drift_ = 0.0;  ///< of the times against the grid [frames]
};

}  // namespace misfit
