#include "misfit/diagnose/score.h"

#include <array>
#include <cmath>

#include "misfit/model/effect.h"

namespace misfit {
namespace {

/// A constant on a port: its strength's column is what a unit force over one step does.
struct Probe {
  static constexpr const char* formula = "F = unit";
  static constexpr const char* symbols = "unit force [port]";
  static constexpr const char* valid = "always";
  static constexpr const char* size = "1";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "-";
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {{"unit", CoefficientKind::strength, 0.0, "{port}", -1e12, 1e12, 1.0, "force"}};
  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0];
  }
  static std::vector<Example> examples() { return {{{}, {}, {2.0}, {}, 0.0, {2.0}, {}, "by hand"}}; }
};

/// The forced model with a probe on every dynamic port; only the probes are free, in the order of the ports.
Model probed(const FilterEstimate& estimate) {
  static const EffectOf<Probe> effect("probe");
  Model model = all_fixed(estimate.forced.model);
  const auto& ports = model.system->spec().dynamic_ports;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    BoundEffect bound;
    bound.effect = &effect;
    bound.name = "probe_" + ports[p].name;
    bound.ports = {static_cast<int>(p)};
    bound.coefficients = {{static_cast<int>(model.parameters.size()), -1}};
    bound.first_state = static_cast<int>(model.own_states.size());
    Parameter unit{bound.name, ports[p].unit, "", 0.0, -1e12, 1e12, 1.0, true};
    model.parameters.push_back(unit);
    model.effects.push_back(std::move(bound));
  }
  return model;
}

}  // namespace

ScoreTest::ScoreTest(const FilterEstimate& estimate) {
  Eigen::Index rows = 0;
  for (const auto& jacobian : estimate.jacobians) rows += jacobian.r.size();
  const std::vector<int> free = estimate.model.free_parameters();
  const auto columns = static_cast<Eigen::Index>(free.size());
  J_.resize(rows, columns);
  r_.resize(rows);
  Eigen::Index at = 0;
  for (const auto& jacobian : estimate.jacobians) {
    J_.middleRows(at, jacobian.r.size()) = jacobian.J;
    r_.segment(at, jacobian.r.size()) = jacobian.r;
    at += jacobian.r.size();
  }
  any_ = columns > 0;
  if (!any_) return;
  NormalEquations sums;
  sums.theta = Eigen::VectorXd::Zero(columns);
  for (Eigen::Index c = 0; c < columns; ++c)
    sums.theta[c] = estimate.model.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(c)])].value;
  set_priors(estimate.model, sums);
  Eigen::MatrixXd information = J_.transpose() * J_;
  gradient_ = -J_.transpose() * r_;
  information.diagonal() += sums.prior_precision;
  gradient_ -= sums.prior_precision.cwiseProduct(sums.theta - sums.prior_mean);
  for (const auto& p : estimate.penalties) {
    const Eigen::Index size = p.omega.rows();
    information.block(p.first, p.first, size, size) += p.lambda * p.omega;
    gradient_.segment(p.first, size) -= p.lambda * (p.omega * sums.theta.segment(p.first, size));
  }
  information_.compute(information);
}

Eigen::VectorXd ScoreTest::adjusted_step(const Eigen::MatrixXd& C, const Eigen::VectorXd& amplitude) const {
  if (!any_) return {};
  return information_.solve(gradient_ - J_.transpose() * (C * amplitude));
}

Eigen::MatrixXd ScoreTest::projected(const Eigen::MatrixXd& C) const {
  if (!any_) return C;
  return C - J_ * information_.solve(J_.transpose() * C);
}

namespace {

/// Columns that the free parameters do not describe already; `independent`: the least share of one that they leave.
std::vector<Eigen::Index> known_columns(const Eigen::MatrixXd& V, const Eigen::VectorXd& own, double& independent) {
  constexpr double rounding = 1e-8;
  std::vector<Eigen::Index> known;
  independent = 1.0;
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    if (!(own[i] > 0.0) || !std::isfinite(V(i, i))) continue;
    const double share = V(i, i) / own[i];
    independent = std::min(independent, share);
    if (share > rounding) known.push_back(i);
  }
  if (known.empty()) independent = 0.0;
  return known;
}

/// sᵀ V⁻¹ s with amplitudes V⁻¹ s over the known columns, in the directions of the correlation matrix that are more than rounding.
void solve_score(const Eigen::MatrixXd& V, const Eigen::VectorXd& s, const std::vector<Eigen::Index>& known, ScoreResult& out) {
  const Eigen::MatrixXd A = V(known, known);
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  const Eigen::VectorXd turned = eigen.eigenvectors().transpose() * (scale.asDiagonal() * Eigen::VectorXd(s(known)));
  Eigen::VectorXd amplitude = Eigen::VectorXd::Zero(A.rows()), variance = Eigen::VectorXd::Zero(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    constexpr double known_direction = 1e-6;  // of the correlation matrix: below, columns are multiples of each other
    const double value = eigen.eigenvalues()[i];
    if (value < known_direction) continue;
    ++out.dof;
    out.chi2 += turned[i] * turned[i] / value;
    amplitude += eigen.eigenvectors().col(i) * (turned[i] / value);
    variance += eigen.eigenvectors().col(i).cwiseAbs2() / value;
  }
  out.amplitude(known) = scale.cwiseProduct(amplitude);
  out.sigma(known) = scale.cwiseProduct(variance.cwiseSqrt());
}

}  // namespace

ScoreResult ScoreTest::test(const Eigen::MatrixXd& C, const ColumnPriors* priors) const {
  ScoreResult out;
  out.amplitude = out.sigma = Eigen::VectorXd::Zero(C.cols());
  Eigen::MatrixXd V = C.transpose() * C;
  Eigen::VectorXd s = -C.transpose() * r_;
  const Eigen::VectorXd own = V.diagonal();
  if (any_) {
    const Eigen::MatrixXd cross = J_.transpose() * C;
    const Eigen::MatrixXd solved = information_.solve(cross);
    V -= cross.transpose() * solved;
    s -= solved.transpose() * gradient_;
  }
  if (priors != nullptr) {
    V.diagonal() += priors->precision;
    s += priors->precision.cwiseProduct(priors->mean);
  }
  const std::vector<Eigen::Index> known = known_columns(V, own, out.independent);
  if (!known.empty()) solve_score(V, s, known, out);
  return out;
}

ForceSensitivity::ForceSensitivity(const FilterEstimate& estimate) : estimate_(estimate) {
  const Model model = probed(estimate);
  Stepper stepper(model);
  Evaluator values(estimate.forced.model);
  ports_ = static_cast<int>(model.system->spec().dynamic_ports.size());
  const auto nq = static_cast<Eigen::Index>(model.system->spec().quantities.size());
  const int n = stepper.states();
  const auto N = static_cast<std::size_t>(n), NF = static_cast<std::size_t>(ports_);
  std::size_t all = 0;
  for (const auto& trace : estimate.traces) all += trace.samples;
  quantities_ = ahead_ = RowMatrix::Zero(static_cast<Eigen::Index>(all), nq);
  used_.assign(all, false);
  std::vector<double> D(N * kRowStride);
  Slots slots;
  std::array<double, kMaxStates> x{};
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    const Signals& signals = *data.signals;
    G_.emplace_back(trace.samples * N * NF, 0.0);
    times_.insert(times_.end(), signals.t.begin(), signals.t.end());
    prepare_at(stepper, signals, data.inputs, data.first, data.start.data());
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      for (std::size_t i = 0; i < N; ++i) x[i] = trace.predicted[k * N + i] + trace.correction[k * N + i];
      used_[offset + k] = true;
      values.quantities(x.data(), data.inputs.at(k), signals.t[k], quantities_.row(static_cast<Eigen::Index>(offset + k)).data());
      if (k + 1 == trace.samples) break;
      if (!stepper.step_linear(x.data(), interval_between(signals, data.inputs, k), slots, D.data())) break;
      values.quantities(x.data(), data.inputs.at(k + 1), signals.t[k + 1], ahead_.row(static_cast<Eigen::Index>(offset + k)).data());
      for (std::size_t i = 0; i < N; ++i) {
        for (int c = 0; c < slots.count(); ++c)
          G_.back()[(k * N + i) * NF + static_cast<std::size_t>(slots.column(c))] = D[i * kRowStride + N + static_cast<std::size_t>(c)];
      }
    }
    offset += trace.samples;
  }
}

Eigen::MatrixXd ForceSensitivity::columns(int port, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const {
  const Eigen::Index m = f.cols();
  Eigen::Index rows = 0;
  for (const auto& jacobian : estimate_.jacobians) rows += jacobian.r.size();
  RowMatrix out(rows, m);
  Eigen::Index row = 0;
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate_.traces.size(); ++e) {
    const FilterTrace& trace = estimate_.traces[e];
    const FilterData& data = estimate_.data[e];
    const auto N = static_cast<std::size_t>(trace.n), NY = static_cast<std::size_t>(trace.ny), NF = static_cast<std::size_t>(ports_);
    const Eigen::Index n = trace.n, ny = trace.ny;
    RowMatrix s = RowMatrix::Zero(n, m), jitter = RowMatrix::Zero(2 * ny, m), work(n, m);
    Eigen::RowVectorXd v(m), mean(m);
    double last_h = -1.0;
    NoiseStep noise;
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      for (std::size_t o = 0; o < NY; ++o) {
        const std::size_t at = k * NY + o;
        if (data.use[at] == SampleRole::none) continue;
        v.noalias() = Eigen::Map<const Eigen::RowVectorXd>(trace.H.data() + at * N, n) * s;
        v += jitter.row(2 * static_cast<Eigen::Index>(o));
        if (data.use[at] == SampleRole::counted) out.row(row++) = v / std::sqrt(trace.S[at]);
        s.noalias() -= Eigen::Map<const Eigen::VectorXd>(trace.K.data() + at * N, n) * v;
        jitter.noalias() -= Eigen::Map<const Eigen::VectorXd>(trace.Kj.data() + at * 2 * NY, 2 * ny) * v;
      }
      if (k + 1 == trace.samples) break;
      const double h = data.signals->t[k + 1] - data.signals->t[k];
      if (std::abs(h - last_h) > 1e-9 * h) {
        noise = discretise(estimate_.noise, h);
        last_h = h;
      }
      const auto sample = static_cast<Eigen::Index>(offset + k);
      mean = 0.5 * (f.row(sample) + ahead.row(sample));
      work.noalias() = Eigen::Map<const RowMatrix>(trace.Phi.data() + k * N * N, n, n) * s;
      for (Eigen::Index i = 0; i < n; ++i) {
        const double gain = G_[e][(k * N + static_cast<std::size_t>(i)) * NF + static_cast<std::size_t>(port)];
        if (gain != 0.0) work.row(i) += gain * mean;
      }
      s.swap(work);
      for (Eigen::Index o = 0; o < ny; ++o) {
        const auto& p = noise.jitter[static_cast<std::size_t>(o)].phi;
        v = jitter.row(2 * o);
        jitter.row(2 * o) = p[0] * v + p[1] * jitter.row(2 * o + 1);
        jitter.row(2 * o + 1) = p[2] * v + p[3] * jitter.row(2 * o + 1);
      }
    }
    offset += trace.samples;
  }
  return out;
}

Eigen::VectorXd ForceSensitivity::score_of_steps(int port) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(times_.size()));
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate_.traces.size(); ++e) {
    const FilterTrace& trace = estimate_.traces[e];
    const FilterData& data = estimate_.data[e];
    const auto N = static_cast<std::size_t>(trace.n), NF = static_cast<std::size_t>(ports_);
    const RowMatrix adjoint = adjoint_of(trace, data, estimate_.noise);
    for (std::size_t k = data.first; k + 1 < trace.samples; ++k) {
      double sum = 0.0;
      for (std::size_t i = 0; i < N; ++i)
        sum += G_[e][(k * N + i) * NF + static_cast<std::size_t>(port)] *
               adjoint(static_cast<Eigen::Index>(k + 1), static_cast<Eigen::Index>(i));
      out[static_cast<Eigen::Index>(offset + k)] = sum;
    }
    offset += trace.samples;
  }
  return out;
}

}  // namespace misfit
