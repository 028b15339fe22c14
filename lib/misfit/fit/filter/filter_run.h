#pragma once

// References
//   [J]  A. H. Jazwinski, Stochastic Processes and Filtering Theory (1970): extended Kalman filter.
//   [DK] J. Durbin, S. J. Koopman, Time Series Analysis by State Space Methods (2012): disturbance smoother.

#include <cstdint>
#include <memory>
#include <vector>

#include "misfit/fit/filter/filter_model.h"
#include "misfit/fit/filter/filter_noise.h"
#include "misfit/fit/filter/normal_density.h"
#include "misfit/fit/filter/reading.h"
#include "misfit/inference/states.h"
#include "misfit/sim/planner.h"

namespace misfit {

/// White noise of a reading in whole steps beside its own, in steps. The filter takes states as normal after each reading, which they are
/// not where they are known to a small part of a step: a model that is right would be rejected. Scores of an offset and of a gain, whose
/// mean chi² should be 1, in 80 records of 750 samples of a first order without noise: 18 and 132 with 0.001 of a step, 1.2 and 1.6 with
/// 0.05, 1.0 and 0.8 with 0.1; with a random force of 0.02 to 0.1 of a step per sample and 0.1: 0.7 to 1.4, about as such means scatter.
/// It is 12 % more variance than that of rounding.
inline constexpr double kWhiteOfSteps = 0.1;

/// Innovations and their variances, each given the earlier channels of its sample, as the update takes them; 0: not used.
struct Innovations {
  std::vector<double> e, S;
  /// The same of the measurements as they are, and −log of their densities, where a channel is read in whole steps (reading.h); empty: that
  /// is of no channel.
  std::vector<double> departures = {}, variances = {}, minus_log = {};

  /// `in_steps`: some channel is read in whole steps.
  void resize(std::size_t measurements, bool in_steps);
  /// Takes one in. `step`: 0 where it is read as it is; else kWhiteOfSteps of it is added to its sigma.
  Reading take(std::size_t place, double departure, double variance, double step);
  /// Measured − predicted, and its variance.
  [[nodiscard]] double departure(std::size_t place) const { return departures.empty() ? e[place] : departures[place]; }
  [[nodiscard]] double variance(std::size_t place) const { return variances.empty() ? S[place] : variances[place]; }
  /// Of the density of one that was used.
  [[nodiscard]] double minus_log_density(std::size_t place) const {
    return minus_log.empty() ? minus_log_normal(e[place], S[place]) : minus_log[place];
  }
};

/// What a measurement is used for.
enum class SampleRole : std::uint8_t {
  none,       ///< missing, or set aside as an outlier
  update,     ///< moves the state, is not counted (initial samples that a study excludes)
  counted,    ///< in the likelihood
  validation  ///< in the held-out likelihood
};

/// One experiment as the filter takes it.
struct FilterData {
  const Signals* signals = nullptr;
  InputTable inputs;
  std::vector<SampleRole> use;  ///< samples × channels
  std::size_t first = 0;        ///< first sample at which all states can be read; 0 where a state is known there (Initial::fixed)
  /// Model states there and how uncertain they are, force states excluded (0). A recording begins in the middle of a motion, and what the
  /// channels show may lag behind the state or be off: the sigma of a state that is shown is its RMS departure from there, of another its
  /// typical size, of one that the study knows 0. Memories of effects: own_states.h.
  Eigen::VectorXd start;
  Eigen::MatrixXd covariance;
  std::vector<double> steps = {};                        ///< FilterModel::steps
  std::shared_ptr<const ReconstructedStates> read = {};  ///< the system's states as the channels show them
  /// How far each input departs from its first value, RMS over what is not held out [its unit]: sigma of what it was before
  /// (unknown_past.h).
  std::vector<double> input_departures = {};
};
/// Planned along the states that the channels show, to `integration` (IntegrationPlan::tolerance), or as `plan` says.
[[nodiscard]] FilterData filter_data(const FilterModel& model, const Signals& signals, double integration = kSearchTolerance,
                                     const IntegrationPlan* plan = nullptr);
/// The same experiment for a model of the same system with further own states: measurements, start and uses as in `data`.
[[nodiscard]] FilterData filter_data_like(const FilterModel& model, const FilterData& data);

/// Samples up to the last one with a measurement that enters the fit.
[[nodiscard]] std::size_t end_of_fit(const FilterData& data);

/// What it was linearised about, and how. Row-major blocks per sample.
struct LinearisedRun {
  int n = 0, ny = 0;                 ///< model states (forces included), channels
  std::size_t samples = 0, end = 0;  ///< of the recording; that were run: fewer where what is held out was left out at the end
  bool finite = false;               ///< false: a state left the finite numbers at sample failed_at
  std::size_t failed_at = 0;
  std::vector<double> Phi;            ///< from sample k (filtered) to k + 1: n × n
  std::vector<double> H;              ///< ∂h/∂x at the predicted state: ny × n
  std::vector<double> z;              ///< measured − h(predicted state), without coloured noise; 0 where not used: ny
  std::vector<double> correction;     ///< filtered − predicted state: n
  std::vector<double> predicted;      ///< state one step before: n
  std::vector<double> K;              ///< gains on the model's states: ny × n
  std::vector<double> Kj;             ///< gains on the states of the coloured noise: ny × 2 ny
  std::vector<double> y, y_variance;  ///< one-step prediction of each channel before any update by the sample (coloured noise included)
  /// Of each step that the past of inputs reaches (unknown_past.h): ∂(state after it)/∂(past), n × inputs, and the deviations it was taken
  /// at.
  std::vector<double> past_response, past_mean;
  std::vector<double> P;  ///< only if asked for: covariance of the predicted state with [states | coloured noise], n × (n + 2 ny)
  double loglik = 0.0, validation_loglik = 0.0;
  std::size_t counted = 0, validated = 0;
};

/// A run of the extended Kalman filter over one experiment [J], kept so that it can be run again with other noise (linear about this one),
/// smoothed, and asked for the effect of further forces. Row-major blocks per sample.
struct FilterTrace : LinearisedRun, Innovations {
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  using Rows = Eigen::Map<const RowMatrix>;
  /// Of a measurement: where its e, S, y, … stand.
  [[nodiscard]] std::size_t place(std::size_t sample, std::size_t channel) const { return sample * ny + channel; }
  [[nodiscard]] Vector H_at(std::size_t place) const { return {H.data() + place * n, n}; }
  [[nodiscard]] Vector K_at(std::size_t place) const { return {K.data() + place * n, n}; }
  [[nodiscard]] Vector Kj_at(std::size_t place) const { return {Kj.data() + place * 2 * ny, 2 * Eigen::Index{ny}}; }
  [[nodiscard]] Rows Phi_at(std::size_t sample) const { return {Phi.data() + sample * n * n, n, n}; }
  [[nodiscard]] Vector predicted_at(std::size_t sample) const { return {predicted.data() + sample * n, n}; }
  [[nodiscard]] Vector correction_at(std::size_t sample) const { return {correction.data() + sample * n, n}; }
  /// The state after the measurements of a sample: predicted + correction.
  [[nodiscard]] Eigen::VectorXd filtered(std::size_t sample) const { return predicted_at(sample) + correction_at(sample); }
};

/// Whitened residuals (predicted − measured)/√S of the counted measurements and their derivatives by the free parameters with the gains
/// fixed.
struct FilterJacobian {
  RowMatrix J;                     ///< rows × columns
  Eigen::VectorXd r;               ///< rows
  std::vector<std::size_t> index;  ///< sample · ny + channel of each row

  /// Adds JᵀJ to the lower triangle; nothing where no measurement counts (Eigen's product divides by the number of rows).
  void add_information(Eigen::MatrixXd& lower) const;
};

inline constexpr double kOutlierGate = 5.0;  ///< sigmas: beyond, a measurement is set aside as an outlier (5.7e-7 of good ones)
inline constexpr int kLongestWildRun = 3;    ///< more in a row are not wild: the model has lost the motion, which is what we look for

/// What a run of the filter is asked for besides the trace; null: not wanted.
struct FilterRunOptions {
  FilterJacobian* jacobian = nullptr;
  bool keep_P = false;
  /// false: no further than the last sample that enters the fit. What comes after changes nothing of it; the trace is 0 there.
  bool held_out = true;
  std::vector<std::size_t>* rejected = nullptr;  ///< run_gated()
};

/// Runs the filter. One object per thread and experiment set; keeps pointers to model and data.
class FilterRunner {
 public:
  /// `derivatives`: the model's free parameters have columns; otherwise they are all taken as fixed.
  FilterRunner(const FilterModel& model, bool derivatives);

  void set_parameters(const std::vector<double>& values);  ///< all of FilterModel::model, force_time included
  /// Fills `trace`. Returns trace.finite.
  bool run(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, const FilterRunOptions& options = {});
  /// Passes over measurements more than kOutlierGate sigmas from their prediction as it comes to them, so that a wild one does not spoil
  /// the predictions by which its neighbours are judged; without updates the prediction's sigma grows and with it the gate. Runs longer
  /// than kLongestWildRun are used after all: there the model fails, not the sensor. `rejected`: sample · ny + channel of each.
  bool run_gated(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, std::vector<std::size_t>& rejected);

 private:
  const FilterModel* model_;
  Model own_;
  Stepper stepper_;
};

/// The same filter, linear about `trace`, with other noise: innovations of every used measurement.
/// The correlation time may be another one than in `trace`: the force then decays and acts as `noise` says.
[[nodiscard]] Innovations run_linear(const FilterModel& model, const FilterData& data, const FilterTrace& trace, const FilterNoise& noise);

/// −log of the Gaussian density of counted measurements.
[[nodiscard]] double minus_loglik(const FilterData& data, const Innovations& innovations);

/// What all data, later ones included, say of the states: mean and variance of each model state at every sample [DK]. Needs trace.P.
struct Smoothing {
  RowMatrix x, variance;  ///< samples × n
};
/// ∂ log-likelihood/∂(predicted state) of each sample's and all later measurements, gains fixed, held-out measurements left out: samples ×
/// n.
[[nodiscard]] RowMatrix adjoint_of(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise);
[[nodiscard]] Smoothing smooth_states(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise);

}  // namespace misfit
