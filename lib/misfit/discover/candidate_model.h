#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/diagnose/score.h"
#include "misfit/discover/discover.h"

namespace misfit {

/// A candidate effect assembled into the model: its strengths are free and 0, everything else is fixed; shapes have the values of a cell.
struct CandidateModel {
  std::string effect;
  CandidateFamily family = CandidateFamily::physics;
  std::map<std::string, std::string> roles;  ///< as a study would bind them; empty: the defaults
  ModelRequest request;                      ///< the model's, with the effect as a number everywhere
  Model model;                               ///< values of the estimate; only the strengths free
  std::vector<int> strengths;                ///< parameters, in the order of the columns
  std::vector<bool> one_sided;               ///< strengths that cannot be negative
  std::vector<int> shapes;                   ///< parameters that are scanned, in the order of a cell's values
  std::vector<std::vector<double>> cells;    ///< at least one (empty where nothing is scanned)
  int frequency = -1;                        ///< shape that is a frequency to be scanned finely
  double frequency_from = 0.0, frequency_to = 0.0;
  /// Where `frequency` is the way after which something recurs (ScanSpec::is_in_time() is false): of which quantity, or its integral.
  /// frequency_from and frequency_to are then numbers of periods.
  struct Way {
    int quantity = -1;
    bool integrated = false;
  };
  std::optional<Way> recurs_along;
  ColumnPriors priors;  ///< of the strengths
  bool has_priors = false;
  std::vector<int> ports;  ///< dynamic ports it writes
  std::vector<std::string> port_names;
  std::vector<int> quantities;  ///< of the system that it reads; kTime for the time of the recording
  bool lags = false;            ///< it has own states with linear dynamics, or reads an input's past: a lag, a delay
};

/// Stands for the time of the recording among indices of quantities, as in diagnose/features.h.
inline constexpr int kTime = -1;

/// Candidates, and the effects that the model cannot be assembled with though the system has a place for them: a declaration that is wrong,
/// a coefficient that has to be a curve, an input without values, a model that becomes too large.
struct CandidateList {
  std::vector<CandidateModel> models;
  std::vector<NotTried> not_tried;
};

/// Every effect of the registry that suits the model's system, is not in it, and has a strength; generic ones at each place that the system
/// suggests (bindings.h). Left out: effects driven by noise (the filter has them), those of unknown form (unknown_form.h), and generic ones
/// that a system's own effect specialises.
[[nodiscard]] CandidateList list_candidates(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry,
                                            const Calibration* calibration);
/// The candidates alone.
[[nodiscard]] std::vector<CandidateModel> candidate_models(const FilterEstimate& estimate, const ModelRequest& request,
                                                           const Registry& registry, const Calibration* calibration);

/// Of each, whether it is at a port whose forces are sought at another (sought_at()), where the same effect is listed, too.
[[nodiscard]] std::vector<bool> twins_among(const std::vector<CandidateModel>& models, const std::vector<int>& sought_at);
void leave_out(const std::vector<bool>& which, std::vector<CandidateModel>& models);

/// One effect as a study asks for it; nullopt where it has no strength, is driven by noise, or does not suit the system, or cannot
/// be assembled as a number.
[[nodiscard]] std::optional<CandidateModel> candidate_model_of(const FittedStudy& fitted, const EffectRequest& effect,
                                                               const Calibration* calibration);

/// Ports that an effect writes, by name.
[[nodiscard]] std::vector<std::string> names_of_ports(const SystemSpec& system, const BoundEffect& effect);

/// ∂(predicted − measured)/√S by the free parameters of a model with the random force, with the gains of the estimate's noise fixed: rows
/// of the estimate × free parameters. Empty where the filter cannot be run.
[[nodiscard]] Eigen::MatrixXd columns_with_fixed_gains(const FilterEstimate& estimate, const FilterModel& forced);

/// Columns of a candidate model's strengths at a cell: rows of the estimate × strengths. Empty where the model cannot be run so.
[[nodiscard]] Eigen::MatrixXd sensitivity_columns(const FilterEstimate& estimate, const CandidateModel& candidate_model,
                                                  const std::vector<double>& cell);

}  // namespace misfit
