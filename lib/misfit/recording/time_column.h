#pragma once

// Which column of a file is its time: not for other files than recording.cpp.

#include <optional>
#include <string>
#include <vector>

#include "misfit/core/loose_csv.h"
#include "misfit/recording/recording.h"

namespace misfit {

/// A time increases at more than this share of its steps: several recordings may stand below each other.
inline constexpr double least_increasing_share = 0.5;

enum class Repeats { count, do_not_count };

/// Share of increments above 0; repeated values are left out of the count where several rows may have one time.
[[nodiscard]] double increasing_share(const std::vector<double>& values, Repeats repeats = Repeats::count);

/// Of the columns that are not used otherwise the one that is most surely a time, the first of several; nullopt: none is. Named so and in a
/// unit of time first, at last what is only named so or only in a unit of time and does not always increase. "T" without a unit may as well
/// be a temperature.
[[nodiscard]] std::optional<std::size_t> surest_time(const std::vector<ColumnSurvey>& columns, const LooseTable& table);

/// " ('n' counts rows, …": the first column that does, for the message that none is time; empty: none does.
[[nodiscard]] std::string counting_column(const std::vector<ColumnSurvey>& columns, const LooseTable& table);

}  // namespace misfit
