#include "misfit/fit/filter/filter_run.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/fit/filter/filter_pass.h"
#include "misfit/fit/filter/filter_sizes.h"
#include "misfit/inference/own_states.h"

namespace misfit {
namespace {

void resize(FilterTrace& trace, int n, int ny, std::size_t samples, bool in_steps) {
  trace.n = n;
  trace.ny = ny;
  trace.samples = samples;
  trace.Phi.assign(samples * n * n, 0.0);
  trace.H.assign(samples * ny * n, 0.0);
  trace.z.assign(samples * ny, 0.0);
  trace.correction.assign(samples * n, 0.0);
  trace.predicted.assign(samples * n, 0.0);
  trace.K.assign(samples * ny * n, 0.0);
  trace.Kj.assign(samples * ny * 2 * ny, 0.0);
  trace.Innovations::resize(samples * ny, in_steps);
  trace.y.assign(samples * ny, std::nan(""));
  trace.y_variance.assign(samples * ny, std::nan(""));
  trace.P.clear();
  trace.past_response.clear();
  trace.past_mean.clear();
  trace.end = samples;
  trace.finite = false;
  trace.loglik = trace.validation_loglik = 0.0;
  trace.counted = trace.validated = 0;
}

/// The memories of effects where the filter begins; forces begin at 0, as uncertain as they are strong (start_covariance()).
void begin_own_states(const FilterModel& model, FilterData& data) {
  const Eigen::Index system = model.model.system_states(), own = model.model.states() - system;
  const OwnStates along = own_states_along(model.model, *data.signals, *data.read);
  data.start.tail(own) = along.start;
  const Eigen::MatrixXd of_states = data.covariance.topLeftCorner(system, system);
  data.covariance.bottomLeftCorner(own, system) = along.by_hidden_states * of_states;
  data.covariance.topRightCorner(system, own) = data.covariance.bottomLeftCorner(own, system).transpose();
  data.covariance.bottomRightCorner(own, own) = along.by_hidden_states * of_states * along.by_hidden_states.transpose();
  data.covariance.diagonal().tail(own) += along.sigma.cwiseAbs2();
  for (int f : model.force_states) {
    data.start[f] = 0.0;
    data.covariance.row(f).setZero();
    data.covariance.col(f).setZero();
  }
}

/// FilterData::input_departures.
std::vector<double> departures_of_inputs(const FilterData& data) {
  const RecordedInputs& record = data.inputs.recorded;
  std::vector<double> out(record.hold.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double squares = 0.0, count = 0.0;
    for (std::size_t k = 0; k < record.t.size(); ++k) {
      const double departure = record.value(k, static_cast<int>(i)) - record.value(0, static_cast<int>(i));
      if (data.signals->held_out(k) || !std::isfinite(departure)) continue;
      squares += departure * departure;
      count += 1.0;
    }
    out[i] = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  }
  return out;
}

/// RMS departure of a state that the channels show from where they show it first, over the samples of the fit.
double departure_from_start(const ReconstructedStates& states, const Signals& signals, Eigen::Index first, Eigen::Index state) {
  double squares = 0.0, count = 0.0;
  for (Eigen::Index i = first; i < states.x.rows(); ++i) {
    if (!states.ok[i] || signals.held_out(i)) continue;
    const double departure = states.x(i, state) - states.x(first, state);
    squares += departure * departure;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

void Innovations::resize(std::size_t measurements, bool in_steps) {
  for (auto* all : {&e, &S}) all->assign(measurements, 0.0);
  for (auto* read : {&departures, &variances, &minus_log}) read->assign(in_steps ? measurements : 0, 0.0);
}

Reading Innovations::take(std::size_t place, double departure, double white_variance, double step) {
  const double variance = white_variance + std::pow(kWhiteOfSteps * step, 2);
  const Reading reading = step > 0.0 ? read_in_steps(departure, variance, step) : read_as_it_is(departure, variance);
  e[place] = reading.e;
  S[place] = reading.S;
  if (departures.empty()) return reading;
  departures[place] = departure;
  variances[place] = variance;
  minus_log[place] = reading.minus_log;
  return reading;
}

FilterData filter_data(const FilterModel& model, const Signals& signals, double integration, const IntegrationPlan* plan) {
  FilterData out;
  out.signals = &signals;
  out.inputs = input_table(signals, model.model);
  const std::size_t ny = model.model.outputs();
  out.read = std::make_shared<const ReconstructedStates>(reconstruct_states(model.model, signals));
  const ReconstructedStates& states = *out.read;
  const auto known = std::find(states.ok.begin(), states.ok.end(), true);
  if (known == states.ok.end())
    throw RunError("experiment '" + signals.name + "': no sample at which the states of system '" + model.model.system->spec().key +
                   "' can be read from the channels");
  const Eigen::Index shown_at = known - states.ok.begin();
  const auto& specs = model.model.state_specs;
  const auto is_known = [&](const StateSpec& state) { return state.initial == Initial::fixed && !signals.after_gap; };
  out.first = std::any_of(specs.begin(), specs.end(), is_known) ? 0 : shown_at;
  out.use.assign(signals.samples() * ny, SampleRole::none);
  for (std::size_t i = out.first; i < signals.samples(); ++i) {
    for (std::size_t o = 0; o < ny; ++o) {
      if (!std::isfinite(signals.measured[o].values[i])) continue;
      out.use[i * ny + o] = i < signals.exclude ? SampleRole::update : signals.held_out(i) ? SampleRole::validation : SampleRole::counted;
    }
  }
  out.steps = model.steps;
  out.input_departures = departures_of_inputs(out);
  out.start = states.x.row(shown_at).transpose();
  out.covariance = Eigen::MatrixXd::Zero(model.model.states(), model.model.states());
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const Eigen::Index state = i;
    if (is_known(specs[i])) {
      out.start[state] = specs[i].start;
      continue;
    }
    const double departure = states.shown[state] ? departure_from_start(states, signals, shown_at, state) : 0.0;
    out.covariance(state, state) = std::pow(departure > 0.0 ? departure : specs[i].scale, 2);
  }
  begin_own_states(model, out);
  Stepper stepper(model.model);
  out.inputs.plan = plan != nullptr ? *plan : plan_along({stepper, signals, out.inputs}, states.x, integration);
  return out;
}

void FilterJacobian::add_information(Eigen::MatrixXd& lower) const {
  if (J.rows() > 0) lower.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose());
}

std::size_t end_of_fit(const FilterData& data) {
  const auto enters = [](SampleRole role) { return role == SampleRole::counted || role == SampleRole::update; };
  const std::size_t outputs = data.signals->measured.size();
  const auto last = std::find_if(data.use.rbegin(), data.use.rend(), enters);
  return outputs == 0 ? 0 : (static_cast<std::size_t>(data.use.rend() - last) + outputs - 1) / outputs;
}

FilterData filter_data_like(const FilterModel& model, const FilterData& data) {
  FilterData out = data;
  out.steps = model.steps;
  const Eigen::Index system = model.model.system_states(), all = model.model.states();
  out.start = Eigen::VectorXd::Zero(all);
  out.covariance = Eigen::MatrixXd::Zero(all, all);
  out.start.head(system) = data.start.head(system);
  out.covariance.topLeftCorner(system, system) = data.covariance.topLeftCorner(system, system);
  begin_own_states(model, out);
  return out;
}

FilterRunner::FilterRunner(const FilterModel& model, bool derivatives)
    : model_(&model), own_(derivatives ? model.model : all_fixed(model.model)), stepper_(own_) {}

void FilterRunner::set_parameters(const std::vector<double>& values) { stepper_.evaluator().set_parameters(values.data()); }

bool FilterRunner::run(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, const FilterRunOptions& options) {
  const int n = stepper_.states(), ny = stepper_.evaluator().outputs();
  resize(trace, n, ny, data.signals->samples(), !data.steps.empty());
  if (!options.held_out) trace.end = end_of_fit(data);
  if (options.keep_P) trace.P.assign(trace.samples * n * (n + 2 * ny), 0.0);
  const FilterPassInput input{*model_, data, noise, options};
  return with_filter_size(n, ny, [&]<int M, int NY>() { return FilterPass<M, NY>(input, stepper_, trace).run(); });
}

bool FilterRunner::run_gated(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, std::vector<std::size_t>& rejected) {
  rejected.clear();
  return run(data, noise, trace, {.rejected = &rejected});
}

}  // namespace misfit
