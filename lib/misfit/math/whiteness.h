#pragma once

// References
//   [LB] G. M. Ljung, G. E. P. Box, Biometrika 65 (1978).
//   [B]  G. E. P. Box, Ann. Math. Statist. 25 (1954): a quadratic form taken as a multiple of chi² with its first two moments.

#include <string>
#include <vector>

namespace misfit {

/// Residuals on an even grid of the usual step: NaN where time passes without a sample, so that a lag in places is a lag in time. A gap of
/// any length gets at most as many places as there are residuals.
[[nodiscard]] std::vector<double> on_even_grid(const std::vector<double>& t, const std::vector<double>& residuals);

/// Series one after the other, with as many NaN between two as all have values: no pair of any lag that is looked at lies across.
[[nodiscard]] std::vector<double> joined_series(const std::vector<std::vector<double>>& series);

/// Sample autocorrelation ρ_0 … ρ_max_lag about the mean, ρ_k = c_k/c_0 with c_k = (1/n) Σ r_i r_{i+k}. Where values are
/// missing (NaN), ρ_k = (1 − k/n) Σ r_i r_{i+k} / sqrt(Σ r_i² Σ r_{i+k}²), all sums over the pairs that exist: variances of other values
/// would let it exceed 1 where the pairs lie in a loud part of the record. ρ of fewer than 10 pairs is NaN.
[[nodiscard]] std::vector<double> autocorrelation(const std::vector<double>& residuals, int max_lag);

struct WhitenessTest {
  double statistic = 0.0;  ///< n (n + 2) Σ ρ_k²/(n − k) over first_lag … last_lag [LB]
  double p_value = 1.0;    ///< of the statistic under white residuals; 1 where there are too few for any lag
  double largest = 0.0;    ///< the ρ_k largest in size among these lags
  int largest_lag = 0;
  int first_lag = 0, last_lag = 0;  ///< looked at; last_lag < first_lag: none
};

/// Ljung–Box over a range of lags, at most n/4 and 10 + 2 sqrt(n) of n residuals. Missing values (NaN): of lag k there are P_k pairs
/// instead of n − k, and n (n + 2) (Σ r_i r_{i+k})²/(Σ r²)²/P_k has mean 1 as it has without them. The terms of a sum over many lags are
/// not independent (covariance 4 P_{j+k}/n² of lags j and k): the p-value is that of the multiple of chi² with the sum's mean and
/// variance [B]; chi² with as many degrees of freedom as lags would alarm at 7 % instead of 5 for n/4 lags of 50.
/// Lags below the reach of a stencil are left out by the caller (`first_lag`): noise that went through a
/// stencil of five samples is correlated up to lag 4 whatever the model. A fit takes memory into its residuals: with more than n/10
/// unknowns `fitted` no lag is looked at (four of 15 values alarm at 1 % where p < 1e-3).
[[nodiscard]] WhitenessTest whiteness(const std::vector<double>& residuals, int first_lag, int last_lag, double fitted = 0.0);

/// "lags 1 to 20 samples: largest autocorrelation 0.31 at lag 2, Ljung-Box p = 0.0012", or that there are too few samples.
[[nodiscard]] std::string in_words(const WhitenessTest& test);

/// Residuals of a deterministic model are not white, and a reader has to know: p < 1e-3.
[[nodiscard]] bool clearly_coloured(const WhitenessTest& test);

/// The motion is driven (lib/misfit/README.md, 5.8): residuals are correlated at the lags of the dynamics, from `first_lag` to half a
/// period of the motion. True if Ljung–Box p < 1e-6 and some |ρ| there exceeds 0.15 (a level at which a deterministic model has lost a
/// fifth of a residual to memory).
[[nodiscard]] bool looks_driven(const WhitenessTest& test);

}  // namespace misfit
