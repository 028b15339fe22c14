#pragma once

// References
//   [AM]  B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979): sequential processing of uncorrelated measurements.

#include <Eigen/Core>

#include "misfit/fit/filter/filter_model.h"
#include "misfit/fit/filter/filter_noise.h"
#include "misfit/model/limits.h"

namespace misfit {

/// Covariance of a linear filter whose state is [model states | two states of the coloured noise per channel], with deviations `x` from a
/// reference of the caller. Channels are taken one after the other [AM]: an innovation is that of its channel given the earlier ones of the
/// same sample. M, NY: numbers of model states and channels, or Eigen::Dynamic. Products are lazy: the matrices are too small for Eigen's
/// blocked ones, whose packing would cost more than they do (it takes these from eight rows on).
template <int M, int NY>
class Kalman {
 public:
  static constexpr int J = NY == Eigen::Dynamic ? Eigen::Dynamic : 2 * NY;
  static constexpr int kMaxColoured = 2 * kMaxOutputs;
  static constexpr int MM = M == Eigen::Dynamic ? kMaxStates : M;
  static constexpr int MJ = J == Eigen::Dynamic ? kMaxColoured : J;
  using StateMatrix = Eigen::Matrix<double, M, M, Eigen::ColMajor, MM, MM>;
  using CrossMatrix = Eigen::Matrix<double, M, J, Eigen::ColMajor, MM, MJ>;
  using ColouredMatrix = Eigen::Matrix<double, J, J, Eigen::ColMajor, MJ, MJ>;
  using StateVector = Eigen::Matrix<double, M, 1, Eigen::ColMajor, MM, 1>;
  using ColouredVector = Eigen::Matrix<double, J, 1, Eigen::ColMajor, MJ, 1>;

  StateMatrix P;     ///< model × model
  CrossMatrix C;     ///< model × coloured noise
  ColouredMatrix G;  ///< coloured noise × coloured noise
  StateVector x;     ///< deviation from the reference
  ColouredVector j;  ///< coloured noise
  StateVector gain;  ///< of the last update
  ColouredVector gain_coloured;

  Kalman(int states, int channels) {
    P.setZero(states, states);
    C.setZero(states, 2 * channels);
    G.setZero(2 * channels, 2 * channels);
    x.setZero(states);
    j.setZero(2 * channels);
    gain.setZero(states);
    gain_coloured.setZero(2 * channels);
  }

  /// Variance of the innovation of channel o with the row `a` of ∂h/∂x; prepares the gain.
  double variance(const StateVector& a, int o, double white) {
    gain = P.lazyProduct(a);
    gain += C.col(2 * o);
    gain_coloured = C.transpose().lazyProduct(a);
    gain_coloured += G.col(2 * o);
    const double S = a.dot(gain) + gain_coloured[2 * o] + white * white;
    return S;
  }
  /// Takes the innovation in; after variance().
  void update(double innovation, double S) {
    const StateVector by_variance = gain / S;
    const ColouredVector coloured_by_variance = gain_coloured / S;
    P -= gain.lazyProduct(by_variance.transpose());
    C -= gain.lazyProduct(coloured_by_variance.transpose());
    G -= gain_coloured.lazyProduct(coloured_by_variance.transpose());
    gain = by_variance;
    gain_coloured = coloured_by_variance;
    x += gain * innovation;
    j += gain_coloured * innovation;
  }
  /// Over a step with the model's Φ: P → Φ P Φᵀ + Q. `kind` of each row (NoiseStep). x is left to the caller.
  template <class Phi>
  void predict(const Phi& phi, const NoiseStep& noise, const FilterModel& model) {
    const std::vector<int>& kind = model.kind;
    const StateMatrix turned = phi.lazyProduct(P);
    P = turned.lazyProduct(phi.transpose());
    for (std::size_t i = 0; i < model.force_states.size(); ++i) {
      const int f = model.force_states[i];
      const double ratio = noise.variance_ratio[model.force_group[i]];
      for (Eigen::Index c = 0; c < P.cols(); ++c) {
        const double right = ratio * (c == f ? 1.0 : phi(c, f));
        if (right == 0.0) continue;
        const std::size_t kc = kind[c];
        for (Eigen::Index r = 0; r < P.rows(); ++r) {
          const double left = r == f ? 1.0 : phi(r, f);
          if (left != 0.0) P(r, c) += noise.m[kind[r]][kc] * left * right;
        }
      }
    }
    const CrossMatrix crossed = phi.lazyProduct(C);
    for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
      const auto& p = noise.coloured[o].phi;
      const Eigen::Index at = 2 * o;
      C.col(at) = p[0] * crossed.col(at) + p[1] * crossed.col(at + 1);
      C.col(at + 1) = p[2] * crossed.col(at) + p[3] * crossed.col(at + 1);
    }
    rotate_coloured(noise);
  }

 private:
  void rotate_coloured(const NoiseStep& noise) {
    for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
      const auto& p = noise.coloured[o].phi;
      const Eigen::Index at = 2 * o;
      const ColouredVector first = G.col(at), second = G.col(at + 1);
      G.col(at) = p[0] * first + p[1] * second;
      G.col(at + 1) = p[2] * first + p[3] * second;
      const double old = j[at];
      j[at] = p[0] * old + p[1] * j[at + 1];
      j[at + 1] = p[2] * old + p[3] * j[at + 1];
    }
    for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
      const auto& p = noise.coloured[o].phi;
      const auto& q = noise.coloured[o].q;
      const Eigen::Index at = 2 * o;
      const ColouredVector first = G.row(at).transpose(), second = G.row(at + 1).transpose();
      G.row(at) = (p[0] * first + p[1] * second).transpose();
      G.row(at + 1) = (p[2] * first + p[3] * second).transpose();
      G(at, at) += q[0];
      G(at, at + 1) += q[1];
      G(at + 1, at) += q[1];
      G(at + 1, at + 1) += q[2];
    }
  }
};

}  // namespace misfit
