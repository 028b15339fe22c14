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

/// Hats per quantity of the unknown curves.
inline constexpr int hats_of_unknown_curves = 8;

/// log p-value of a candidate model's chi² by chance, in a score as in a refit: of a single strength that cannot be negative only one side
/// counts; 1 where there is nothing.
[[nodiscard]] double log_score_tail(const CandidateModel& candidate_model, double chi2);

/// p-value of the best of `families`, from the logarithm of its own (corrected for its cells).
[[nodiscard]] double family_wise_p(double log_p, double families);

/// Dynamic ports on which a force of unknown form may act: not those of a state whose rate is another state (no force turns a speed into
/// something else; what seems to is the sensor's).
[[nodiscard]] std::vector<int> ports_of_unknown_curves(const SystemSpec& system);

/// A force of unknown form: hat functions of a quantity on a dynamic port, or for a surface their products with those of another; or so an
/// error of an output.
struct UnknownCurve {
  bool of_output = false;  ///< `port` is an output
  std::string port, quantity;
  int quantity_index = -1;
  std::string other;   ///< second quantity of a surface; empty: a curve
  std::string memory;  ///< what stands for a memory of unknown form in place of this, in words; empty: nothing
  ScoreResult result;
  double log_p = 0.0, p_value = 1.0;

  /// "an unknown curve dv/dt(v)", "an unknown surface dv/dt(v, u)", "an error of y that depends on u", "delay (input = u)"
  [[nodiscard]] std::string label() const;
  [[nodiscard]] std::string quantities() const;  ///< "v", "v and u"
};

/// Of every quantity, and of the past of every input, on every dynamic port, and as errors of every output.
[[nodiscard]] std::vector<UnknownCurve> unknown_curves(const ScoreWork& work, const ProgressFn& progress = {});
[[nodiscard]] std::size_t count_of_unknown_curves(const ScoreWork& work);

/// past_of() what an effect with a memory reads first.
[[nodiscard]] std::string past_read_by(const SystemSpec& system, const BoundEffect& effect);

/// Changes of the rate of every own state of the last `effects` effects, of that state and of that rate: whether their memories are of
/// these forms. `quantity`: past_read_by() the effect.
[[nodiscard]] std::vector<UnknownCurve> unknown_own_rates(const ScoreWork& work, int effects);

/// Of every pair of quantities, time among them, of which `read` has at least one, on every dynamic port; four hats of each.
[[nodiscard]] std::vector<UnknownCurve> unknown_surfaces(const ScoreWork& work, const std::vector<int>& read);

/// log P(chi² > x), accurate where the probability underflows.
[[nodiscard]] double log_chi_square_tail(double x, double dof);

}  // namespace misfit
