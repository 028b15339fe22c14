#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace misfit {

/// A moment: whole seconds since 1970-01-01T00:00:00 (UTC, if the text says its zone), and a part of one.
struct IsoDate {
  std::int64_t seconds = 0;
  double part = 0.0;       ///< [s], 0 to 1
  int since_midnight = 0;  ///< whole seconds, by the clock that wrote it
};

/// "2026-01-02T03:04:05.678Z", "2026-01-02 03:04:05,678+01:00", "2026-01-02 03:04", "2026/01/02 03:04:05" (ISO 8601, and a blank for its
/// T); with points the day comes first: "01.03.2024 00:10" (DIN 5008). nullopt where the text is no such date, or names a day or an hour
/// that is none.
[[nodiscard]] std::optional<IsoDate> read_iso_date(std::string_view text);

[[nodiscard]] double seconds_between(const IsoDate& from, const IsoDate& to);

}  // namespace misfit
