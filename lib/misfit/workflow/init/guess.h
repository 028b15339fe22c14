#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/regression/linear_guess.h"
#include "misfit/recording/recording.h"

namespace misfit {

/// What one driver does to an output.
struct GuessedGain {
  std::string name, of;  ///< the parameter; the input or output that drives
  std::string unit, doc;
  double value = 0.0;
  bool from_zero = false;  ///< acts by what `of` is above GuessedModel::zero
};

/// An output with the linear model guessed for it.
struct GuessedOutput {
  std::string name, unit;                     ///< SI
  std::string rate, rate_unit;                ///< column that is its measured rate; empty: none
  std::string rate_state;                     ///< order 2: the state that is its rate
  std::string stiffness, damping, tau, rest;  ///< parameters of its equation
  std::string rest_unit, rest_doc;
  double rest_value = 0.0;
  bool from_zero = false;                ///< rest is above GuessedModel::zero
  std::vector<GuessedGain> gains;        ///< of what drives it
  double noise = 0.0, rate_noise = 0.0;  ///< measurement noise [unit]
  bool size_alone = false;               ///< measured without its sign, as it seems (with_signs()); the guess is of it with signs
  LinearGuess guess;
};

/// A first model is to be fitted in seconds.
struct MostGuessed {
  int states = 16, inputs = 8, outputs = 8, parameters = 32;
};
inline constexpr MostGuessed most_guessed;

/// The zero of a unit such as degC, as a parameter of the model: levels are counted from there. Counted from 0 K, where no recording was,
/// "the output without input" would be an extrapolation of hundreds of kelvin.
struct UnitZero {
  std::string name, unit;
  double value = 0.0;  ///< [K]
};

struct GuessedModel {
  std::vector<std::string> inputs, input_units;  ///< SI
  std::vector<std::string> holds, hold_reasons;
  std::vector<GuessedOutput> outputs;
  std::optional<UnitZero> zero;      ///< where a column is in a unit with an offset
  std::vector<std::string> remarks;  ///< which columns are not in it, and why: one sentence each
};

/// Names that no column may have: those of formulas.
[[nodiscard]] std::vector<std::string> names_of_formulas();

/// Reads a linear model off the survey's longest part, of as many inputs and outputs as a declared system takes, first ones first.
/// InputError: values whose squares are beyond the numbers of this machine.
[[nodiscard]] GuessedModel guess_model(const RecordingSurvey& survey);

/// The column of that name, which the survey has.
[[nodiscard]] const ColumnSurvey& column_called(const RecordingSurvey& survey, const std::string& name);

}  // namespace misfit
