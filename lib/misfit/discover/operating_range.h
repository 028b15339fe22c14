#pragma once

#include <optional>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// A time that its effect keeps fixed, looked for in sampling intervals: how fast something happens of which the effect says no more than
/// that it is fast (RateLimit::follow_time).
[[nodiscard]] bool is_hardly_seen_between_samples(const CoefficientSpec& c);

/// Its values are rates of a role: ScanSpec::over is "|ROLE|/step".
[[nodiscard]] bool is_of_a_rate(const ScanSpec& scan);

/// What a recording visits: sizes for the shapes of effects that take any unit. Keeps a pointer to the estimate; for one thread.
class OperatingRange {
 public:
  explicit OperatingRange(const FilterEstimate& estimate);

  struct Range {
    double low = 0.0, high = 0.0;
  };
  /// 0.5 % to 99.5 % of the values of a quantity along the filter's path, or, counted on after the quantities, of a measured output;
  /// nullopt where it never changes or is not known.
  [[nodiscard]] std::optional<Range> range(int quantity) const;
  [[nodiscard]] double step() const { return step_; }  ///< usual sampling interval [s]
  /// Narrowest smoothing about a value of a quantity that the filter can follow: sqrt(pi/2) times the usual sigma of its predictions, by
  /// which a step looks smoothed to it (the mean of sign(x) over a normal x of that sigma has the slope sqrt(2/pi)/sigma). 0: of outputs.
  [[nodiscard]] double narrowest(int quantity) const;

  /// range() of the quantity on whose values a shape is an edge (ScanSpec::over names it plainly); nullopt: it is none, or not known.
  [[nodiscard]] std::optional<Range> range_of_edge(const BoundEffect& effect, std::size_t coefficient) const;
  /// range() of the quantity along which a shape is the way after which something recurs (ScanSpec::is_frequency, over a role); nullopt: it
  /// is none, or not known.
  [[nodiscard]] std::optional<Range> range_of_wave(const BoundEffect& effect, std::size_t coefficient) const;

  /// Lower bound of a shape: its own, or what the filter resolves of the quantity that it smooths; of a time that its effect keeps fixed
  /// and that is looked for in sampling intervals, a fifth of the shortest that is looked for.
  [[nodiscard]] double lower_bound(const BoundEffect& effect, std::size_t coefficient) const;
  /// Values of a shape to look at: that of the measurements (OfMeasurements) where they show it, else those of its ScanSpec, kept within
  /// its bounds; the default alone where `over` names what is not known.
  [[nodiscard]] std::vector<double> grid(const BoundEffect& effect, std::size_t coefficient) const;

 private:
  const FilterEstimate& estimate_;
  struct Digits {
    double step = 0.0, level = 0.0;  ///< step 0: not digitised
  };
  [[nodiscard]] static Digits digits_of(const std::vector<double>& measured);
  [[nodiscard]] std::optional<double> of_measurements(const BoundEffect& effect, OfMeasurements what) const;

  std::vector<std::optional<Range>> ranges_;
  std::vector<Digits> digits_;          ///< of the outputs
  mutable std::vector<double> sigmas_;  ///< of quantities; made when first asked for, by a run of the filter
  double step_ = 0.0, rate_ = 0.0;      ///< [s], [Hz]
};

}  // namespace misfit
