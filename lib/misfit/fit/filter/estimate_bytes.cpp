#include "misfit/fit/filter/estimate_bytes.h"

#include <type_traits>

#include "misfit/core/lists.h"

namespace misfit {

// The structured bindings name every field: one more and they no longer compile.

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<ChannelNoise> auto& data) {
  auto& [white, coloured, coloured_frequency, coloured_damping, given, no_coloured, rounding] = data;
  bytes(white, coloured, coloured_frequency, coloured_damping, given, no_coloured, rounding);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<ForcePrior> auto& data) {
  auto& [group, median, log_sigma] = data;
  bytes(group, median, log_sigma);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<FilterNoise> auto& data) {
  auto& [force, force_time, channels, time_is_given, further_forces, prior] = data;
  bytes(force, force_time, channels, time_is_given, further_forces, prior);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<NoiseFit> auto& data) {
  auto& [noise, minus_log_density, information, logs, at_bound, converged] = data;
  bytes(noise, minus_log_density, information, logs, at_bound, converged);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<Penalty> auto& data) {
  auto& [curve, first, omega, rank, lambda, chosen] = data;
  bytes(curve, first, omega, rank, lambda, chosen);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<StepPart> auto& data) {
  auto& [to, implicit] = data;
  bytes(to, implicit);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<IntegrationPlan> auto& data) {
  auto& [parts, first, rate, tolerance, error, lack] = data;
  bytes(parts, first, rate, tolerance, error, lack);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<RecordedInputs> auto& data) {
  auto& [t, hold, values, slopes] = data;
  bytes(t, hold, values, slopes);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<InputTable> auto& data) {
  auto& [recorded, plan] = data;
  bytes(recorded, plan);
}

/// All but the measurements and what is read from them.
template <class Bytes>
void fields(Bytes& bytes, MaybeConst<FilterData> auto& data) {
  auto& [signals, inputs, use, first, start, covariance, steps, read, input_departures] = data;
  static_cast<void>(signals);
  static_cast<void>(steps);
  static_cast<void>(read);
  bytes(inputs, use, first, start, covariance, input_departures);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<LinearisedRun> auto& data) {
  auto& [n, ny, samples, end, finite, failed_at, Phi, H, z, correction, predicted, K, Kj, y, y_variance, past_response, past_mean, P,
         loglik, validation_loglik, counted, validated] = data;
  bytes(n, ny, samples, end, finite, failed_at, Phi, H, z, correction, predicted, K, Kj, y, y_variance, past_response, past_mean, P, loglik,
        validation_loglik, counted, validated);
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<Innovations> auto& data) {
  auto& [e, S, departures, variances, minus_log] = data;
  bytes(e, S, departures, variances, minus_log);
}

template <class Bytes, MaybeConst<FilterTrace> Trace>
void fields(Bytes& bytes, Trace& data) {
  using Run = std::conditional_t<std::is_const_v<Trace>, const LinearisedRun, LinearisedRun>;
  using Read = std::conditional_t<std::is_const_v<Trace>, const Innovations, Innovations>;
  bytes(static_cast<Run&>(data), static_cast<Read&>(data));
}

template <class Bytes>
void fields(Bytes& bytes, MaybeConst<FilterJacobian> auto& data) {
  auto& [J, r, index] = data;
  bytes(J, r, index);
}

/// All but the models.
template <class Bytes>
void fields(Bytes& bytes, MaybeConst<FilterEstimate> auto& estimate) {
  auto& [model, forced, penalties, noise, reference, noise_fit, data, traces, jacobians, covariance, joint_covariance, joint_information,
         objective, loglik, validation_loglik, newton_decrement, edf, converged, out_of_time, whole_runs, message, notes, integration,
         outliers, nonlinear, linearisations] = estimate;
  static_cast<void>(model);
  static_cast<void>(forced);
  bytes(penalties, noise, reference, noise_fit, data, traces, jacobians, covariance, joint_covariance, joint_information, objective, loglik,
        validation_loglik, newton_decrement, edf, converged, out_of_time, whole_runs, message, notes, integration, outliers, nonlinear,
        linearisations);
}

namespace {

void set_values(Model& model, const std::vector<double>& values) {
  if (values.size() != model.parameters.size()) throw RunError("a stored estimate is of another model");
  for (std::size_t i = 0; i < values.size(); ++i) model.parameters[i].value = values[i];
}

}  // namespace

void write_estimate(ByteWriter& bytes, const FilterEstimate& estimate) {
  bytes(estimate.model.values(), estimate.forced.model.values(), estimate.model.free_parameters(), estimate);
}

FilterEstimate read_estimate(ByteReader& bytes, const Model& model, const std::vector<Signals>& experiments) {
  FilterEstimate out;
  std::vector<double> values, forced;
  std::vector<int> free;
  bytes(values, forced, free, out);
  out.model = model;
  set_values(out.model, values);
  for (int i = 0; i < int_size(out.model.parameters); ++i) out.model.parameters[i].free = place_of(free, i) >= 0;
  out.forced = with_random_force(out.model);
  set_values(out.forced.model, forced);
  if (out.data.size() != experiments.size()) throw RunError("a stored estimate is of other experiments");
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    out.data[e].signals = &experiments[e];
    out.data[e].steps = out.forced.steps;
    out.data[e].read = std::make_shared<const ReconstructedStates>(reconstruct_states(model, experiments[e]));
  }
  return out;
}

}  // namespace misfit
