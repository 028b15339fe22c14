#include <algorithm>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/filter_steps.h"

namespace misfit {
namespace {

/// Backward over [model | coloured noise]: r, what measurements from this sample on say of the predicted state, and V, its covariance [DK].
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
    if (k + 1 < trace_.samples) {
      transition_.topLeftCorner(n_, n_) = trace_.Phi_at(k);
      const NoiseStep& step = steps_.at(data_.signals->t[k + 1] - data_.signals->t[k]);
      for (Eigen::Index o = 0; o < ny_; ++o) {
        const auto& p = step.coloured[o].phi;
        transition_.block(n_ + 2 * o, n_ + 2 * o, 2, 2) << p[0], p[1], p[2], p[3];
      }
      r = (transition_.transpose() * r).eval();
      if (variances_) V = (transition_.transpose() * V * transition_).eval();
    }
    for (Eigen::Index o = ny_; o-- > 0;) measurement(trace_.place(k, o), o);
  }

 private:
  void measurement(std::size_t at, Eigen::Index o) {
    if (data_.use[at] == SampleRole::none || !(trace_.S[at] > 0.0)) return;
    gain_ << trace_.K_at(at), trace_.Kj_at(at);
    row_.setZero();
    row_.head(n_) = trace_.H_at(at);
    row_[n_ + 2 * o] = 1.0;
    const double whiten = 1.0 / trace_.S[at];
    const bool counts = variances_ || data_.use[at] == SampleRole::counted;
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
  RowMatrix out = RowMatrix::Zero(trace.samples, trace.n);
  Backward backward(trace, data, noise, false);
  for (std::size_t k = trace.samples; k-- > data.first;) {
    look_at_watch();
    backward.sample(k);
    out.row(k) = backward.r.head(trace.n).transpose();
  }
  return out;
}

Smoothing smooth_states(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise) {
  const Eigen::Index n = trace.n, all = n + 2 * Eigen::Index{trace.ny};
  Smoothing out;
  out.x = out.variance = RowMatrix::Zero(trace.samples, n);
  Backward backward(trace, data, noise, true);
  for (std::size_t k = trace.samples; k-- > data.first;) {
    look_at_watch();
    backward.sample(k);
    const Eigen::Index i = k;
    const FilterTrace::Rows joint(trace.P.data() + i * n * all, n, all);
    out.x.row(i) = (trace.predicted_at(k) + joint * backward.r).transpose();
    const RowMatrix turned = joint * backward.V;
    for (Eigen::Index j = 0; j < n; ++j) out.variance(i, j) = std::max(joint(j, j) - turned.row(j).dot(joint.row(j)), 0.0);
  }
  return out;
}

}  // namespace misfit
