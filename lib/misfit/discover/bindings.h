#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Bindings of roles, as a study would write them.
using Roles = std::map<std::string, std::string>;

/// One of its ports takes any unit.
[[nodiscard]] bool is_generic(const EffectSpec& effect);

/// Where in a system an effect could act: first its default roles ({}), then, for a generic effect, every place that the system itself
/// suggests. `port` is each port of the random force, and each port that a system with a default for `signal` declares. A conjugate that is
/// a state is its `rate`, and what it is the rate of `displacement` and `level`; one that is the rate of nothing is its `level`, and its
/// `rate` too if its unit is one per time (the speed of a motor whose angle nobody models), else its `content`. A conjugate that is no
/// state is its `rate` if its unit is, or if the equations make it the rate of another quantity, its `displacement` and `level`.
/// `displacement` is also each input of its unit, where the effect allows that (Role::input_too). `to_port` is each other such port,
/// `other` each other state of the level's unit, and each input of it where the effect allows that. `factor` is each state among `rate` and
/// `level`. `other_signal` is each other output of the output's unit (with `other_output`: each pair once). `input` is each input and
/// `output` each output (`signal` follows it), if the system has a default for `input`, or for `signal`: its way of saying that generic
/// effects make sense there. The time of all outputs (`sample_time`) has a place only in a system with inputs: where nothing known has a
/// clock, a motion at another time is as likely. Units are not looked at otherwise: assemble() refuses what does not suit.
[[nodiscard]] std::vector<Roles> enumerate_bindings(const EffectSpec& effect, const SystemSpec& system);

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

  /// Lower bound of a shape: its own, or what the filter resolves of the quantity that it smooths.
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
