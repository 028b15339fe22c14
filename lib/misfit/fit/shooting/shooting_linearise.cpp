// Gaussian linearisations of the shooting problem: what roughness, covariance and benchmarks need.

#include <algorithm>
#include <cmath>

#include "misfit/fit/shooting/shooting.h"
#include "misfit/math/decompositions.h"

namespace misfit {

NormalEquations Shooting::empty_sums(Eigen::Index unknowns) const {
  NormalEquations out{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns),          0.0, 0.0,
                      Eigen::VectorXd::Zero(unknowns),           parameter_priors(model_).padded(unknowns)};
  out.theta.head(std::ssize(free_)) = model_.theta();
  return out;
}

double Shooting::counted(const Piece& piece) const {
  double count = 0.0;
  for (std::size_t i = piece.first; i < piece.last; ++i) {
    for (std::size_t o = 0; o < static_cast<std::size_t>(model_.outputs()); ++o) count += counts(piece.experiment, i, o) ? 1.0 : 0.0;
  }
  return count;
}

bool Shooting::linearise_segments(std::size_t length, NormalEquations& out) {
  const auto columns = std::ssize(free_);
  const Eigen::Index n = model_.states();
  out = empty_sums(columns);
  set_theta(out.theta.data());
  ++linearisations_;
  for (Piece& piece : cut(length)) {
    const Eigen::VectorXd x0 = history_[piece.experiment].row(piece.first);
    run_segment({*stepper_, experiments_[piece.experiment], inputs_[piece.experiment]}, {piece.first, piece.last, x0.data(), true},
                piece.segment);
    if (!piece.segment.finite) return false;
    const Eigen::Index rows = piece.segment.y.size();
    Eigen::VectorXd r(rows);
    RowMatrix theta_rows(rows, columns), state_rows(rows, n);
    double* J[2] = {theta_rows.data(), state_rows.data()};
    fill_rows(piece, r.data(), J);
    // The segment's own initial state is projected out: what is left depends on the parameters alone.
    const Eigen::MatrixXd Q = column_space(state_rows);
    r -= Q * (Q.transpose() * r);
    theta_rows -= Q * (Q.transpose() * theta_rows);
    out.N.noalias() += theta_rows.transpose() * theta_rows;
    out.g.noalias() += theta_rows.transpose() * r;
    out.rss += r.squaredNorm();
    out.count += std::max(counted(piece) - static_cast<double>(Q.cols()), 0.0);
  }
  return true;
}

/// Scales rows and residuals of a run by 1/sigma in place; rows that do not count become zero.
double Shooting::weigh(std::size_t experiment, Segment& run, Eigen::VectorXd& r) const {
  const Signals& signals = experiments_[experiment];
  const std::size_t ny = run.y.cols();
  r.resize(run.y.size());
  double count = 0.0;
  for (std::size_t i = run.first; i < run.last; ++i) {
    for (std::size_t o = 0; o < ny; ++o) {
      const Eigen::Index row = (i - run.first) * ny + o;
      const bool used = counts(experiment, i, o);
      const double weight = used ? 1.0 / sigma_[o] : 0.0;
      r[row] = used ? (run.y(i - run.first, o) - signals.measured[o].values[i]) * weight : 0.0;
      run.y_rows.row(row) *= weight;
      count += used ? 1.0 : 0.0;
    }
  }
  return count;
}

namespace {

/// Rows of a batch into those of the whole run.
void keep(const Segment& part, std::size_t samples, Segment& whole) {
  const Eigen::Index ny = part.y.cols();
  whole.last = samples;
  whole.y.resize(samples, ny);
  whole.y_rows.resize(samples * ny, part.y_rows.cols());
  whole.y.middleRows(part.first, part.y.rows()) = part.y;
  whole.y_rows.middleRows(part.first * ny, part.y_rows.rows()) = part.y_rows;
}

}  // namespace

bool Shooting::linearise(NormalEquations& out, std::vector<Segment>* runs) {
  const auto columns = std::ssize(free_);
  const Eigen::Index n = model_.states();
  const Eigen::Index all = columns + n * experiments_.size();
  ++linearisations_;
  out = empty_sums(all);
  set_theta(out.theta.data());
  Eigen::VectorXd r, g(columns + n);
  Eigen::MatrixXd N(columns + n, columns + n);
  if (runs != nullptr) runs->resize(experiments_.size());
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const Eigen::VectorXd x0 = initial_state(e);
    N.setZero();
    g.setZero();
    const auto add = [&](Segment& part) {
      if (runs != nullptr) keep(part, experiments_[e].samples(), (*runs)[e]);
      out.count += weigh(e, part, r);
      N.selfadjointView<Eigen::Lower>().rankUpdate(part.y_rows.transpose());
      g.noalias() += part.y_rows.transpose() * r;
      out.rss += r.squaredNorm();
    };
    constexpr std::size_t batch = 128;  // samples whose rows stay in the cache until they are summed
    run_in_batches({*stepper_, experiments_[e], inputs_[e]}, {0, experiments_[e].samples(), x0.data(), true, batch}, run_, add);
    if (!run_.finite) {
      note_failure(run_, e);
      return false;
    }
    if (runs != nullptr) (*runs)[e].finite = true;
    N.triangularView<Eigen::StrictlyUpper>() = N.transpose();
    const Eigen::Index at = columns + n * e;
    out.theta.segment(at, n) = x0;
    out.N.topLeftCorner(columns, columns) += N.topLeftCorner(columns, columns);
    out.N.block(0, at, columns, n) = N.topRightCorner(columns, n);
    out.N.block(at, 0, n, columns) = N.bottomLeftCorner(n, columns);
    out.N.block(at, at, n, n) = N.bottomRightCorner(n, n);
    out.g.head(columns) += g.head(columns);
    out.g.segment(at, n) = g.tail(n);
  }
  constrain_initial(out);
  return true;
}

}  // namespace misfit
