#pragma once

// Channels with clocks of their own as the rows of one table.

#include <optional>
#include <string>
#include <vector>

#include "misfit/core/table.h"
#include "misfit/data/log/log.h"

namespace misfit {

enum class Between {
  nearest,  ///< a measurement: each of its samples stands once, at its own time or the nearest, and is missing at others
  held,     ///< the last value that is known
  linear,
};

/// A channel that is wanted, by a name that Log::index_of() understands: its column is called so.
struct WantedChannel {
  std::string name;
  Between between = Between::nearest;
};

/// Which samples of a clock become rows.
enum class Rows {
  forward,      ///< those whose time is known and after the one before
  as_recorded,  ///< all, where every wanted channel is of the one clock: time may run back, from one run to the next
};

/// Time in seconds (column `time`, or "t"), then the wanted channels in their own units. The time base is the clock `time`, if that is
/// given (`nearest` channels of other clocks then stand at the nearest of its times), else that of the `nearest` channels; if they have
/// several, the times of all, and of held inputs. What was done to channels of other clocks, and how many samples were left out and why, is
/// said in `notes`. InputError: no such channel (with the nearest names), a channel without a
/// time, a time whose unit is none of time.
[[nodiscard]] Table on_one_time_base(LogReader& reader, const std::vector<WantedChannel>& wanted, const std::optional<std::string>& time,
                                     std::vector<std::string>& notes, Rows rows = Rows::forward);

/// The unit of a channel as units.h reads it, from the file or the end of its name; empty if neither gives one that is known.
[[nodiscard]] std::string known_unit(const LogChannel& channel);

}  // namespace misfit
