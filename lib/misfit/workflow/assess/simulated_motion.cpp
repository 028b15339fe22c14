// Motions that the fitted model makes, put through the same measurement as the recorded one (lib/misfit/README.md, 6.1).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

#include "misfit/compare/motion_statistics.h"
#include "misfit/compare/noisy_run.h"
#include "misfit/core/stopwatch.h"
#include "misfit/inference/states.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"
#include "misfit/model/whole_steps.h"
#include "misfit/workflow/assess/assess.h"

namespace misfit {
namespace {

constexpr std::size_t runs = 199;  // if half of them fail, the smallest p-value is still 1/100

/// From the first sample that the filter runs at, without the samples that it rejected.
Signals as_filtered(const FilterData& data) {
  Signals out = *data.signals;
  const auto first = static_cast<std::ptrdiff_t>(data.first);
  const std::size_t channels = out.measured.size();
  for (std::size_t c = 0; c < channels; ++c) {
    auto& values = out.measured[c].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (data.use[i * channels + c] == SampleRole::none) values[i] = std::nan("");
    }
    values.erase(values.begin(), values.begin() + first);
  }
  for (auto& input : out.inputs) {
    if (!input.values.empty()) input.values.erase(input.values.begin(), input.values.begin() + first);  // empty: not needed
  }
  out.t.erase(out.t.begin(), out.t.begin() + first);
  return out;
}

bool is_input(const SystemSpec& spec, const std::string& name) {
  return std::any_of(spec.inputs.begin(), spec.inputs.end(), [&](const auto& input) { return input.name == name; });
}

/// The channels as read, and quantities at the states that the channels show.
std::vector<MotionPath> paths_of(const Model& model, const Signals& signals) {
  std::vector<MotionPath> out;
  for (const auto& channel : signals.measured) out.push_back({channel.name, channel.unit, channel.values});
  const SystemSpec& spec = model.system->spec();
  std::vector<std::size_t> places;
  for (const ComparedQuantity& w : spec.compared_quantities) {
    const auto found =
        std::find_if(spec.quantities.begin(), spec.quantities.end(), [&](const QuantitySpec& q) { return w.name == q.name; });
    const bool channel = std::any_of(out.begin(), out.end(), [&](const MotionPath& p) { return p.name == w.name; });
    if (found == spec.quantities.end() || channel || is_input(spec, w.name)) continue;
    places.push_back(found - spec.quantities.begin());
    out.push_back({w.name, found->unit, std::vector<double>(signals.samples(), std::nan("")), w.distribution_only});
  }
  if (places.empty()) return out;
  const ReconstructedStates states = reconstruct_states(model, signals);
  const InputTable inputs = input_table(signals, model);
  Evaluator evaluator(model);
  std::vector<double> q(spec.quantities.size());
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    if (!states.ok[i]) continue;
    evaluator.quantities(states.x.row(static_cast<Eigen::Index>(i)).data(), inputs.at(i), signals.t[i], q.data());
    for (std::size_t k = 0; k < places.size(); ++k) out[signals.measured.size() + k].values[i] = q[places[k]];
  }
  return out;
}

/// Noise of the channels as they were read in one experiment. The white noise of readings in whole steps has their rounding in it
/// (mark_rounding()), which is made again: where the motion is slow, it is not white. Where the model itself reads in steps: read().
std::vector<MeasurementNoise> measurement_noise(const FilterEstimate& estimate, const Signals& measured) {
  const std::vector<double> read_by_model = steps_of_outputs(estimate.model);
  std::vector<MeasurementNoise> out;
  for (std::size_t c = 0; c < measured.measured.size(); ++c) {
    const ChannelNoise& from = estimate.noise.channels[c];
    MeasurementNoise& own = out.emplace_back(from.white, from.coloured, from.coloured_frequency, from.coloured_damping);
    if (!read_by_model.empty() && read_by_model[c] > 0.0) continue;
    std::vector<double> known = measured.measured[c].values;
    std::erase_if(known, [](double v) { return !std::isfinite(v); });
    if (known.empty()) continue;
    own.level = known.front();
    own.step = resolution_of(std::move(known));
    own.white = std::sqrt(std::max(from.white * from.white - own.step * own.step / 12.0, 0.0));
  }
  return out;
}

StochasticModel stochastic_model(const FilterEstimate& estimate, const Model& model, const std::vector<MeasurementNoise>& noise) {
  StochasticModel out;
  out.model = &model;
  const int own = model.states() - model.system_states();
  out.intensity.assign(own, 0.0);
  out.start_sigma.assign(own, 0.0);
  for (std::size_t i = 0; i < estimate.forced.force_states.size(); ++i) {
    const int place = estimate.forced.force_states[i] - model.system_states();
    const double force = estimate.noise.force_of(estimate.forced.force_group[i]);
    out.intensity[place] = force * std::sqrt(2.0 / estimate.noise.force_time);
    out.start_sigma[place] = force;
  }
  out.noise = noise;
  return out;
}

void note_gaps(const Signals& signals, SimulatedMotion& out) {
  std::size_t missing = 0, all = 0;
  for (const auto& channel : signals.measured) {
    all += channel.values.size();
    missing += std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isfinite(v); });
  }
  constexpr double min_share_to_report = 0.01;
  const double share = static_cast<double>(missing) / static_cast<double>(std::max<std::size_t>(all, 1));
  if (share > min_share_to_report) {
    out.notes.push_back(
        fmt::format("{:.1f} % of the samples of {} are missing, and the simulated motions miss the same times; if the "
                    "missing samples are the largest excursions, the measured distribution is too narrow",
                    100.0 * share, signals.name));
  }
}

/// The state at the first sample as all measurements give it: the channels alone show it with their noise, and a motion that is hardly
/// damped would carry that error to its end. Random forces are drawn anew.
std::vector<double> smoothed_start(const FilterEstimate& estimate, const FilterData& data) {
  const FilterModel& forced = estimate.forced;
  std::vector<double> out(data.start.begin(), data.start.end());
  out.resize(static_cast<std::size_t>(forced.model.states()), 0.0);
  FilterRunner runner(forced, false);
  runner.set_parameters(forced.model.values());
  FilterTrace trace;
  if (!runner.run(data, estimate.noise, trace, {.keep_P = true})) return out;
  const Eigen::VectorXd x = smooth_states(trace, data, estimate.noise).x.row(static_cast<Eigen::Index>(data.first));
  std::copy(x.begin(), x.end(), out.begin());
  for (const int force : forced.force_states) out[force] = 0.0;
  return out;
}

/// The rows at which a measured path is known, and their times: those of its sensor, whatever else is measured between. All where it is
/// known nowhere.
struct OwnRows {
  std::vector<std::size_t> rows;
  std::vector<double> t;
};

OwnRows own_rows_of(const MotionPath& measured, const std::vector<double>& t) {
  OwnRows out;
  for (std::size_t i = 0; i < measured.values.size(); ++i) {
    if (!std::isfinite(measured.values[i])) continue;
    out.rows.push_back(i);
    out.t.push_back(t[i]);
  }
  if (!out.rows.empty()) return out;
  out.rows.resize(t.size());
  std::iota(out.rows.begin(), out.rows.end(), std::size_t{0});
  out.t = t;
  return out;
}

/// A measured or simulated path at those rows, on an even grid: a lag of one sample is the usual step of its sensor.
MotionPath at_own_rows(const MotionPath& path, const OwnRows& own) {
  std::vector<double> values;
  for (const std::size_t i : own.rows) values.push_back(path.values[i]);
  return {path.name, path.unit, on_even_grid(own.t, values), path.spread_only};
}

/// Every strength without a sigma: at its bound, not distinguishable from 0.
bool no_force_is_seen(const Fit& fit) {
  return std::all_of(fit.force.begin(), fit.force.end(),
                     [](const auto& f) { return f.first == "correlation_time" || !(f.second.sigma > 0.0); });
}

/// The model of each run: parameters that the data know only so well would make a motion as far from the measured one as their sigmas,
/// which is no fault of the model. Drawn from their covariance where that is all there is: no random force is seen (it moves the motion by
/// more than that, and the bands would be wider than they are), no curves (what lies outside of what was visited is no motion to be
/// compared), and every parameter three sigmas from its bounds; else fixed at the estimate.
class DrawnModels {
 public:
  DrawnModels(const FilterEstimate& estimate, const Model& fixed, bool without_random_force)
      : fixed_(fixed), theta_(estimate.model.theta()) {
    const std::vector<int> free = estimate.model.free_parameters();
    if (!estimate.model.curves.empty() || free.empty() || estimate.covariance.rows() != theta_.size()) return;
    if (!without_random_force) return;
    constexpr double away = 3.0;  // sigmas
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Parameter& p = estimate.model.parameters[free[i]];
      const auto column = static_cast<Eigen::Index>(i);
      const double reach = away * std::sqrt(estimate.covariance(column, column));
      if (!(p.value - reach > p.lower) || !(p.value + reach < p.upper)) return;
      places_.push_back(fixed.find_parameter(p.name));
    }
    root_ = cholesky(estimate.covariance);
  }

  [[nodiscard]] bool is_drawn() const { return root_.has_value(); }

  [[nodiscard]] Model of_run(std::uint64_t seed) const {
    Model out = fixed_;
    if (!is_drawn()) return out;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXd z(theta_.size());
    for (double& value : z) value = normal(random);
    const Eigen::VectorXd drawn = theta_ + root_->triangularView<Eigen::Lower>() * z;
    for (std::size_t i = 0; i < places_.size(); ++i) out.parameters[places_[i]].value = drawn[static_cast<Eigen::Index>(i)];
    return out;
  }

 private:
  const Model& fixed_;
  Eigen::VectorXd theta_;
  std::vector<int> places_;
  std::optional<Eigen::MatrixXd> root_;
};

struct Experiment {
  Signals measured;
  std::vector<double> start;
  std::vector<MeasurementNoise> noise;
  std::vector<OwnRows> own;       ///< per path
  std::vector<MotionPath> paths;  ///< at these rows
  std::vector<MotionScales> scales;
  std::vector<std::vector<MotionNumbers>> simulated;  ///< run → path; empty: failed
};

Experiment experiment_of(const FilterWork& work, const FilterData& data) {
  Experiment e;
  e.measured = as_filtered(data);
  e.start = smoothed_start(*work.estimate, data);
  e.noise = measurement_noise(*work.estimate, e.measured);
  for (const MotionPath& path : paths_of(work.estimate->model, e.measured)) {
    const OwnRows& own = e.own.emplace_back(own_rows_of(path, e.measured.t));
    const MotionPath& there = e.paths.emplace_back(at_own_rows(path, own));
    e.scales.push_back(scales_of(there, usual_step(own.t)));
  }
  e.simulated.resize(runs);
  return e;
}

/// Channels as they are read: in whole steps, where they are.
void read(const Model& model, Signals& made) {
  for (std::size_t o = 0; o < made.measured.size(); ++o) {
    for (double& y : made.measured[o].values) y = as_read(model, static_cast<int>(o), y);
  }
}

/// `seed` of this run in this experiment, `of_run` of the run in all of them: one motion has one model.
std::vector<MotionNumbers> simulated_numbers(const FilterWork& work, const DrawnModels& models, std::uint64_t of_run, std::uint64_t seed,
                                             const Experiment& e) {
  std::vector<MotionNumbers> out;
  const Model model = models.of_run(of_run);
  std::optional<Signals> made = noisy_run(stochastic_model(*work.estimate, model, e.noise), e.measured, e.start, seed);
  if (!made) return out;
  read(work.estimate->model, *made);
  const std::vector<MotionPath> paths = paths_of(work.estimate->model, *made);
  for (std::size_t p = 0; p < paths.size(); ++p) out.push_back(motion_numbers(at_own_rows(paths[p], e.own[p]), e.scales[p]));
  return out;
}

/// Runs that stayed among the finite numbers in every experiment: run j of all experiments is one motion.
std::vector<std::size_t> runs_made(const std::vector<Experiment>& experiments) {
  std::vector<std::size_t> out;
  for (std::size_t run = 0; run < runs; ++run) {
    const bool all = std::all_of(experiments.begin(), experiments.end(), [&](const Experiment& e) { return !e.simulated[run].empty(); });
    if (all) out.push_back(run);
  }
  return out;
}

void compare_experiment(const Experiment& e, const std::vector<std::size_t>& made, SimulatedMotion& out, MotionDistances& distances) {
  for (std::size_t p = 0; p < e.paths.size(); ++p) {
    std::vector<MotionNumbers> numbers;
    for (const std::size_t run : made) numbers.push_back(e.simulated[run][p]);
    out.series.push_back(compare_motion(e.paths[p], e.scales[p], numbers, distances));
    out.series.back().experiment = e.measured.name;
  }
}

/// All experiments together are one motion, with one rank among those simulated.
void compare_all(const std::vector<Experiment>& experiments, SimulatedMotion& out) {
  const std::vector<std::size_t> made = runs_made(experiments);
  out.failed = runs - made.size();
  if (2 * made.size() < runs) {
    out.notes.push_back(
        fmt::format("of {} simulated motions {} diverged: the fitted model does not hold outside the operating range, and "
                    "nothing is compared",
                    runs, out.failed));
    return;
  }
  MotionDistances distances;
  for (const auto& e : experiments) compare_experiment(e, made, out, distances);
  if (!distances.empty()) out.p_value = overall_p_value(distances);
}

}  // namespace

SimulatedMotion simulated_motion(const FilterWork& work, unsigned long seed, int threads, const ProgressFn& progress) {
  const Stopwatch clock;
  SimulatedMotion out;
  out.method = work.fit.method;
  out.runs = runs;
  const FilterEstimate& estimate = *work.estimate;
  Model model = all_fixed(estimate.forced.model);
  for (const auto& p : estimate.model.parameters) model.parameters[model.find_parameter(p.name)].value = p.value;
  model.parameters[estimate.forced.time_parameter].value = estimate.noise.force_time;
  const DrawnModels models(estimate, model, no_force_is_seen(work.fit));
  std::vector<Experiment> experiments;
  for (const auto& data : estimate.data) experiments.push_back(experiment_of(work, data));
  run_jobs(
      runs * experiments.size(), threads,
      [&](std::size_t job) {
        Experiment& e = experiments[job / runs];
        const std::uint64_t first = std::uint64_t{seed} << 32U;
        e.simulated[job % runs] = simulated_numbers(work, models, first + runs * experiments.size() + job % runs, first + job, e);
      },
      progress);
  for (const auto& e : experiments) note_gaps(e.measured, out);
  compare_all(experiments, out);
  conclude_motion(out);
  out.notes.emplace_back(
      models.is_drawn() ? "each simulated motion has parameters drawn from their covariance; initial states are fixed at their estimates"
                        : "the bands do not include the uncertainty of parameters and initial states, which are fixed at their estimates");
  out.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
