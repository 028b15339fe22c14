#pragma once

#include <string>
#include <vector>

#include "misfit/workflow/init/guess.h"

namespace misfit {

/// model.toml: the guessed system, declared as text, with comments.
[[nodiscard]] std::string model_text(const GuessedModel& model, const RecordingSurvey& survey);

/// study.toml over the files `parts` (CSV names beside it), with comments.
[[nodiscard]] std::string study_text(const std::string& name, const std::vector<std::string>& parts, const RecordingSurvey& survey);

}  // namespace misfit
