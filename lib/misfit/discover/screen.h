#pragma once

#include "misfit/diagnose/features.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/discover/frequency_scan.h"
#include "misfit/jobs/work_queue.h"

namespace misfit {

/// Score of a candidate model's strengths at a cell. One strength that cannot be negative and would have to be: nothing there, chi² 0.
/// Columns are empty where the model cannot be run so.
struct CellScore {
  ScoreResult result;
  Eigen::MatrixXd columns;
};
[[nodiscard]] CellScore score_cell(const FilterEstimate& estimate, const ScoreTest& score, const CandidateModel& candidate_model,
                                   const std::vector<double>& at);

/// Result of the score test of a candidate model, at its best cell.
struct ScreeningResult {
  const CandidateModel* candidate_model = nullptr;
  std::vector<double> cell;  ///< shapes, then the frequency if it has one
  ScoreResult result;
  Eigen::MatrixXd columns;       ///< at the best cell
  double cells_effective = 1.0;  ///< independent cells among those scanned
  double p_value = 1.0;          ///< corrected for its cells, not for other families
  double log_p = 0.0;            ///< log(p of the best cell) + log(cells_effective): ranks what is below 1e-300
  bool runs = true;              ///< false: the model cannot be run with it
  std::size_t cells = 0;
  FrequencyGrid frequencies;  ///< that were scanned; none where it has no frequency
};

/// An estimate, and what score tests of it need.
struct ScoreWork {
  const FilterEstimate& estimate;
  const ScoreTest& score;
  const ForceSensitivity& force;
  int threads = 0;
  bool calibrated = false;  ///< the outputs are those of a calibrated camera: no errors of unknown form are looked for
};

/// Score tests of all cells of all candidate models. Frequencies are scanned in steps of 1/(4T) by their line in the score of the force
/// steps (frequency_grid), and the strongest are then tested exactly. Independent of the number of threads.
[[nodiscard]] std::vector<ScreeningResult> screen(const ScoreWork& work, const std::vector<CandidateModel>& candidate_models,
                                                  const ProgressFn& progress = {});

/// log p-value of a candidate model's score by chance: chi² with as many degrees of freedom as its columns have independent directions; of
/// a single strength that cannot be negative only one side counts; 1 where there is nothing.
[[nodiscard]] double log_score_tail(const CandidateModel& candidate_model, const ScoreResult& score);
/// The same of a refit's drop, with a degree of freedom for each strength.
[[nodiscard]] double log_drop_tail(const CandidateModel& candidate_model, double drop);

/// p-value of the best of `families`, from the logarithm of its own (corrected for its cells).
[[nodiscard]] double family_wise_p(double log_p, double families);

}  // namespace misfit
