#pragma once

#include <string>
#include <vector>

namespace misfit {

/// What is known of a recording beforehand; whatever is empty is found out.
struct RecordingChoice {
  std::vector<std::string> inputs = {}, outputs = {};  ///< columns or channels, by header or name
  std::string time = {};                               ///< the column or channel of time
  std::vector<std::string> names = {};                 ///< headers of a CSV file that has none, one per column
  std::vector<std::string> topics = {};                ///< of a log: groups of channels; the first gives the time base
};

}  // namespace misfit
