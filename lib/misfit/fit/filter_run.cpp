#include "misfit/fit/filter_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/fit/kalman.h"

namespace misfit {
namespace {

constexpr double log_two_pi = 1.8378770664093453;

using ConstMap = Eigen::Map<const RowMatrix>;

/// Discretisations by step length: recordings have few distinct ones.
class NoiseSteps {
 public:
  explicit NoiseSteps(const FilterNoise& noise) : noise_(noise) {}
  const NoiseStep& at(double h) {
    if (!(std::abs(h - last_) <= 1e-9 * h)) {
      step_ = discretise(noise_, h);
      last_ = h;
    }
    return step_;
  }

 private:
  const FilterNoise& noise_;
  double last_ = -1.0;
  NoiseStep step_;
};

template <int M, int NY>
void start(const FilterModel& model, const FilterData& data, const FilterNoise& noise, Kalman<M, NY>& kalman) {
  for (Eigen::Index i = 0; i < data.scale.size(); ++i) kalman.P(i, i) = data.scale[i] * data.scale[i];
  for (int f : model.force_states) kalman.P(f, f) = noise.force * noise.force;
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    const auto at = static_cast<Eigen::Index>(2 * o);
    kalman.G(at, at) = kalman.G(at + 1, at + 1) = noise.channels[o].jitter * noise.channels[o].jitter;
  }
}

void resize(FilterTrace& trace, int n, int ny, std::size_t samples, bool keep_P) {
  trace.n = n;
  trace.ny = ny;
  trace.samples = samples;
  const auto N = static_cast<std::size_t>(n), NY = static_cast<std::size_t>(ny);
  trace.Phi.assign(samples * N * N, 0.0);
  trace.H.assign(samples * NY * N, 0.0);
  trace.z.assign(samples * NY, 0.0);
  trace.moved.assign(samples * N, 0.0);
  trace.predicted.assign(samples * N, 0.0);
  trace.K.assign(samples * NY * N, 0.0);
  trace.Kj.assign(samples * NY * 2 * NY, 0.0);
  trace.e.assign(samples * NY, 0.0);
  trace.S.assign(samples * NY, 0.0);
  trace.y.assign(samples * NY, std::nan(""));
  trace.y_variance.assign(samples * NY, std::nan(""));
  trace.P.assign(keep_P ? samples * N * (N + 2 * NY) : 0, 0.0);
  trace.finite = false;
  trace.loglik = trace.validation_loglik = 0.0;
  trace.counted = trace.validated = 0;
}

/// ∂(state)/∂θ with the gains held.
struct Sensitivities {
  RowMatrix model, jitter, work;
  Eigen::RowVectorXd row;
  Sensitivities(int n, int ny, int columns)
      : model(RowMatrix::Zero(n, columns)), jitter(RowMatrix::Zero(2 * ny, columns)), work(n, columns), row(columns) {}
};

}  // namespace

FilterData filter_data(const FilterModel& model, const Signals& signals) {
  FilterData out;
  out.signals = &signals;
  out.inputs = input_table(signals, model.model.inputs());
  const auto ny = static_cast<std::size_t>(model.model.outputs());
  const ReconstructedStates states = reconstruct_states(model.model, signals);
  const auto known = std::find(states.ok.begin(), states.ok.end(), true);
  if (known == states.ok.end() || std::none_of(states.shown.begin(), states.shown.end(), [](bool shown) { return shown; }))
    throw RunError("experiment '" + signals.name + "': no sample at which the states of system '" + model.model.system->spec().key +
                   "' can be read from the channels");
  out.first = static_cast<std::size_t>(known - states.ok.begin());
  out.use.assign(signals.samples() * ny, Use::none);
  for (std::size_t i = out.first; i < signals.samples(); ++i) {
    for (std::size_t o = 0; o < ny; ++o) {
      if (!std::isfinite(signals.measured[o].values[i])) continue;
      out.use[i * ny + o] = i < signals.exclude ? Use::update : signals.held_out(i) ? Use::validation : Use::counted;
    }
  }
  out.start = states.x.row(static_cast<Eigen::Index>(out.first)).transpose();
  out.scale = Eigen::VectorXd::Zero(model.model.states());
  const auto& specs = model.model.system->spec().states;
  for (std::size_t i = 0; i < specs.size(); ++i) out.scale[static_cast<Eigen::Index>(i)] = specs[i].scale;
  for (int f : model.force_states) out.start[f] = 0.0;
  return out;
}

FilterData filter_data_like(const FilterModel& model, const FilterData& data) {
  FilterData out = data;
  const Eigen::Index system = model.model.system_states(), all = model.model.states();
  out.start = out.scale = Eigen::VectorXd::Zero(all);
  out.start.head(system) = data.start.head(system);
  out.scale.head(system) = data.scale.head(system);
  for (Eigen::Index i = system; i < all; ++i) out.start[i] = model.model.own_states[static_cast<std::size_t>(i - system)].initial;
  for (int f : model.force_states) out.start[f] = 0.0;
  return out;
}

FilterRunner::FilterRunner(const FilterModel& model, bool derivatives)
    : model_(&model), own_(derivatives ? model.model : all_fixed(model.model)), stepper_(own_) {}

void FilterRunner::set_parameters(const std::vector<double>& values) { stepper_.evaluator().set_parameters(values.data()); }

bool FilterRunner::run(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, FilterJacobian* jacobian, bool keep_P) {
  const int n = stepper_.states(), ny = stepper_.evaluator().outputs();
  if (n == 6 && ny == 2) return run_as<6, 2>(data, noise, trace, jacobian, keep_P);
  if (n == 3 && ny == 1) return run_as<3, 1>(data, noise, trace, jacobian, keep_P);
  return run_as<Eigen::Dynamic, Eigen::Dynamic>(data, noise, trace, jacobian, keep_P);
}

template <int M, int NY>
bool FilterRunner::run_as(const FilterData& data, const FilterNoise& noise, FilterTrace& trace, FilterJacobian* jacobian, bool keep_P) {
  const Signals& signals = *data.signals;
  Evaluator& evaluator = stepper_.evaluator();
  const int n = stepper_.states(), ny = evaluator.outputs(), columns = evaluator.columns();
  const auto N = static_cast<std::size_t>(n), NY_ = static_cast<std::size_t>(ny);
  resize(trace, n, ny, signals.samples(), keep_P);
  Kalman<M, NY> kalman(n, ny);
  start(*model_, data, noise, kalman);
  NoiseSteps steps(noise);
  Sensitivities s(n, ny, jacobian != nullptr ? columns : 0);
  if (jacobian != nullptr) {
    const auto rows = static_cast<Eigen::Index>(std::count(data.use.begin(), data.use.end(), Use::counted));
    jacobian->J.resize(rows, columns);
    jacobian->r.resize(rows);
    jacobian->index.clear();
  }
  std::vector<double> D(N * kRowStride), O((NY_ + 1) * kRowStride);
  Slots slots;
  std::array<double, kMaxStates> x{}, speed{};
  std::array<double, kMaxOutputs + 1> y{};
  std::copy_n(data.start.data(), n, x.begin());
  stepper_.prepare(x.data(), data.inputs.at(data.first), signals.t[data.first]);
  typename Kalman<M, NY>::StateVector a = Kalman<M, NY>::StateVector::Zero(n);
  for (std::size_t k = data.first; k < signals.samples(); ++k) {
    std::copy_n(x.begin(), n, trace.predicted.begin() + static_cast<std::ptrdiff_t>(k * N));
    if (keep_P) {
      Eigen::Map<RowMatrix> joint(trace.P.data() + k * N * (N + 2 * NY_), n, n + 2 * ny);
      joint.leftCols(n) = kalman.P;
      joint.rightCols(2 * ny) = kalman.C;
    }
    slots.clear();
    evaluator.linearise_outputs(x.data(), data.inputs.at(k), signals.t[k], slots, y.data(), O.data());
    const double shift = y[NY_];
    if (evaluator.shifts_time()) evaluator.rates(x.data(), data.inputs.at(k), signals.t[k], speed.data());
    kalman.x.setZero();
    std::array<double, kMaxOutputs> motion{};  // of each output over time: a reading taken `shift` later sees it
    for (int o = 0; o < ny; ++o) {
      const double* row = O.data() + static_cast<std::ptrdiff_t>(o) * kRowStride;
      const std::size_t at = k * NY_ + static_cast<std::size_t>(o);
      const auto channel = static_cast<std::size_t>(o);
      for (int i = 0; i < n; ++i) a[i] = row[i];
      if (evaluator.shifts_time()) {
        for (int i = 0; i < n; ++i) motion[channel] += row[i] * speed[static_cast<std::size_t>(i)];
        y[channel] += motion[channel] * shift;
      }
      Eigen::Map<Eigen::VectorXd>(trace.H.data() + at * N, n) = a;
      trace.y[at] = y[channel] + kalman.j[2 * o];
      trace.y_variance[at] = kalman.variance(a, o, noise.channels[channel].white);
    }
    for (int o = 0; o < ny; ++o) {
      const double* row = O.data() + static_cast<std::ptrdiff_t>(o) * kRowStride;
      const std::size_t at = k * NY_ + static_cast<std::size_t>(o);
      const auto channel = static_cast<std::size_t>(o);
      const Use use = data.use[at];
      if (use == Use::none) continue;
      a = Eigen::Map<const Eigen::VectorXd>(trace.H.data() + at * N, n);
      const double S = kalman.variance(a, o, noise.channels[channel].white);
      const double z = signals.measured[channel].values[k] - y[channel];
      const double innovation = z - a.dot(kalman.x) - kalman.j[2 * o];
      if (!(S > 0.0) || !std::isfinite(innovation)) {
        trace.failed_at = k;
        return false;
      }
      trace.z[at] = z;
      trace.e[at] = innovation;
      trace.S[at] = S;
      const double log_density = -0.5 * (log_two_pi + std::log(S) + innovation * innovation / S);
      if (use == Use::counted) {
        trace.loglik += log_density;
        ++trace.counted;
      } else if (use == Use::validation) {
        trace.validation_loglik += log_density;
        ++trace.validated;
      }
      kalman.update(innovation, S);
      Eigen::Map<Eigen::VectorXd>(trace.K.data() + at * N, n) = kalman.gain;
      Eigen::Map<Eigen::VectorXd>(trace.Kj.data() + at * 2 * NY_, 2 * ny) = kalman.gain_jitter;
      if (jacobian == nullptr) continue;
      s.row.noalias() = a.transpose() * s.model;
      s.row += s.jitter.row(2 * o);
      for (int c = 0; c < slots.count(); ++c) s.row[slots.column(c)] += row[n + c];
      if (evaluator.shifts_time()) {
        const double* by_shift = O.data() + static_cast<std::ptrdiff_t>(ny) * kRowStride;
        for (int c = 0; c < slots.count(); ++c) s.row[slots.column(c)] += motion[channel] * by_shift[n + c];
      }
      if (use == Use::counted) {
        const auto r = static_cast<Eigen::Index>(jacobian->index.size());
        const double whiten = 1.0 / std::sqrt(S);
        jacobian->J.row(r) = whiten * s.row;
        jacobian->r[r] = -whiten * innovation;
        jacobian->index.push_back(at);
      }
      s.model.noalias() -= kalman.gain * s.row;
      s.jitter.noalias() -= kalman.gain_jitter * s.row;
    }
    for (int i = 0; i < n; ++i) {
      trace.moved[k * N + static_cast<std::size_t>(i)] = kalman.x[i];
      x[static_cast<std::size_t>(i)] += kalman.x[i];
    }
    if (k + 1 == signals.samples()) break;
    const Interval interval{signals.t[k], signals.t[k + 1], data.inputs.at(k), data.inputs.at(k + 1)};
    if (!stepper_.step_linear(x.data(), interval, slots, D.data())) {
      trace.failed_at = k;
      return false;
    }
    const Eigen::Map<const Eigen::Matrix<double, M, M, M == 1 ? Eigen::ColMajor : Eigen::RowMajor>, 0, Eigen::OuterStride<>> phi(
        D.data(), n, n, Eigen::OuterStride<>(kRowStride));
    Eigen::Map<RowMatrix>(trace.Phi.data() + k * N * N, n, n) = phi;
    const NoiseStep& noise_step = steps.at(interval.t1 - interval.t0);
    kalman.predict(phi, noise_step, model_->kind, model_->force_states);
    if (jacobian == nullptr) continue;
    s.work.noalias() = phi * s.model;
    for (int i = 0; i < n; ++i) {
      const double* row = D.data() + static_cast<std::ptrdiff_t>(i) * kRowStride + n;
      for (int c = 0; c < slots.count(); ++c) s.work(i, slots.column(c)) += row[c];
    }
    s.model.swap(s.work);
    for (int o = 0; o < ny; ++o) {
      const auto& p = noise_step.jitter[static_cast<std::size_t>(o)].phi;
      s.row = s.jitter.row(2 * o);
      s.jitter.row(2 * o) = p[0] * s.row + p[1] * s.jitter.row(2 * o + 1);
      s.jitter.row(2 * o + 1) = p[2] * s.row + p[3] * s.jitter.row(2 * o + 1);
    }
  }
  trace.finite = std::isfinite(trace.loglik);
  return trace.finite;
}

namespace {

template <int M, int NY>
void run_linear_as(const FilterModel& model, const FilterData& data, const FilterTrace& trace, const FilterNoise& noise,
                   std::vector<double>& e, std::vector<double>& S) {
  const int n = trace.n, ny = trace.ny;
  const auto N = static_cast<std::size_t>(n), NY_ = static_cast<std::size_t>(ny);
  const std::vector<double>& t = data.signals->t;
  e.assign(trace.samples * NY_, 0.0);
  S.assign(trace.samples * NY_, 0.0);
  Kalman<M, NY> kalman(n, ny);
  start(model, data, noise, kalman);
  NoiseSteps steps(noise);
  typename Kalman<M, NY>::StateVector a = Kalman<M, NY>::StateVector::Zero(n), moved = a, shifted = a;
  typename Kalman<M, NY>::StateMatrix phi = Kalman<M, NY>::StateMatrix::Zero(n, n);
  const double old_time = model.model.parameters[static_cast<std::size_t>(model.time_parameter)].value;
  for (std::size_t k = data.first; k < trace.samples; ++k) {
    for (int o = 0; o < ny; ++o) {
      const std::size_t at = k * NY_ + static_cast<std::size_t>(o);
      if (data.use[at] == Use::none) continue;
      a = Eigen::Map<const Eigen::VectorXd>(trace.H.data() + at * N, n);
      S[at] = kalman.variance(a, o, noise.channels[static_cast<std::size_t>(o)].white);
      e[at] = trace.z[at] - a.dot(kalman.x) - kalman.j[2 * o];
      kalman.update(e[at], S[at]);
    }
    if (k + 1 == trace.samples) break;
    phi = ConstMap(trace.Phi.data() + k * N * N, n, n);
    const double h = t[k + 1] - t[k];
    // The force's own response with the new correlation time, to first order of the step in the rest of the system.
    const double decay = std::exp(-h / noise.force_time) / std::exp(-h / old_time);
    const double share = noise.force_time * std::expm1(-h / noise.force_time) / (old_time * std::expm1(-h / old_time));
    shifted.setZero();  // of the reference itself: its force decays at another rate
    for (int f : model.force_states) {
      const std::size_t at = k * N + static_cast<std::size_t>(f);
      const double force = trace.predicted[at] + trace.moved[at];
      for (int i = 0; i < n; ++i) {
        const double change = phi(i, f) * ((i == f ? decay : share) - 1.0);
        shifted[i] += change * force;
        phi(i, f) += change;
      }
    }
    moved = kalman.x - Eigen::Map<const Eigen::VectorXd>(trace.moved.data() + k * N, n);
    kalman.predict(phi, steps.at(h), model.kind, model.force_states);
    kalman.x.noalias() = phi * moved + shifted;
  }
}

}  // namespace

void run_linear(const FilterModel& model, const FilterData& data, const FilterTrace& trace, const FilterNoise& noise,
                std::vector<double>& e, std::vector<double>& S) {
  if (trace.n == 6 && trace.ny == 2) {
    run_linear_as<6, 2>(model, data, trace, noise, e, S);
  } else if (trace.n == 3 && trace.ny == 1) {
    run_linear_as<3, 1>(model, data, trace, noise, e, S);
  } else {
    run_linear_as<Eigen::Dynamic, Eigen::Dynamic>(model, data, trace, noise, e, S);
  }
}

double minus_loglik(const FilterData& data, const std::vector<double>& e, const std::vector<double>& S) {
  double sum = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (data.use[i] == Use::counted) sum += 0.5 * (log_two_pi + std::log(S[i]) + e[i] * e[i] / S[i]);
  }
  return sum;
}

namespace {

/// Backward over [model | jitter]: r, what readings from this sample on say of the predicted state, and V, its covariance [DK].
class Backward {
 public:
  Backward(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise, bool variances)
      : trace_(trace),
        data_(data),
        steps_(noise),
        variances_(variances),
        n_(trace.n),
        ny_(trace.ny),
        r(Eigen::VectorXd::Zero(n_ + 2 * ny_)),
        V(Eigen::MatrixXd::Zero(n_ + 2 * ny_, n_ + 2 * ny_)),
        transition_(V),
        gain_(r),
        row_(r) {}

  void sample(std::size_t k) {
    const auto N = static_cast<std::size_t>(n_), NY = static_cast<std::size_t>(ny_);
    if (k + 1 < trace_.samples) {
      transition_.topLeftCorner(n_, n_) = ConstMap(trace_.Phi.data() + k * N * N, n_, n_);
      const NoiseStep& step = steps_.at(data_.signals->t[k + 1] - data_.signals->t[k]);
      for (Eigen::Index o = 0; o < ny_; ++o) {
        const auto& p = step.jitter[static_cast<std::size_t>(o)].phi;
        transition_.block(n_ + 2 * o, n_ + 2 * o, 2, 2) << p[0], p[1], p[2], p[3];
      }
      r = (transition_.transpose() * r).eval();
      if (variances_) V = (transition_.transpose() * V * transition_).eval();
    }
    for (std::size_t o = NY; o-- > 0;) reading(k * NY + o, static_cast<Eigen::Index>(o));
  }

 private:
  void reading(std::size_t at, Eigen::Index o) {
    if (data_.use[at] == Use::none || !(trace_.S[at] > 0.0)) return;
    const auto N = static_cast<std::size_t>(n_), NY = static_cast<std::size_t>(ny_);
    gain_ << Eigen::Map<const Eigen::VectorXd>(trace_.K.data() + at * N, n_),
        Eigen::Map<const Eigen::VectorXd>(trace_.Kj.data() + at * 2 * NY, 2 * ny_);
    row_.setZero();
    row_.head(n_) = Eigen::Map<const Eigen::VectorXd>(trace_.H.data() + at * N, n_);
    row_[n_ + 2 * o] = 1.0;
    const double whiten = 1.0 / trace_.S[at];
    const bool counts = variances_ || data_.use[at] == Use::counted;
    r += row_ * ((counts ? trace_.e[at] * whiten : 0.0) - gain_.dot(r));
    if (!variances_) return;
    const Eigen::VectorXd Vg = V * gain_;
    V += row_ * (row_.transpose() * (gain_.dot(Vg) + whiten)) - row_ * Vg.transpose() - Vg * row_.transpose();
  }

  const FilterTrace& trace_;
  const FilterData& data_;
  NoiseSteps steps_;
  bool variances_;
  Eigen::Index n_, ny_;

 public:
  Eigen::VectorXd r;
  Eigen::MatrixXd V;

 private:
  Eigen::MatrixXd transition_;
  Eigen::VectorXd gain_, row_;
};

}  // namespace

RowMatrix adjoint_of(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise) {
  RowMatrix out = RowMatrix::Zero(static_cast<Eigen::Index>(trace.samples), trace.n);
  Backward backward(trace, data, noise, false);
  for (std::size_t k = trace.samples; k-- > data.first;) {
    backward.sample(k);
    out.row(static_cast<Eigen::Index>(k)) = backward.r.head(trace.n).transpose();
  }
  return out;
}

Smoothing smooth_states(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise) {
  const Eigen::Index n = trace.n, all = n + 2 * trace.ny;
  const auto N = static_cast<std::size_t>(n);
  Smoothing out;
  out.x = out.variance = RowMatrix::Zero(static_cast<Eigen::Index>(trace.samples), n);
  Backward backward(trace, data, noise, true);
  for (std::size_t k = trace.samples; k-- > data.first;) {
    backward.sample(k);
    const auto i = static_cast<Eigen::Index>(k);
    const ConstMap joint(trace.P.data() + k * N * static_cast<std::size_t>(all), n, all);
    out.x.row(i) = (Eigen::Map<const Eigen::VectorXd>(trace.predicted.data() + k * N, n) + joint * backward.r).transpose();
    const RowMatrix turned = joint * backward.V;
    for (Eigen::Index j = 0; j < n; ++j) out.variance(i, j) = std::max(joint(j, j) - turned.row(j).dot(joint.row(j)), 0.0);
  }
  return out;
}

}  // namespace misfit
