#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/table.h"
#include "misfit/recording/choice.h"

namespace misfit {

enum class ColumnUse { time, input, output, rate, segment, constant, text, unused };

/// What can be said of one column by looking at it.
struct ColumnSurvey {
  std::string header;  ///< as in the file, on one line, shortened if it is long
  std::string name;    ///< usable in formulas: letters, digits and '_', at most 64, unique, not reserved
  std::string unit;    ///< from the header ("u_V", "theta[deg]", "omega1_radps"); "-" if it names none
  ColumnUse use = ColumnUse::unused;
  std::string why;  ///< of the use, in words
  std::size_t missing = 0;
  double low = 0.0, high = 0.0;
  double resolution = 0.0;         ///< all values are multiples of it apart [unit]; 0: no such step found
  double repeat_share = 0.0;       ///< of samples equal to the one before
  bool is_stepwise = false;        ///< constant for most samples, as a command, and not a measurement whose last digit changes slowly
  bool chosen_by_user = false;     ///< its use is the user's choice
  bool is_measured_input = false;  ///< no command that stays constant between samples: it changes smoothly, or nothing in the file moves it
  std::string rate_of;             ///< rate: name of the column whose derivative it is
};

/// An interval in which no sample was taken.
struct Gap {
  double from = 0.0, to = 0.0;  ///< [s]
};

/// A recording as found in somebody's file.
struct RecordingSurvey {
  std::string source;
  std::string format;  ///< "commas, decimal points, 3 comment lines"
  std::size_t rows = 0;
  std::vector<ColumnSurvey> columns;
  double step = 0.0, jitter = 0.0;   ///< median interval and its robust scatter [s]
  std::vector<Gap> gaps;             ///< intervals of more than 1.5 usual steps
  std::vector<std::string> remarks;  ///< what was set right, what is odd: one sentence each
  /// One table per stretch in which time runs forward: `t[s]`, then inputs, outputs and rates as name[unit]; rows whose time is missing or
  /// repeated are left out.
  std::vector<Table> parts;

  [[nodiscard]] std::vector<const ColumnSurvey*> of_use(ColumnUse use) const;
};

/// A log has channels of several clocks: which are meant is to be said (--topic, --input, --output).
class ChannelsUndecided : public InputError {
 public:
  ChannelsUndecided(const std::string& source, std::string channels);
  [[nodiscard]] const std::string& channels() const { return channels_; }  ///< what there is, a line each

 private:
  std::string channels_;
};

/// Looks at a file of columns, or another log (data/log/log.h), asking nothing. Time: a column called so or in a unit of time that runs
/// forward ("T" without a unit where no other does); inputs by name ("u", "force", "valve", …) or because they stand still between jumps
/// (other than steps of the last digit); the rest are outputs, one that is the derivative of another its rate. InputError: what
/// read_loose_csv() refuses, text among numbers, no time column, nothing that could be an output, too few rows. `reserved`: names that no
/// input, output or rate may have ("t" is always one). A column called segment, id, run or the like splits the recording, unless its
/// numbers come again while time runs on. An unknown unit of time is an InputError; so is what `choice` names and the file has not, and a
/// log of several clocks where `choice` says nothing (ChannelsUndecided).
[[nodiscard]] RecordingSurvey survey_recording(const std::filesystem::path& path, const std::vector<std::string>& reserved = {},
                                               const RecordingChoice& choice = {});

}  // namespace misfit
