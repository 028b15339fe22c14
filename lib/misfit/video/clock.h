#pragma once

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

}  // namespace misfit
