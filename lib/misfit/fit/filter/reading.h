#pragma once

namespace misfit {

/// A measurement as the update of a linear filter takes it, and −log of its density.
struct Reading {
  double e = 0.0;  ///< innovation
  double S = 0.0;  ///< its variance
  double minus_log = 0.0;
};

/// A measurement `departure` above its normal prediction of variance S.
[[nodiscard]] Reading read_as_it_is(double departure, double S);

/// A measurement in whole steps q, of which is known that what was read lies within q/2 of it: with a normal prediction w ~ N(ŷ, S) the
/// probability of that is p = Φ(b) − Φ(a), a, b = (departure ∓ q/2)/√S, and w given it is truncated normal, of mean ŷ + √S m and variance
/// S (1 − k),
///   m = (φ(a) − φ(b))/p,   k = m² + (b φ(b) − a φ(a))/p
/// (Curry, Estimation and Control with Quantized Measurements, 1970, ch. 2; Johnson, Kotz, Balakrishnan, Continuous Univariate
/// Distributions 1, 1994, 13.10.1). The linear update that gives these moments has the innovation e = √S m/k of variance S/k. Its
/// derivatives are those of the likelihood, too: ∂ log p/∂ŷ = e/(S/k), −∂² log p/∂ŷ² = 1/(S/k), ∂ log p/∂S = −½ (1 − e²/(S/k))/(S/k).
/// The density is p/q: comparable with that of a measurement in finer steps, and with S ≫ q² the normal one of variance S + q²/12.
/// The states themselves are taken as normal afterwards, which they are not where S ≪ q².
[[nodiscard]] Reading read_in_steps(double departure, double S, double step);

}  // namespace misfit
