#pragma once

#include <memory>

#include "misfit/data/log/log.h"

namespace misfit {

/// Columns of text as a log of one clock: a channel per column of numbers (read_loose_csv()), all of them with the first that is called
/// like a time.
[[nodiscard]] std::unique_ptr<LogReader> read_csv_log(const std::filesystem::path& path);

}  // namespace misfit
