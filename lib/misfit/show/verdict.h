#pragma once

#include <string>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/ladder.h"
#include "misfit/data/verdict.h"
#include "misfit/show/blocks.h"

namespace misfit {

/// What is known of a study when its verdict is asked for; nullptr: not there.
struct VerdictInput {
  std::string study, out;                  ///< as commands name them: "configs/null"; the run folder, empty where it is the default
  const std::vector<Fit>* fits = nullptr;  ///< of the study's own model
  const Calibration* calibration = nullptr;
  const Comparison* comparison = nullptr;     ///< for the trims of references
  const Diagnosis* diagnosis = nullptr;       ///< of the study's own model
  const Diagnosis* rung_diagnosis = nullptr;  ///< of the last rung of the ladder
  const Discovery* discovery = nullptr;       ///< of the last rung of the ladder
  const Ladder* ladder = nullptr;
  std::string left_out = {};  ///< results on disk that are outdated, and why: a clause; empty: there are none
  std::string anew = {};      ///< the command that makes everything anew
};

/// In this order: no usable fit; a calibration that its own sweep contradicts (once discover has asked); an effect that discovery accepts,
/// alone or one of several; a search that was not finished; a dependence that no effect explains; candidates that were rejected; what the
/// ladder has added; nothing found missing. Without a search: what the residuals and the diagnosis say. Errors before and after are those
/// of the first and the last rung of the ladder, else of the model without and with the effect that discovery names, else of the fit.
[[nodiscard]] Verdict verdict_of(const VerdictInput& input);

/// The box at the end of what a terminal shows and at the beginning of a report: sentence, errors, next command.
[[nodiscard]] Blocks blocks_of(const Verdict& verdict);

}  // namespace misfit
