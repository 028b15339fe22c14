#pragma once

#include <optional>

#include "misfit/recording/recording.h"
#include "misfit/report/figures.h"

namespace misfit::report {

/// Part `part` of a recording as it was found: a panel per column, inputs first, gaps in time marked. `zoom`: that part of it only.
[[nodiscard]] Figure recording_figure(const RecordingSurvey& survey, std::size_t part, const std::string& name,
                                      const std::optional<Interval>& zoom);

}  // namespace misfit::report
