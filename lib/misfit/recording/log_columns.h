#pragma once

// The table that a recording is looked at as: not for other files than recording.cpp.

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/core/loose_csv.h"
#include "misfit/recording/recording.h"

namespace misfit {

struct RecordingTable {
  LooseTable table;
  std::string format;              ///< empty: CSV, whose table says it
  std::vector<std::string> notes;  ///< what was done to channels of a log
  bool of_log = false;             ///< made from channels of a log: the first column is time
};

/// A CSV file as it is; of another log the channels that `choice` names, or all if they have one clock, on one time base as columns
/// NAME[UNIT] after t[s]; of one clock all rows, also where time runs back. InputError as read_loose_csv(), open_log(), on_one_time_base();
/// ChannelsUndecided.
[[nodiscard]] RecordingTable recording_table(const std::filesystem::path& path, const RecordingChoice& choice);

}  // namespace misfit
