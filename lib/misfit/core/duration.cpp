#include "misfit/core/duration.h"

#include <fmt/format.h>

#include <utility>

namespace misfit {

std::string duration_in_words(double seconds) {
  constexpr double minute = 60.0, hour = 3600.0, day = 86400.0;
  const auto [unit, name] = seconds < 2.0 * minute ? std::pair(1.0, "s")
                            : seconds < 2.0 * hour ? std::pair(minute, "min")
                            : seconds < 2.0 * day  ? std::pair(hour, "h")
                                                   : std::pair(day, "d");
  return fmt::format("{:.3g} {}", seconds / unit, name);
}

}  // namespace misfit
