#pragma once

#include <Eigen/Core>

namespace misfit {

/// Where a quadratic is highest inside a box.
struct BoundedMaximum {
  Eigen::VectorXd at;
  double below = 0.0;  ///< ½ (at − centre)ᵀ P (at − centre): how much lower it is than at the centre
};

/// Maximum of −½ (x − centre)ᵀ P (x − centre) over lower ≤ x ≤ upper, with `covariance` = P⁻¹ (positive definite). Coordinates on a bound
/// are held there and the others take their conditional means: not the same as cutting the centre to the box, which leaves the others where
/// they were with the excess. Active set (Nocedal and Wright, Numerical Optimization (2006), 16.5); infinite bounds are allowed. The centre
/// cut to the box after 4 n changes of the set (cycling, which rounding alone could bring about).
[[nodiscard]] BoundedMaximum maximum_inside(const Eigen::VectorXd& centre, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& lower,
                                            const Eigen::VectorXd& upper);

}  // namespace misfit
