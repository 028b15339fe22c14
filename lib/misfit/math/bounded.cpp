#include "misfit/math/bounded.h"

#include <vector>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// Coordinates active at a bound, and what pulls at each: (Σ_AA)⁻¹ (bound − centre).
struct ActiveBounds {
  std::vector<Eigen::Index> at;
  Eigen::VectorXd excess, pull;
};

struct Gaussian {
  const Eigen::VectorXd& centre;
  const Eigen::MatrixXd& covariance;
};
struct Bounds {
  const Eigen::VectorXd &lower, &upper;
};

ActiveBounds active_at(const Gaussian& density, const Bounds& bounds, const std::vector<int>& side) {
  const auto& [centre, covariance] = density;
  ActiveBounds active;
  for (Eigen::Index i = 0; i < centre.size(); ++i) {
    if (side[i] != 0) active.at.push_back(i);
  }
  active.excess.resize(active.at.size());
  for (std::size_t k = 0; k < active.at.size(); ++k) {
    const Eigen::Index i = active.at[k];
    active.excess[k] = (side[i] < 0 ? bounds.lower[i] : bounds.upper[i]) - centre[i];
  }
  active.pull = symmetric_solve(covariance(active.at, active.at), active.excess);
  return active;
}

/// The active coordinate that its bound holds back least: the one to let go; −1 where each is active for a reason.
Eigen::Index to_let_go(const ActiveBounds& active, const std::vector<int>& side) {
  Eigen::Index worst = -1;
  double most = 0.0;
  for (std::size_t k = 0; k < active.at.size(); ++k) {
    const double wrong = side[active.at[k]] * active.pull[k];
    if (wrong > most) {
      most = wrong;
      worst = active.at[k];
    }
  }
  return worst;
}

}  // namespace

BoundedMaximum maximum_inside(const Eigen::VectorXd& centre, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& lower,
                              const Eigen::VectorXd& upper) {
  const Eigen::Index n = centre.size();
  std::vector<int> side(n, 0);  // −1: at its lower bound, 1: at its upper one
  for (Eigen::Index change = 0; change < 4 * n + 1; ++change) {
    BoundedMaximum out{centre, 0.0};
    const ActiveBounds active = active_at({centre, covariance}, {lower, upper}, side);
    if (!active.at.empty()) {
      out.at += covariance(Eigen::all, active.at) * active.pull;
      out.below = 0.5 * active.excess.dot(active.pull);
    }
    for (const Eigen::Index i : active.at) out.at[i] = side[i] < 0 ? lower[i] : upper[i];
    bool inside = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (out.at[i] >= lower[i] && out.at[i] <= upper[i]) continue;
      side[i] = out.at[i] < lower[i] ? -1 : 1;
      inside = false;
    }
    if (!inside) continue;
    const Eigen::Index free = to_let_go(active, side);
    if (free < 0) return out;
    side[free] = 0;
  }
  const Eigen::VectorXd cut = centre.cwiseMax(lower).cwiseMin(upper);
  const Eigen::VectorXd off = cut - centre;
  return {cut, 0.5 * off.dot(symmetric_solve(covariance, off))};
}

}  // namespace misfit
