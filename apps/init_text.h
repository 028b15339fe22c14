#pragma once

#include <string>
#include <vector>

#include "misfit/data/recording.h"
#include "misfit/fit/linear_guess.h"

namespace misfit {

/// An output with the linear model guessed for it.
struct GuessedOutput {
  std::string name, unit;                ///< SI
  std::string rate, rate_unit;           ///< column that is its measured rate; empty: none
  double noise = 0.0, rate_noise = 0.0;  ///< reading noise [unit]
  LinearGuess guess;
};

struct GuessedModel {
  std::vector<std::string> inputs, input_units;  ///< SI
  std::vector<std::string> hold_reasons;
  std::vector<GuessedOutput> outputs;
};

/// The unit of a column in SI: "deg/s" → "rad/s", "kPa" → "Pa", "cm" → "m".
[[nodiscard]] std::string si_unit(const std::string& unit);

/// Reads a linear model off the survey's longest part.
[[nodiscard]] GuessedModel guess_model(const RecordingSurvey& survey);

/// model.toml: the guessed system, declared as text, with comments.
[[nodiscard]] std::string model_text(const GuessedModel& model, const RecordingSurvey& survey);

/// study.toml over the files `parts` (CSV names beside it), with comments.
[[nodiscard]] std::string study_text(const std::string& name, const std::vector<std::string>& parts, const RecordingSurvey& survey);

}  // namespace misfit
