#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/recording/recording.h"
#include "misfit/workflow/init/guess.h"

namespace misfit {

/// A first study of a recording.
struct FirstStudy {
  RecordingSurvey survey;  ///< what each column was taken for, and why; with the remarks of the model
  GuessedModel model;
  std::vector<std::string> parts;  ///< names of the recordings found in the data: PART.csv each
  std::filesystem::path study;     ///< study.toml as written
};

/// Writes study.toml, model.toml, the data as CSV files and figures/ into `folder` (empty: one called like the data in the current one).
/// InputError: what survey_recording() and guess_model() refuse; files that are there, unless `force` (never the data).
[[nodiscard]] FirstStudy init_study(const std::filesystem::path& data, const std::filesystem::path& folder, bool force,
                                    const ChosenColumns& chosen = {});

}  // namespace misfit
