#pragma once

#include <ceres/jet.h>

namespace misfit {

/// Value with N first derivatives.
template <int N>
using Jet = ceres::Jet<double, N>;

inline double value_of(double x) { return x; }
template <int N>
double value_of(const Jet<N>& x) {
  return x.a;
}

}  // namespace misfit
