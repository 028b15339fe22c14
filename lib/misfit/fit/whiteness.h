#pragma once

// References
//   [LB] G. M. Ljung, G. E. P. Box, Biometrika 65 (1978).

#include <vector>

namespace misfit {

/// Sample autocorrelation ρ_0 … ρ_max_lag about the mean; pairs with a NaN are left out. ρ of fewer than 10 pairs is NaN.
[[nodiscard]] std::vector<double> autocorrelation(const std::vector<double>& residuals, int max_lag);

struct WhitenessTest {
  double statistic = 0.0;  ///< n (n + 2) Σ ρ_k²/(n − k) over first_lag … last_lag [LB]
  double p_value = 1.0;    ///< chi² with last_lag − first_lag + 1 degrees of freedom
  double largest = 0.0;    ///< the ρ_k largest in size among these lags
  int largest_lag = 0;
  int first_lag = 0, last_lag = 0;
};

/// Ljung–Box over a range of lags. Lags below the reach of a stencil are left out by the caller (`first_lag`): noise that went through a
/// stencil of five samples is correlated up to lag 4 whatever the model. Assumes residuals of a model with few parameters beside n.
[[nodiscard]] WhitenessTest whiteness(const std::vector<double>& residuals, int first_lag, int last_lag);

/// The motion is driven (lib/misfit/README.md, 5.8): residuals are correlated at the lags of the dynamics, from `first_lag` to half a
/// period of the motion. True if Ljung–Box p < 1e-6 and some |ρ| there exceeds 0.15 (a level at which a deterministic model has lost a
/// fifth of a residual to memory).
[[nodiscard]] bool looks_driven(const WhitenessTest& test);

}  // namespace misfit
