#include <algorithm>

#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/filter_steps.h"

namespace misfit {
namespace {

/// Backward over [model | jitter]: r, what measurements from this sample on say of the predicted state, and V, its covariance [DK].
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
    for (std::size_t o = NY; o-- > 0;) measurement(k * NY + o, static_cast<Eigen::Index>(o));
  }

 private:
  void measurement(std::size_t at, Eigen::Index o) {
    if (data_.use[at] == SampleRole::none || !(trace_.S[at] > 0.0)) return;
    const auto N = static_cast<std::size_t>(n_), NY = static_cast<std::size_t>(ny_);
    gain_ << Eigen::Map<const Eigen::VectorXd>(trace_.K.data() + at * N, n_),
        Eigen::Map<const Eigen::VectorXd>(trace_.Kj.data() + at * 2 * NY, 2 * ny_);
    row_.setZero();
    row_.head(n_) = Eigen::Map<const Eigen::VectorXd>(trace_.H.data() + at * N, n_);
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
  RowMatrix out = RowMatrix::Zero(static_cast<Eigen::Index>(trace.samples), trace.n);
  Backward backward(trace, data, noise, false);
  for (std::size_t k = trace.samples; k-- > data.first;) {
    backward.sample(k);
    out.row(static_cast<Eigen::Index>(k)) = backward.r.head(trace.n).transpose();
  }
  return out;
}

Smoothing smooth_states(const FilterTrace& trace, const FilterData& data, const FilterNoise& noise) {
  const Eigen::Index n = trace.n, all = n + 2 * static_cast<Eigen::Index>(trace.ny);
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
