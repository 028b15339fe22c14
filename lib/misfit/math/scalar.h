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

/// 0, and 0 to first order as well: what depends on it may be left out with its derivatives.
inline bool vanishes(double x) { return x == 0.0; }
template <int N>
bool vanishes(const Jet<N>& x) {
  return x.a == 0.0 && (x.v.array() == 0.0).all();
}

}  // namespace misfit
