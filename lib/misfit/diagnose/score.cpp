#include "misfit/diagnose/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/watch.h"
#include "misfit/math/decompositions.h"
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
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  static constexpr CoefficientSpec coefficients[] = {{.name = "unit", .unit = "{port}", .lower = -1e12, .upper = 1e12, .doc = "force"}};
  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0];
  }
  static std::vector<Example> examples() { return {{.coefficients = {2.0}, .ports = {2.0}, .source = "by hand"}}; }
};

void add_probe(PortKind kind, int port, const PortSpec& spec, Model& model) {
  static const EffectOf<Probe> effect("probe");
  BoundEffect bound;
  bound.effect = &effect;
  bound.name = "probe_" + spec.name;
  bound.kind = kind;
  bound.ports = {port};
  bound.coefficients = {{int_size(model.parameters), -1}};
  bound.first_state = int_size(model.own_states);
  Parameter unit{.name = bound.name, .unit = spec.unit, .doc = "", .lower = -1e12, .upper = 1e12, .free = true};
  model.parameters.push_back(unit);
  model.effects.push_back(std::move(bound));
}

/// The forced model with a probe on every dynamic port, then on these quantity ports; only the probes are free, in that order.
Model probed(const FilterEstimate& estimate, const std::vector<int>& parameters) {
  Model model = all_fixed(estimate.forced.model);
  const SystemSpec& system = model.system->spec();
  for (int p = 0; p < int_size(system.dynamic_ports); ++p) add_probe(PortKind::dynamic, p, system.dynamic_ports[p], model);
  for (const int p : parameters) add_probe(PortKind::quantity, p, system.quantity_ports[p], model);
  return model;
}

}  // namespace

ScoreTest::ScoreTest(const FilterEstimate& estimate) {
  const Eigen::Index rows = counted_rows(estimate);
  const Eigen::VectorXd theta = estimate.model.theta();
  J_.resize(rows, theta.size());
  r_.resize(rows);
  Eigen::Index at = 0;
  for (const auto& jacobian : estimate.jacobians) {
    J_.middleRows(at, jacobian.r.size()) = jacobian.J;
    r_.segment(at, jacobian.r.size()) = jacobian.r;
    at += jacobian.r.size();
  }
  has_parameters_ = theta.size() > 0;
  if (!has_parameters_) return;
  Eigen::MatrixXd information = J_.transpose() * J_;
  estimate.regularised_prior(information.diagonal()).add_precision(information);
  gradient_ = -J_.transpose() * r_ + estimate.prior().gradient(theta);
  information_.compute(information);
}

Eigen::VectorXd ScoreTest::adjusted_step(const Eigen::MatrixXd& C, const Eigen::VectorXd& amplitude) const {
  if (!has_parameters_) return {};
  return information_.solve(gradient_ - J_.transpose() * (C * amplitude));
}

Eigen::MatrixXd ScoreTest::projected(const Eigen::MatrixXd& C) const {
  if (!has_parameters_) return C;
  return C - J_ * information_.solve(J_.transpose() * C);
}

namespace {

/// Columns that are not linear combinations of the free parameters' columns; `independent`: the smallest 1 − R² among all.
/// `unadjusted`: diagonal of CᵀC.
std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& V, const Eigen::VectorXd& unadjusted, double& independent) {
  constexpr double rounding = 1e-8;
  std::vector<Eigen::Index> columns;
  independent = 1.0;
  for (Eigen::Index i = 0; i < unadjusted.size(); ++i) {
    if (!(unadjusted[i] > 0.0) || !std::isfinite(V(i, i))) continue;
    const double share = V(i, i) / unadjusted[i];
    independent = std::min(independent, share);
    if (share > rounding) columns.push_back(i);
  }
  if (columns.empty()) independent = 0.0;
  return columns;
}

/// Combinations of columns that do not correlate, and the information of each.
struct Combinations {
  Eigen::MatrixXd vectors;  ///< a column each
  Eigen::VectorXd values;
};

/// Those of which the data see no less than a hundredth of what they see of the columns: the free parameters make up for the others (hats
/// over a speed whose drag is free: any straight line), so that their size, a hundred times the rest, would say nothing of the force.
Combinations seen(const Combinations& all) {
  constexpr double min_seen = 1e-4;                                                                      // (1/100)²
  const Eigen::Index first = (all.values.array() < min_seen).count(), kept = all.values.size() - first;  // in rising order
  return {all.vectors.rightCols(kept), all.values.tail(kept)};
}

/// Those of which the free parameters do not describe all but `least_share`; `unadjusted`: information without them.
Combinations undescribed(const Combinations& all, const Eigen::MatrixXd& unadjusted, double least_share) {
  if (!(least_share > 0.0) || all.values.size() == 0) return all;
  const Eigen::MatrixXd without = all.vectors.transpose() * unadjusted * all.vectors;
  const SymmetricEigen shares = symmetric_eigen(all.values.asDiagonal(), without);
  if (!shares.converged) return all;
  const Eigen::Index first = (shares.values.array() < least_share).count(), kept = all.values.size() - first;
  return {all.vectors * shares.vectors.rightCols(kept), shares.values.tail(kept)};
}

/// sᵀ V⁻¹ s with amplitudes V⁻¹ s over the given columns, in the eigenvectors of the correlation matrix whose eigenvalue is not rounding;
/// amplitudes in those that are seen() and undescribed(). `unadjusted`: CᵀC.
void solve_score(const Eigen::MatrixXd& V, const Eigen::MatrixXd& unadjusted, const Eigen::VectorXd& s,
                 const std::vector<Eigen::Index>& columns, double least_share, ScoreResult& out) {
  const Eigen::MatrixXd A = V(columns, columns);
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * A * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(correlation);
  const Eigen::VectorXd scaled = scale.asDiagonal() * Eigen::VectorXd(s(columns));
  const Combinations all{eigen.vectors, eigen.values};
  const Eigen::VectorXd rotated = all.vectors.transpose() * scaled;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    constexpr double min_eigenvalue = 1e-6;  // below, columns are linearly dependent
    if (all.values[i] < min_eigenvalue) continue;
    ++out.dof;
    out.chi2 += rotated[i] * rotated[i] / all.values[i];
  }
  const Combinations kept = undescribed(seen(all), scale.asDiagonal() * unadjusted(columns, columns) * scale.asDiagonal(), least_share);
  Eigen::VectorXd amplitude = Eigen::VectorXd::Zero(A.rows());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  for (Eigen::Index i = 0; i < kept.values.size(); ++i) {
    const auto vector = kept.vectors.col(i);
    amplitude += vector * (vector.dot(scaled) / kept.values[i]);
    covariance += vector * vector.transpose() / kept.values[i];
  }
  out.amplitude(columns) = scale.cwiseProduct(amplitude);
  out.sigma(columns) = scale.cwiseProduct(covariance.diagonal().cwiseSqrt());
  out.covariance(columns, columns) = scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

ScoreResult ScoreTest::test(const Eigen::MatrixXd& C, const ColumnPriors* priors, double least_share) const {
  ScoreResult out;
  out.amplitude = out.sigma = Eigen::VectorXd::Zero(C.cols());
  out.covariance = Eigen::MatrixXd::Zero(C.cols(), C.cols());
  Eigen::MatrixXd V = C.transpose() * C;
  Eigen::VectorXd s = -C.transpose() * r_;
  const Eigen::MatrixXd unadjusted = V;
  if (has_parameters_) {
    const Eigen::MatrixXd cross = J_.transpose() * C;
    const Eigen::MatrixXd solved = information_.solve(cross);
    V -= cross.transpose() * solved;
    s -= solved.transpose() * gradient_;
  }
  if (priors != nullptr) {
    V.diagonal() += priors->precision;
    s += priors->gradient(Eigen::VectorXd::Zero(s.size()));
  }
  const std::vector<Eigen::Index> columns = independent_columns(V, unadjusted.diagonal(), out.independent);
  if (!columns.empty()) solve_score(V, unadjusted, s, columns, least_share, out);
  return out;
}

ForceSensitivity::ForceSensitivity(const FilterEstimate& estimate, std::vector<int> parameters)
    : estimate_(estimate), parameters_(std::move(parameters)) {
  const Model model = probed(estimate, parameters_);
  Stepper stepper(model);
  ports_ = int_size(model.system->spec().dynamic_ports);
  places_ = ports_ + int_size(parameters_);
  const Eigen::Index nq = model.system->spec().quantities.size();
  std::size_t all = 0;
  for (const auto& trace : estimate.traces) all += trace.samples;
  quantities_ = ahead_ = RowMatrix::Zero(all, nq);
  own_rates_ = RowMatrix::Zero(all, int_size(estimate.model.own_states));
  used_.assign(all, false);
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    run_steps(stepper, e, offset);
    note_outputs(stepper, e);
    offset += estimate.traces[e].samples;
  }
}

void ForceSensitivity::run_steps(Stepper& stepper, std::size_t experiment, std::size_t offset) {
  const FilterTrace& trace = estimate_.traces[experiment];
  const FilterData& data = estimate_.data[experiment];
  const Signals& signals = *data.signals;
  Evaluator values(estimate_.forced.model);
  const std::size_t N = stepper.states(), NF = places_;
  const Eigen::Index system = estimate_.model.system_states(), own = own_rates_.cols();
  std::vector<double> D(N * kRowStride);
  Slots slots;
  Eigen::VectorXd x, own_before(own);
  G_.emplace_back(trace.samples * N * NF, 0.0);
  times_.insert(times_.end(), signals.t.begin(), signals.t.end());
  prepare_at({stepper, signals, data.inputs}, data.first, data.start.data());
  for (std::size_t k = data.first; k < trace.samples; ++k) {
    x = trace.filtered(k);
    used_[offset + k] = true;
    values.quantities(x.data(), data.inputs.at(k), signals.t[k], quantities_.row(offset + k).data());
    if (k + 1 == trace.samples) break;
    own_before = x.segment(system, own);
    if (!stepper.step_linear(x.data(), interval_after({stepper, signals, data.inputs}, k), slots, D.data())) break;
    // An input that is held is set anew only then: perhaps to answer the noise of the next measurement (a controller).
    const std::vector<double> u = inputs_within(data.inputs, k, 1.0, signals.t[k + 1] - signals.t[k]);
    values.quantities(x.data(), {u.data(), &data.inputs.recorded}, signals.t[k + 1], ahead_.row(offset + k).data());
    own_rates_.row(offset + k) = (x.segment(system, own) - own_before).transpose() / (signals.t[k + 1] - signals.t[k]);
    for (std::size_t i = 0; i < N; ++i) {
      for (int c = 0; c < slots.count(); ++c) G_.back()[(k * N + i) * NF + slots.column(c)] = D[i * kRowStride + N + c];
    }
  }
}

/// At the predicted states, as the filter linearises the outputs.
void ForceSensitivity::note_outputs(Stepper& stepper, std::size_t experiment) {
  const FilterTrace& trace = estimate_.traces[experiment];
  const FilterData& data = estimate_.data[experiment];
  Y_.emplace_back();
  const SystemSpec& system = estimate_.model.system->spec();
  const bool read = std::any_of(parameters_.begin(), parameters_.end(), [&](int p) {
    const auto& ports = system.ports_in_outputs;
    return std::find(ports.begin(), ports.end(), system.quantity_ports[p].name) != ports.end();
  });
  if (!read) return;
  Evaluator& evaluator = stepper.evaluator();
  const std::size_t N = stepper.states(), NY = trace.ny, NP = parameters_.size(), places = evaluator.sensor_ports();
  std::vector<double> y(places), D(places * kRowStride);
  Slots slots;
  Y_.back().assign(trace.samples * NY * NP, 0.0);
  for (std::size_t k = data.first; k < trace.samples; ++k) {
    slots.clear();
    evaluator.linearise_outputs({trace.predicted_at(k).data(), data.inputs.at(k), data.signals->t[k]}, slots, y.data(), D.data());
    for (std::size_t o = 0; o < NY; ++o) {
      for (int c = 0; c < slots.count(); ++c) {
        const int parameter = slots.column(c) - ports_;
        if (parameter >= 0) Y_.back()[(k * NY + o) * NP + parameter] = D[o * kRowStride + N + c];
      }
    }
  }
}

namespace {

using SamplePlace = ForceSensitivity::SamplePlace;

/// Response of the whitened residuals to m disturbances, the gains fixed: `to_output(place, output, v)` adds them to the prediction of an
/// output, `to_states(place, s)` to the states at the end of the step that follows a sample.
template <class ToOutput, class ToStates>
Eigen::MatrixXd response(const FilterEstimate& estimate, Eigen::Index m, const ToOutput& to_output, const ToStates& to_states) {
  RowMatrix out(counted_rows(estimate), m);
  Eigen::Index row = 0;
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    const std::size_t NY = trace.ny;
    const Eigen::Index n = trace.n, ny = trace.ny;
    RowMatrix s = RowMatrix::Zero(n, m), coloured = RowMatrix::Zero(2 * ny, m), work(n, m);
    Eigen::RowVectorXd v(m);
    double last_h = -1.0;
    NoiseStep noise;
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      look_at_watch();
      const SamplePlace place{e, k, static_cast<Eigen::Index>(offset + k)};
      for (std::size_t o = 0; o < NY; ++o) {
        const std::size_t at = trace.place(k, o);
        if (data.use[at] == SampleRole::none) continue;
        v.noalias() = trace.H_at(at).transpose() * s;
        v += coloured.row(2 * o);
        to_output(place, static_cast<int>(o), v);
        if (data.use[at] == SampleRole::counted) out.row(row++) = v / std::sqrt(trace.S[at]);
        s.noalias() -= trace.K_at(at) * v;
        coloured.noalias() -= trace.Kj_at(at) * v;
      }
      if (k + 1 == trace.samples) break;
      const double h = data.signals->t[k + 1] - data.signals->t[k];
      if (std::abs(h - last_h) > 1e-9 * h) {
        noise = discretise(estimate.noise, h);
        last_h = h;
      }
      work.noalias() = trace.Phi_at(k) * s;
      to_states(place, work);
      s.swap(work);
      for (Eigen::Index o = 0; o < ny; ++o) {
        const auto& p = noise.coloured[o].phi;
        v = coloured.row(2 * o);
        coloured.row(2 * o) = p[0] * v + p[1] * coloured.row(2 * o + 1);
        coloured.row(2 * o + 1) = p[2] * v + p[3] * coloured.row(2 * o + 1);
      }
    }
    offset += trace.samples;
  }
  return out;
}

constexpr auto no_output = [](const SamplePlace&, int, Eigen::RowVectorXd&) {};
constexpr auto no_state = [](const SamplePlace&, RowMatrix&) {};

/// Where functions of the states are taken as errors of outputs: `ahead` of the sample before, f at the first.
auto as_errors(const SamplePlace& at, const FilterEstimate& estimate, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) {
  return at.sample == estimate.data[at.experiment].first ? f.row(at.of_all) : ahead.row(at.of_all - 1);
}

}  // namespace

/// Adds what the mean of f and `ahead` at a place (of G_) does over the step from a sample.
void ForceSensitivity::add_step(const SamplePlace& at, int place, const CourseOverSteps& course, RowMatrix& s) const {
  const std::size_t NF = places_, first = at.sample * static_cast<std::size_t>(s.rows());
  for (Eigen::Index i = 0; i < s.rows(); ++i) {
    const double gain = G_[at.experiment][(first + static_cast<std::size_t>(i)) * NF + place];
    if (gain != 0.0) s.row(i) += 0.5 * gain * (course.f.row(at.of_all) + course.ahead.row(at.of_all));
  }
}

Eigen::MatrixXd ForceSensitivity::columns(int port, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const {
  return response(estimate_, f.cols(), no_output, [&](const SamplePlace& at, RowMatrix& s) { add_step(at, port, {f, ahead}, s); });
}

Eigen::MatrixXd ForceSensitivity::parameter_columns(int i, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const {
  const std::size_t NP = parameters_.size();
  return response(
      estimate_, f.cols(),
      [&](const SamplePlace& at, int o, Eigen::RowVectorXd& v) {
        const std::vector<double>& slopes = Y_[at.experiment];
        if (slopes.empty()) return;
        const double slope = slopes[estimate_.traces[at.experiment].place(at.sample, o) * NP + i];
        if (slope != 0.0) v += slope * as_errors(at, estimate_, f, ahead);
      },
      [&](const SamplePlace& at, RowMatrix& s) {
        add_step(at, ports_ + i, {f, ahead}, s);
      });
}

Eigen::MatrixXd ForceSensitivity::output_columns(int output, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const {
  return response(
      estimate_, f.cols(),
      [&](const SamplePlace& at, int o, Eigen::RowVectorXd& v) {
        if (o == output) v += as_errors(at, estimate_, f, ahead);
      },
      no_state);
}

Eigen::MatrixXd ForceSensitivity::columns_at(PortKind kind, int index, const Eigen::MatrixXd& f, const Eigen::MatrixXd& ahead) const {
  if (kind == PortKind::dynamic) return columns(index, f, ahead);
  return kind == PortKind::quantity ? parameter_columns(index, f, ahead) : output_columns(index, f, ahead);
}

Eigen::MatrixXd ForceSensitivity::own_rate_columns(int own_state, const Eigen::MatrixXd& f) const {
  const Eigen::Index state = estimate_.model.system_states() + own_state;
  Eigen::VectorXd gain;
  return response(estimate_, f.cols(), no_output, [&](const SamplePlace& at, RowMatrix& s) {
    const std::vector<double>& t = estimate_.data[at.experiment].signals->t;
    gain = estimate_.traces[at.experiment].Phi_at(at.sample).col(state);
    gain[state] += 1.0;
    s.noalias() += 0.5 * (t[at.sample + 1] - t[at.sample]) * gain * f.row(at.of_all);
  });
}

bool ForceSensitivity::are_multiples(int port, int other) const {
  constexpr double rounding = 1e-9;  // of the largest
  double aa = 0.0, ab = 0.0, bb = 0.0, largest = 0.0, apart = 0.0;
  const auto over_all = [&](const auto& visit) {
    for (const std::vector<double>& G : G_) {
      for (std::size_t row = 0; row < G.size(); row += places_) visit(G[row + port], G[row + other]);
    }
  };
  over_all([&](double a, double b) {
    aa += a * a;
    ab += a * b;
    bb += b * b;
  });
  if (!(aa > 0.0) || !(bb > 0.0)) return false;
  over_all([&](double a, double b) {
    largest = std::max(largest, std::abs(a));
    apart = std::max(apart, std::abs(a - ab / bb * b));
  });
  return apart <= rounding * largest;
}

Eigen::VectorXd ForceSensitivity::score_of_steps(PortKind kind, int index) const {
  const int place = kind == PortKind::quantity ? ports_ + index : index;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(times_.size());
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate_.traces.size(); ++e) {
    const FilterTrace& trace = estimate_.traces[e];
    const FilterData& data = estimate_.data[e];
    const std::size_t N = trace.n, NF = places_;
    const RowMatrix adjoint = adjoint_of(trace, data, estimate_.noise);
    for (std::size_t k = data.first; k + 1 < trace.samples; ++k) {
      look_at_watch();
      double sum = 0.0;
      for (std::size_t i = 0; i < N; ++i) sum += G_[e][(k * N + i) * NF + place] * adjoint(k + 1, i);
      out[offset + k] = sum;
    }
    offset += trace.samples;
  }
  return out;
}

}  // namespace misfit
