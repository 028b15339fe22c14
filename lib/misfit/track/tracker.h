#pragma once

#include <optional>
#include <vector>

#include "misfit/track/appearance.h"
#include "misfit/track/search.h"

namespace misfit {

struct TrackerOptions {
  Appearance look;
  std::optional<PixelPoint> start;  ///< about where the marker is in the first field
  std::optional<Region> region;     ///< where it is to be looked for
  std::vector<PixelPoint> still;    ///< places of things that look like the marker and stand still
};

/// One field.
struct TrackedSample {
  Loss loss = Loss::not_found;  ///< none: ok
  PixelPoint at;                ///< meaningful if ok
  double sigma = 0.0;           ///< [px] of one coordinate
  double explained = 0.0;
};

/// RMS of the pull of positions towards certain fractions of a pixel, in one coordinate [px], seen in the positions themselves: those of a
/// marker that has been all over the picture are uniform modulo the pitch of the pixels (1 px for columns, the distance of lines for rows),
/// and what their distribution lacks of that is the pull (Watson's U² less its expectation 1/12, over n, times the pitch²). The pull
/// depends on the fractions of both coordinates, and one alone shows its own part: the variance is doubled (an assumption). No residual of
/// a fit shows it, since it moves the whole marker alike. Below 200 positions, or where they spread over less than ten pitches: 0.1 px, an
/// assumption (as large as found in a rendered video).
[[nodiscard]] double pixel_locking(const std::vector<double>& positions, double pitch);

/// White part of the positions' error as they show it themselves [px of one coordinate]: robust standard deviation of their fourth
/// differences over √70, both coordinates together. What moves smoothly has next to none; an object shaken within a few samples has more
/// than its error. 0 with fewer than 20 runs of five.
[[nodiscard]] double white_error(const std::vector<TrackedSample>& samples);

/// Follows one marker through the fields of a video, in their order. While it is held, it is looked for where its
/// velocity takes it, as far around as accelerations seen so far can have bent its way; lost, that neighbourhood grows until it is the
/// whole frame. What is found must look like the marker (judge) and be where it can be.
class Tracker {
 public:
  explicit Tracker(TrackerOptions options);

  /// The next field. `copy`: its frame is pixel for pixel the one before. `steps`: usual intervals since the field before.
  const TrackedSample& add(const Field& field, bool copy = false, double steps = 1.0);
  /// A field that the file does not have.
  const TrackedSample& add_missing();
  /// All samples, their sigmas with pixel locking; those that the motion before and after contradicts, and finds too short to be believed,
  /// become losses.
  [[nodiscard]] std::vector<TrackedSample> finish();

 private:
  [[nodiscard]] PixelPoint expected() const;
  void correct(const Location& found);
  void begin(const Location& found, const Field& field);
  [[nodiscard]] double gate() const;
  [[nodiscard]] std::optional<Location> look(const Field& field, Loss& why);
  [[nodiscard]] bool stands_still_suspiciously(const PixelPoint& at) const;
  const TrackedSample& lose(Loss why);

  TrackerOptions options_;
  std::vector<TrackedSample> samples_;
  bool held_ = false;
  PixelPoint last_, velocity_;   ///< where it was found last, and how fast it went [px per field]
  double velocity_sigma_ = 0.0;  ///< [px per field] of one coordinate
  int row_step_ = 1;             ///< of the fields
  int missed_ = 0;               ///< fields since the last good one
  double since_ = 0.0;           ///< usual intervals since then
  std::vector<double> steps_;    ///< of every sample from the one before
  double acceleration_;          ///< [px per field²] RMS of one coordinate so far
  double contrast_;              ///< running levels[1]
};

}  // namespace misfit
