#pragma once

// Functions with a corner or a root where a model passes through 0, written so that value and first derivative are finite everywhere.

#include <cmath>
#include <numbers>

#include "misfit/math/scalar.h"

namespace misfit {

/// tanh(r)/r of s = r² ≥ 0: a direction times a saturating size, without a root at 0.
template <class T>
T tanh_over(const T& s) {
  using std::sqrt;
  using std::tanh;
  constexpr double small = 1e-4;  // the next term of the series is 17 s³/315: 5e-14
  if (value_of(s) < small) return 1.0 - s / 3.0 + 2.0 * s * s / 15.0;
  const T r = sqrt(s);
  return tanh(r) / r;
}

/// (exp(x) − 1)/x, 1 at 0.
template <class T>
T expm1_over(const T& x) {
  using std::exp;
  constexpr double small = 1e-3;  // the next term of the series is x⁴/120: 8e-15
  if (value_of(x) > -small && value_of(x) < small) return 1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0));
  return (exp(x) - 1.0) / x;
}

/// |x| rounded over `width` > 0: x tanh(x/width); below |x| by less than 0.28 width.
template <class T, class W>
T smooth_abs(const T& x, const W& width) {
  using std::tanh;
  return x * tanh(T(x / width));
}

/// max(x, 0); the derivative is that of the active branch, 0 at x = 0.
template <class T>
T above(const T& x) {
  return value_of(x) > 0.0 ? x : T(0.0);
}

/// What of x lies beyond ±half_width: x − half_width above, x + half_width below, 0 between.
template <class T, class W>
T beyond(const T& x, const W& half_width) {
  if (value_of(x) > value_of(half_width)) return T(x - half_width);
  if (value_of(x) < -value_of(half_width)) return T(x + half_width);
  return T(0.0);
}

/// What of x lies outside of low … high: x − high above, x − low below, 0 between.
template <class T, class W>
T outside(const T& x, const W& low, const W& high) {
  return above(T(x - high)) - above(T(low - x));
}

/// A wave in its number of turns n: cosine cos(2πn) + sine sin(2πn).
template <class T, class W>
W wave(const T& turns, const W& cosine, const W& sine) {
  using std::cos;
  using std::sin;
  const T angle = 2.0 * std::numbers::pi * turns;
  return cosine * cos(angle) + sine * sin(angle);
}

}  // namespace misfit
